#pragma once

#include "groups/scalar.h"

// Declared, not included: those who make Jets include <ceres/jet.h>, the others need no Ceres.
namespace ceres {
template <typename T, int N>
struct Jet;
}

namespace liebench {

// Jets over T: series to the precision of T, with coefficients that arithmetic with a Jet over T takes.
template <class T, int n>
struct ScalarTraits<ceres::Jet<T, n>> {
  using Coefficient = T;
  static constexpr bool extended = ScalarTraits<T>::extended;
  using Linear = typename ScalarTraits<T>::Linear;
};

}  // namespace liebench
