#pragma once

#include <ceres/jet.h>

#include "groups/scalar.h"

namespace liebench {

// Jets over T: series to the precision of T, with coefficients that arithmetic with a Jet over T takes.
template <class T, int n>
struct ScalarTraits<ceres::Jet<T, n>> {
  using Coefficient = T;
  static constexpr bool extended = ScalarTraits<T>::extended;
  using Linear = typename ScalarTraits<T>::Linear;
};

}  // namespace liebench
