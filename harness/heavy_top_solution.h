#pragma once

#include "harness/references/heavy_top_reference.h"
#include "integrators/starting_values.h"
#include "problems/heavy_top.h"

namespace liebench::detail {

// The solution of the reference in the formulation System.
template <template <class> class System>
auto exact_solution(const HeavyTopReference& reference) {
  return [&reference, system = System<Extended>(reference.parameters())](const Extended& t) {
    const HeavyTopState s = reference.at(t);
    return SolutionPoint<System<Extended>>{t, system.configuration(s.R), system.velocity(s.R, s.omega),
                                           system.acceleration(s.R, s.omega, s.omega_dot),
                                           system.multipliers(s.R, s.omega, s.omega_dot)};
  };
}

}  // namespace liebench::detail
