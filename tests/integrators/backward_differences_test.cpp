#include "integrators/backward_differences.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "groups/extended.h"
#include "integrators/bdf_coefficients.h"

namespace liebench::backward_differences_test {
namespace {

// Calls f.template operator()<points>() for points = 2, ..., 7.
template <class F>
void for_every_number_of_points(const F& f) {
  [&]<int... i>(std::integer_sequence<int, i...>) {
    (f.template operator()<i + 2>(), ...);
  }
  (std::make_integer_sequence<int, 6>{});
}

// d-th derivative of x^degree.
Extended derivative_of_power(int degree, int d, double x) {
  Extended value = 1.0;
  for (int i = 0; i < d; ++i) value *= double(degree - i);
  for (int i = d; i < degree; ++i) value *= x;
  return value;
}

double units(const Extended& x) {
  return std::abs(to_double(x)) / to_double(Eigen::NumTraits<Extended>::epsilon());
}

// The nodes are 0, -1, -2, ... and the formula is for `position`.
TEST(DerivativeWeights, AreExactForPolynomialsUpToTheirDegree) {
  for_every_number_of_points([]<int points>() {
    for (const double position : {0.0, 1.0, -0.5})
      for (int d = 0; d < points; ++d) {
        const auto w = derivative_weights<Extended>(points, d, position);
        for (int degree = 0; degree < points; ++degree) {
          Extended sum = 0.0;
          double size = 1.0;
          for (int j = 0; j < points; ++j) {
            const Extended term = w[std::size_t(j)] * std::pow(double(-j), degree);
            sum += term;
            size += std::abs(to_double(term));
          }
          const Extended exact = d > degree ? Extended(0.0) : derivative_of_power(degree, d, position);
          // Each weight is known to a few eps for each of its nodes.
          EXPECT_LE(units(sum - exact), 16 * points * size)
              << points << " points, derivative " << d << ", degree " << degree << ", at " << position;
        }
      }
  });
}

TEST(DerivativeWeights, OfTheFirstDerivativeAtTheNewestPointAreThoseOfTheBdfMethods) {
  for_every_number_of_points([]<int points>() {
    const auto w = derivative_weights<Extended>(points, 1, 0.0);
    const auto alpha = bdf_coefficients<Extended>(points - 1).alpha;
    for (std::size_t j = 0; j < w.size(); ++j) EXPECT_LE(units(w[j] - alpha[j]), 500) << points << ' ' << j;
  });
}

TEST(DerivativeWeights, OfExtrapolationAreBinomial) {
  // f(t + h) ~ 4 f(t) - 6 f(t - h) + 4 f(t - 2 h) - f(t - 3 h): small integers, exactly.
  EXPECT_EQ((derivative_weights<double>(4, 0, 1.0)), (std::array{4.0, -6.0, 4.0, -1.0, 0.0, 0.0, 0.0}));
}

TEST(ChangeWeights, AreTheSameFormulaInDifferences) {
  for_every_number_of_points([]<int points>() {
    for (const double position : {0.0, 1.0})
      for (int d = 1; d < points; ++d) {
        const auto w = derivative_weights<Extended>(points, d, position);
        const auto c = change_weights<Extended>(points, d, position);
        // w_0 = c_0, w_j = c_j - c_{j-1}, w_last = -c_last
        for (int j = 0; j < points; ++j) {
          Extended from_changes = 0.0;
          if (j < points - 1) from_changes += c[std::size_t(j)];
          if (j > 0) from_changes -= c[std::size_t(j - 1)];
          EXPECT_LE(units(from_changes - w[std::size_t(j)]), 1e4) << points << ' ' << d << ' ' << j;
        }
      }
  });
}

TEST(ChangeWeights, OfTheFirstDerivativeAtTheNewestPointAreTheGammaOfTheBdfMethods) {
  for_every_number_of_points([]<int points>() {
    const auto c = change_weights<Extended>(points, 1, 0.0);
    const auto gamma = bdf_coefficients<Extended>(points - 1).gamma;
    for (std::size_t j = 0; j < gamma.size(); ++j)
      EXPECT_LE(units(c[j] - gamma[j]), 500) << points << ' ' << j;
  });
}

TEST(ChangeWeights, GiveExactlyZeroForAConstant) {
  for_every_number_of_points([]<int points>() {
    for (int d = 1; d < points; ++d) {
      const auto c = change_weights<double>(points, d, 1.0);
      const double constant = 0.1;
      double sum = 0.0;
      for (const double weight : c) sum += weight * (constant - constant);
      EXPECT_EQ(sum, 0.0);
    }
  });
}

}  // namespace
}  // namespace liebench::backward_differences_test
