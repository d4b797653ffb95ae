#pragma once

#include "problems/system.h"

namespace liebench {

// One point of a known solution: what a multistep method starts from, eq. (21). By its vectors, so that an audited system
// shares it with the system itself.
template <class Scalar, class Element, class Tangent, class MultiplierVector>
struct PointOfSolution {
  Scalar t;
  Element q;
  Tangent v;
  Tangent acceleration;  // v'
  MultiplierVector lambda;
};

template <MechanicalSystem S>
using SolutionPoint = PointOfSolution<typename S::Scalar, Configuration<S>, Velocity<S>, Multipliers<S>>;

}  // namespace liebench
