#include "integrators/bdf_coefficients.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>
#include <vector>

#include "groups/extended.h"

namespace liebench::bdf_coefficients_test {
namespace {

double to_units(const Extended& x) {
  return std::abs(to_double(x)) / to_double(Eigen::NumTraits<Extended>::epsilon());
}

// Calls f.template operator()<k>() for k = 1, ..., 6.
template <class F>
void for_every_k(const F& f) {
  [&]<int... i>(std::integer_sequence<int, i...>) {
    (f.template operator()<i + 1>(), ...);
  }
  (std::make_integer_sequence<int, 6>{});
}

TEST(BdfCoefficients, AreThoseOfThePaper) {
  const auto two = bdf_coefficients<double>(2);
  EXPECT_EQ(two.alpha, (std::array{3.0 / 2, -2.0, 1.0 / 2, 0.0, 0.0, 0.0, 0.0}));
  EXPECT_EQ(two.gamma, (std::array{3.0 / 2, -1.0 / 2, 0.0, 0.0, 0.0, 0.0}));
  const auto three = bdf_coefficients<double>(3);
  EXPECT_EQ(three.alpha, (std::array{11.0 / 6, -3.0, 3.0 / 2, -1.0 / 3, 0.0, 0.0, 0.0}));
  EXPECT_EQ(three.gamma, (std::array{11.0 / 6, -7.0 / 6, 1.0 / 3, 0.0, 0.0, 0.0}));
  const auto four = bdf_coefficients<double>(4);
  EXPECT_EQ(four.alpha, (std::array{25.0 / 12, -4.0, 3.0, -4.0 / 3, 1.0 / 4, 0.0, 0.0}));
  EXPECT_EQ(four.gamma, (std::array{25.0 / 12, -23.0 / 12, 13.0 / 12, -1.0 / 4, 0.0, 0.0}));
}

// Eq. (3): sum alpha_i = 0 and sum alpha_i (k - i)^l / k^(l-1) = l for l = 1, ..., k.
TEST(BdfCoefficients, SatisfyTheOrderConditionsOfAlpha) {
  for_every_k([]<int k>() {
    const auto c = bdf_coefficients<Extended>(k);
    for (int l = 0; l <= k; ++l) {
      Extended sum = 0.0;
      for (int i = 0; i <= k; ++i)
        sum += c.alpha[std::size_t(i)] * std::pow(double(k - i), l) / std::pow(double(k), l - 1);
      // alpha_i <= 20 and k: below 120 in all, an eps each.
      EXPECT_LE(to_units(sum - double(l)), 500) << k << ' ' << l;
    }
  });
}

// Eq. (7): sum gamma_i ((k+1-i)^l - (k-i)^l) / k^(l-1) = l for l = 1, ..., k.
TEST(BdfCoefficients, SatisfyTheOrderConditionsOfGamma) {
  for_every_k([]<int k>() {
    const auto c = bdf_coefficients<Extended>(k);
    for (int l = 1; l <= k; ++l) {
      Extended sum = 0.0;
      for (int i = 1; i <= k; ++i)
        sum += c.gamma[std::size_t(i - 1)] * (std::pow(double(k + 1 - i), l) - std::pow(double(k - i), l)) /
               std::pow(double(k), l - 1);
      EXPECT_LE(to_units(sum - double(l)), 500) << k << ' ' << l;
    }
  });
}

TEST(BdfCoefficients, GammaIsThePartialSumOfAlpha) {
  for_every_k([]<int k>() {
    const auto c = bdf_coefficients<Extended>(k);
    Extended sum = 0.0;
    for (int i = 0; i < k; ++i) {
      sum += c.alpha[std::size_t(i)];
      EXPECT_LE(to_units(sum - c.gamma[std::size_t(i)]), 100) << k << ' ' << i;
    }
  });
}

TEST(BdfCoefficients, AreRoundedOnce) {
  // 60 alpha_i is an integer: what is left of it is the one rounding of the quotient, and that of the product.
  for_every_k([]<int k>() {
    const auto c = bdf_coefficients<Extended>(k);
    for (const Extended& a : c.alpha) {
      const Extended sixty = a * 60.0;
      EXPECT_LE(to_units(sixty - std::round(to_double(sixty))), 4 * std::abs(to_double(sixty))) << k;
    }
  });
}

TEST(BdfCoefficients, AreZeroStable) {
  // rho(z) = sum alpha_i z^(k-i): a simple root 1, all others inside the unit circle.
  for_every_k([]<int k>() {
    const auto c = bdf_coefficients<double>(k);
    Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(k, k);
    for (int i = 0; i < k; ++i) companion(0, i) = -c.alpha[std::size_t(i + 1)] / c.alpha[0];
    for (int i = 1; i < k; ++i) companion(i, i - 1) = 1;
    const Eigen::VectorXcd roots = companion.eigenvalues();
    int principal = 0;
    for (const std::complex<double>& z : roots) {
      if (std::abs(z - 1.0) < 1e-10) {
        ++principal;
      } else {
        EXPECT_LT(std::abs(z), 0.9) << k;  // 0.863 for k = 6
      }
    }
    EXPECT_EQ(principal, 1) << k;
  });
}

}  // namespace
}  // namespace liebench::bdf_coefficients_test
