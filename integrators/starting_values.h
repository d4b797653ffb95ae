#pragma once

#include "problems/system.h"

namespace liebench {

// One point of a known solution: what a multistep method starts from, eq. (21).
template <MechanicalSystem S>
struct SolutionPoint {
  typename S::Scalar t;
  Configuration<S> q;
  Velocity<S> v;
  Velocity<S> acceleration;  // v'
  Multipliers<S> lambda;
};

}  // namespace liebench
