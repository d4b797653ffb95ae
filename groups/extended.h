#pragma once

#include <qd/dd_real.h>
#include <qd/qd_real.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "groups/decimal.h"
#include "groups/scalar.h"

// Extended: the scalar of extended-precision runs and of references, an unevaluated sum of two doubles
// (106 bits, about 32 digits; Hida, Li & Bailey 2001, library QD). Measured on the 9 x 9 factorization and
// solve that the constrained heavy top needs: 3.7 us against 0.5 us in double (both by Eigen's PartialPivLU) and about 12 us in __float128.
// The one header of groups and integrators that needs more than Eigen; no other includes it.

namespace liebench {

using Extended = dd_real;

template <>
struct ScalarTraits<Extended> {
  using Coefficient = Extended;
  using Linear = double;
  static constexpr bool extended = true;

  // The shortest decimal that rounds to x, within 2^-106 relative, as long as its low part does not underflow (|x| > 1e-290):
  // mantissa * 10^exponent through quad-double, because the division of double-double itself may err by a few units in its last
  // place.
  static Extended decimal(double x) {
    if (!std::isfinite(x) || x == 0) return Extended(x);
    const detail::ShortestDecimal d = detail::shortest_decimal(x);
    const double high = static_cast<double>(d.mantissa);
    const double low = static_cast<double>(d.mantissa - static_cast<std::int64_t>(high));
    qd_real value{dd_real(high, low)};
    constexpr int exact_power = 22;  // 10^22 is the largest power of ten that is a double
    for (int left = std::abs(d.exponent); left > 0; left -= exact_power) {
      double power = 1;
      for (int i = std::min(left, exact_power); i > 0; --i) power *= 10;
      if (d.exponent > 0) {
        value *= power;
      } else {
        value /= qd_real(power);
      }
    }
    return to_dd_real(value);
  }
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
