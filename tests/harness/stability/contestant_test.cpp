#include "harness/stability/contestant.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "harness/stability/growth.h"
#include "harness/stability/linear_growth.h"
#include "harness/stability/linear_theory.h"

namespace liebench {
namespace {

constexpr double pi = std::numbers::pi;

// The steps of the program against the polynomials of the literature, inside and outside the regions of stability.
TEST(LinearStability, TheStepsGrowAsTheCharacteristicPolynomialSays) {
  for (const Contestant& method : contestants(true)) {
    if (!fits(method.method->fits, false) || method.chooses_steps()) continue;
    for (const std::complex<double> z : {std::complex<double>(-0.5, 0.0),
                                         {-0.2, 1.0},
                                         {0.0, 2.0},
                                         {-3.0, 4.0},
                                         {0.3, 0.8},
                                         {0.0, 50.0},
                                         {4.0, 3.0}}) {
      const double theory = std::log10(spectral_radius(method, z)), measured = linear_growth(method, z);
      // Their Newton matrix has the damping that their equation takes from the step before: they fail where it is large.
      if ((method.is("rattlie") || method.is("liemid")) && z.real() != 0.0) continue;
      // What is damped to round-off is seen for a few dozen steps alone, with its transients.
      if (method.rho_inf() && z.real() < 0.0)
        // Its matrix has a root alpha_m / (alpha_m - 1) beside those of the motion, which a consistent a_0 does not excite.
        EXPECT_LE(measured, theory + 0.02) << method.name << " at " << z;
      else if (theory < -0.2)
        EXPECT_LT(measured, -0.1) << method.name << " at " << z;
      else if (theory > 2.0)
        // Beyond what a double holds within the first states.
        EXPECT_GT(measured, 0.5) << method.name << " at " << z;
      else
        EXPECT_NEAR(measured, theory, 0.02 + 0.33 * std::abs(theory)) << method.name << " at " << z;
    }
  }
}

// [Hairer & Wanner, Solving ODE II, V.2, table 2.1]: the angles of A(alpha)-stability, k = 3, ..., 6, to their hundredth of a degree.
TEST(LinearStability, TheAnglesOfTheBdfMethodsAreThoseOfTheTable) {
  const std::vector<std::pair<int, double>> table{{3, 86.03}, {4, 73.35}, {5, 51.84}, {6, 17.84}};
  for (const auto& [k, degrees] : table) {
    const Contestant method = contestant("bliedf2nd", {{"k", k}});
    const auto stable = [&](double alpha) {
      for (double r = 1e-3; r < 100.0; r *= 1.01)
        if (spectral_radius(method, std::polar(r, pi - alpha * pi / 180.0)) > 1.0 + 1e-12) return false;
      return true;
    };
    EXPECT_TRUE(stable(degrees - 0.05)) << k;
    EXPECT_FALSE(stable(degrees + 0.05)) << k;
  }
}

TEST(LinearStability, GeneralizedAlphaHasItsSpectralRadiusAtInfinity) {
  for (const double rho : {0.0, 0.5, 0.9, 1.0}) {
    const Contestant method = contestant("generalized_alpha", {{"rho_inf", rho}});
    // A triple root, where rho_inf = 0, is known to the cube root of what is left.
    EXPECT_NEAR(spectral_radius(method, {0.0, 1e6}), rho, rho == 0.0 ? 1e-2 : 1e-3);
    for (double w = 1e-3; w < 1e3; w *= 1.1)
      EXPECT_LE(spectral_radius(method, {0.0, w}), 1.0 + 1e-7) << rho << ' ' << w;
  }
}

// A-stable for k = 1, 2; k = 3 gains theta^4 / 4 a step on the imaginary axis, k = 2 loses as much, k = 1 theta^2 / 2.
TEST(LinearStability, SlowOscillationsGrowAsTheExpansionsSay) {
  const double theta = 0.01;
  const auto radius = [&](int k) {
    return spectral_radius(contestant("bliedf2nd", {{"k", k}}), {0.0, theta});
  };
  EXPECT_NEAR((radius(1) - 1.0) / (theta * theta), -0.5, 1e-3);
  EXPECT_NEAR((radius(2) - 1.0) / std::pow(theta, 4), -0.25, 1e-2);
  EXPECT_NEAR((radius(3) - 1.0) / std::pow(theta, 4), 0.25, 1e-2);
}

TEST(GrowthLaw, IsTheExponentOfTheLargestDeviationSoFar) {
  std::vector<double> none, linear, quadratic;
  for (int i = 1; i <= 1000; ++i) {
    const double wave = 1.0 + 0.5 * std::sin(0.3 * i);
    none.push_back(1e-12 * wave);
    linear.push_back(1e-9 * i * wave);
    quadratic.push_back(1e-9 * i * i);
  }
  EXPECT_NEAR(growth_law(none, 1e-16).exponent, 0.0, 0.05);
  EXPECT_NEAR(growth_law(linear, 1e-16).exponent, 1.0, 0.05);
  EXPECT_NEAR(growth_law(quadratic, 1e-16).exponent, 2.0, 0.05);
  EXPECT_NEAR(growth_law(std::vector<double>(100, 0.0), 1e-16).exponent, 0.0, 1e-9);
}

}  // namespace
}  // namespace liebench
