#pragma once

#include <cstdint>
#include <string_view>

#include "groups/counted.h"

// Floating point operations of the parts of a step, by formulation of the heavy top and form, counted with the scalar
// Counted on the step equation itself.

namespace liebench {

struct StepOperations {
  Operations residual;       // new point from the unknowns, and the scaled residual there
  Operations jacobian;       // the Newton matrix
  Operations factorization;  // its LU factors
  Operations solve;          // a back-substitution
};

// `form`: "index3" or "stabilized_index2"; of a formulation without constraints the only one, by any name. Throws
// std::invalid_argument for an unknown formulation.
StepOperations step_operations(std::string_view formulation, std::string_view form);

}  // namespace liebench
