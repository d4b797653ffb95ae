#pragma once

#include <qd/dd_real.h>

#include <Eigen/Core>

#include "groups/scalar.h"

// Extended: the scalar of extended-precision runs and of references, an unevaluated sum of two doubles
// (106 bits, about 32 digits; Hida, Li & Bailey 2001, library QD). Measured on the 9 x 9 factorization and
// solve that the constrained heavy top needs: 3.7 us against 0.5 us in double (both by Eigen's PartialPivLU) and about 12 us in __float128.

namespace liebench {

using Extended = dd_real;

template <>
struct ScalarTraits<Extended> {
  using Coefficient = Extended;
  using Linear = double;
  static constexpr bool extended = true;
};

}  // namespace liebench

template <>
struct Eigen::NumTraits<dd_real> : Eigen::GenericNumTraits<dd_real> {
  using Real = dd_real;
  using NonInteger = dd_real;
  using Nested = dd_real;
  using Literal = double;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 2,
    AddCost = 20,
    MulCost = 24
  };
  static dd_real epsilon() { return dd_real(dd_real::_eps); }
  static dd_real dummy_precision() { return dd_real(1e-28); }
  static int digits10() { return 31; }
};

template <>
struct Eigen::internal::cast_impl<dd_real, double> {
  static double run(const dd_real& x) { return x.x[0]; }
};
