#include "integrators/bdf_stability.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>

namespace liebench::bdf_stability_test {
namespace {

using Complex = std::complex<double>;

// z at which p has the root zeta: sum_j (1 - 1 / zeta)^j / j.
Complex z_of_root(int k, Complex zeta) {
  Complex sum = 0.0;
  for (int j = 1; j <= k; ++j) sum += std::pow(1.0 - 1.0 / zeta, j) / double(j);
  return sum;
}

// A(alpha)-stability of Hairer & Wanner, Solving ODE II, Table V.2.1, degrees.
constexpr std::array<double, 6> sectors{90.0, 90.0, 86.03, 73.35, 51.84, 17.84};

TEST(BdfIsStable, InItsSectorAndNotJustBesideIt) {
  for (int k = 1; k <= 6; ++k) {
    const auto everywhere = [k](double degrees) {
      const Complex direction = -std::polar(1.0, degrees * std::numbers::pi / 180.0);
      for (double r = 1e-3; r < 1e3; r *= 1.01)
        if (!bdf_is_stable(k, r * direction) || !bdf_is_stable(k, r * std::conj(direction))) return false;
      return true;
    };
    const double alpha = sectors[std::size_t(k - 1)];
    EXPECT_TRUE(everywhere(alpha - 0.05)) << k;
    if (k > 2) {
      EXPECT_FALSE(everywhere(alpha + 0.05)) << k;
    }
  }
}

TEST(BdfIsStable, NotWhereItHasARootOutsideTheUnitCircle) {
  for (int k = 1; k <= 6; ++k)
    for (const double angle : {0.1, 0.5, 1.0, 2.0, 3.0})
      EXPECT_FALSE(bdf_is_stable(k, z_of_root(k, std::polar(1.001, angle)))) << k << ' ' << angle;
}

TEST(BdfIsStable, NextToTheImaginaryAxisUpToOrderTwoAlone) {
  const auto motion = [](double r, double ratio) {
    return r * Complex(-ratio, std::sqrt(1.0 - ratio * ratio));
  };
  // Of k = 3 the boundary comes back to the axis at cos phi = 1/4, |z| = 15^{1/2} / 2. The damping is of round-off, for k = 1, 2.
  const double back = 0.5 * std::sqrt(15.0);
  for (const double r : {0.1, 0.4, 1.0, 0.99 * back, 1.01 * back, 10.0}) {
    EXPECT_TRUE(bdf_is_stable(2, motion(r, 1e-8))) << r;
    EXPECT_EQ(bdf_is_stable(3, motion(r, 1e-8)), r > back) << r;
  }
  // Damped by 1 %: from (4 ratio)^{1/3} = 0.34 on.
  for (const double r : {0.1, 0.3, 0.4, 1.0})
    EXPECT_EQ(bdf_is_stable(3, motion(r, 0.01)), r < std::cbrt(0.04)) << r;
}

}  // namespace
}  // namespace liebench::bdf_stability_test
