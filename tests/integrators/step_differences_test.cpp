#include "integrators/step_differences.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <limits>

#include "groups/extended.h"
#include "integrators/bdf_coefficients.h"
#include "integrators/order_control.h"
#include "tests/support/heavy_top_motion.h"
#include "tests/support/heavy_top_samples.h"

namespace liebench::step_differences_test {
namespace {

using E = Extended;

// Steps of different lengths, each with a few binary digits.
const std::array<E, 5> steps{E(1.0), E(0.625), E(1.25), E(0.75), E(1.5)};

template <class T>
T gamma(const StepDifferences<T>& d, int k, std::size_t i) {
  T sum(0.0);
  for (std::size_t l = 0; l < std::size_t(k); ++l) sum = sum + d.D[l][i];
  return sum;
}
template <class T>
T sum(int k, const std::array<T, 5>& moments) {
  T sum(0.0);
  for (std::size_t l = 0; l < std::size_t(k); ++l) sum = sum + moments[l];
  return sum;
}

TEST(StepDifferences, OfConstantStepsGiveTheCoefficientsOfBdf) {
  const double h = 0.375;
  const StepDifferences<double> d(std::array{h, h, h, h, h});
  for (int k = 1; k <= 4; ++k) {
    const auto bdf = bdf_coefficients<double>(k);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(gamma(d, k, i), bdf.gamma[i], 1e-15) << k << ' ' << i;
    if (k >= 2) {
      EXPECT_NEAR(sum(k, d.square_moment), h * h, 1e-15) << k;
    }
    if (k >= 3) {
      EXPECT_NEAR(sum(k, d.cubic_moment), 0.0, 1e-15) << k;
    }
  }
}

TEST(StepDifferences, AreExactForPolynomialsAndOfTheirOrderBeyond) {
  const StepDifferences<E> d(steps);
  // U = (t - 1/2)^p, U' at t = 0, where the newest step ends.
  for (int p = 1; p <= 5; ++p) {
    const auto U = [&](const E& t) {
      E product(1.0);
      for (int i = 0; i < p; ++i) product = product * (t - E(0.5));
      return product;
    };
    const E derivative = E(double(p)) * U(E(0.0)) / E(-0.5);
    std::array<E, 5> x, ends;
    E end(0.0);
    for (std::size_t i = 0; i < 5; ++i) {
      x[i] = (U(end) - U(end - steps[i])) / steps[i];
      end = end - steps[i];
      ends[i] = end;
    }
    for (int k = 1; k <= 5; ++k) {
      E sum(0.0);
      for (std::size_t i = 0; i < 5; ++i) sum = sum + gamma(d, k, i) * x[i];
      // phi_k of t^{k+1} is Delta_1 ... Delta_k.
      E expected = derivative;
      if (p == k + 1) {
        E product(1.0);
        for (std::size_t i = 0; i < std::size_t(k); ++i) product = product * -ends[i];
        expected = derivative - product;
      }
      if (p <= k + 1) {
        EXPECT_LE(std::abs(to_double(sum - expected)), 1e-27) << p << ' ' << k;
      }
    }
  }
}

TEST(StepDifferences, HaveTheMomentsOfTheirSteps) {
  const StepDifferences<E> d(steps);
  E end(0.0);
  std::array<E, 5> middle;
  for (std::size_t i = 0; i < 5; ++i) {
    middle[i] = end - steps[i] / E(2.0);
    end = end - steps[i];
    EXPECT_EQ(d.middle[i], middle[i]);
  }
  for (std::size_t l = 0; l < 5; ++l) {
    E square(0.0), cubic(0.0);
    for (std::size_t i = 0; i < 5; ++i) {
      square = square + d.D[l][i] * steps[i] * steps[i];
      cubic = cubic + d.D[l][i] * steps[i] * steps[i] * middle[i];
    }
    EXPECT_LE(std::abs(to_double(square - d.square_moment[l])), 1e-29) << l;
    EXPECT_LE(std::abs(to_double(cubic - d.cubic_moment[l])), 1e-29) << l;
  }
}

// The defect of sum gamma_i Dq_{n+1-i} = v + (S_0 [v, v'] + S_1 [v, v'']) / 12 on the slow top, for steps of h times
// `steps`.
double defect(int k, double h, bool square, bool cubic) {
  using G = SO3<E>;
  static const HeavyTopMotion motion(slow_top(), 0.6);
  std::array<E, 5> hs;
  for (std::size_t i = 0; i < 5; ++i) hs[i] = steps[i] * h;
  const StepDifferences<E> d(hs);
  E t(0.5);
  const auto now = motion.at(t);
  const E width(1e-9);
  const HeavyTopMotion::Vector second =
      (motion.at(E(t + width)).omega_dot - motion.at(E(t - width)).omega_dot) / E(2e-9);
  HeavyTopMotion::Vector sum_of_increments = HeavyTopMotion::Vector::Constant(E(0.0));
  for (std::size_t i = 0; i < std::size_t(k); ++i) {
    const E before = t - hs[i];
    const HeavyTopMotion::Matrix turn = motion.at(before).R.transpose() * motion.at(t).R;
    sum_of_increments += (gamma(d, k, i) / hs[i]) * G::log(turn);
    t = before;
  }
  HeavyTopMotion::Vector r = sum_of_increments - now.omega;
  if (square) r -= (sum(k, d.square_moment) / E(12.0)) * G::commutator(now.omega, now.omega_dot);
  if (cubic) r -= (sum(k, d.cubic_moment) / E(12.0)) * G::commutator(now.omega, second);
  return to_double(r.norm());
}

double order_of_defect(int k, bool square, bool cubic) {
  // O(h^p (1 + c h)): within 0.1 of p for c up to 440 /s = 100 |Omega|.
  constexpr double h = 1.0 / 1600;
  return std::log2(defect(k, h, square, cubic) / defect(k, h / 2, square, cubic));
}

// METHODS.md, section 3: a local error of O(h^{k+1}) of h Dq is a defect of O(h^k).
TEST(CorrectionOfAnySteps, LeavesADefectOfTheOrderOfTheMethod) {
  for (int k = 1; k <= 4; ++k) EXPECT_NEAR(order_of_defect(k, true, true), k, 0.1) << k;
}

TEST(CorrectionOfAnySteps, NeedsTheSecondTermForOrderFourAndTheFirstForThree) {
  EXPECT_NEAR(order_of_defect(3, true, false), 3.0, 0.1);
  EXPECT_NEAR(order_of_defect(4, true, false), 3.0, 0.1);
  for (const int k : {3, 4}) EXPECT_NEAR(order_of_defect(k, false, false), 2.0, 0.1) << k;
}

// By what errors of the past shrink from one doubling of the step to the next, `wait` steps later: the spectral
// radius of what the homogeneous formula of order k makes of changes of U.
double shrinkage(int k, int wait) {
  std::deque<double> h(8, 1.0), x{1.0, -0.75, 0.5, 0.25, -0.5, 1.0, 0.5, 1.0};
  double logarithm = 0.0;
  constexpr int periods = 240, settled = 10;
  for (int n = 0; n < periods * wait; ++n) {
    h.push_front(n % wait == 0 ? 2.0 * h.front() : h.front());
    const std::array<double, 5> newest{h[0], h[1], h[2], h[3], h[4]};
    const StepDifferences<double> d(newest);
    double slope = 0.0;
    for (std::size_t i = 1; i < std::size_t(k); ++i) slope -= gamma(d, k, i) * x[i - 1];
    x.push_front(slope / gamma(d, k, 0));
    if ((n + 1) % wait != 0) continue;
    // Of h x, the changes.
    double largest = 0.0;
    for (std::size_t i = 0; i < std::size_t(k); ++i) largest = std::max(largest, std::abs(x[i]));
    for (double& slope_before : x) slope_before /= largest;
    if (n >= settled * wait) logarithm += std::log(2.0 * largest);
  }
  return std::exp(logarithm / (periods - settled));
}

TEST(OrderControl, KeepsItsStepsLongEnoughForTheFormulasToBeStable) {
  for (int k = 2; k <= 4; ++k) EXPECT_LE(shrinkage(k, k + 1), 0.31) << k;
  EXPECT_NEAR(shrinkage(3, 4), 0.157, 0.003);
  EXPECT_NEAR(shrinkage(4, 5), 0.300, 0.003);
  // Not if the step were doubled in every step.
  for (const int k : {3, 4}) EXPECT_GT(shrinkage(k, 1), 1.4) << k;
}

TEST(OrderControl, WaitsForAsManyStepsAsTheFormulaHasPoints) {
  OrderControl control(4);
  const OrderControl::Errors small{.same = 1e-4};
  EXPECT_EQ(control.accept(small), 1.0);
  EXPECT_TRUE(control.may_change());
  EXPECT_EQ(control.accept(small), 2.0);
  control.step_changed();
  EXPECT_FALSE(control.may_change());
  EXPECT_EQ(control.accept(small), 1.0);
}

TEST(OrderControl, TakesTheOrderOfTheLongestStep) {
  OrderControl control(2);
  control.accept({.same = 0.1});
  // (1.2 0.1^{1/2})^{-1} = 2.6, (1.4 0.001^{1/3})^{-1} = 7.1
  EXPECT_EQ(control.accept({.same = 0.1, .higher = 0.001}), 2.0);
  EXPECT_EQ(control.order(), 2);
  for (int n = 0; n < 3; ++n) control.accept({.lower = 0.9, .same = 0.1, .higher = 1e-9});
  EXPECT_EQ(control.order(), 2);
  // (1.3 0.04^{1/2})^{-1} = 3.8, (1.2 0.5^{1/3})^{-1} = 1.05
  EXPECT_EQ(control.accept({.lower = 0.04, .same = 0.5}), 2.0);
  EXPECT_EQ(control.order(), 1);
}

TEST(OrderControl, ShortensWhatIsRejectedAndFallsBackToOrderOne) {
  OrderControl control(4);
  for (int n = 0; n < 2; ++n) control.accept({.same = 0.1, .higher = 0.001});
  for (int n = 0; n < 3; ++n) control.accept({.lower = 1.0, .same = 0.1, .higher = 0.001});
  ASSERT_EQ(control.order(), 3);
  // (1.2 4^{1/4})^{-1}
  EXPECT_NEAR(control.reject({.lower = 40.0, .same = 4.0}), 0.589, 0.001);
  EXPECT_EQ(control.order(), 3);
  EXPECT_DOUBLE_EQ(control.reject({.lower = 1.5, .same = 4.0}), 1.0 / (1.3 * std::cbrt(1.5)));
  EXPECT_EQ(control.order(), 2);
  EXPECT_DOUBLE_EQ(control.reject({.lower = 40.0, .same = 4.0}), 0.2);
  EXPECT_EQ(control.order(), 1);
  EXPECT_EQ(control.fail(), 0.25);
  EXPECT_DOUBLE_EQ(control.reject({.same = std::numeric_limits<double>::quiet_NaN()}), 0.2);
}

}  // namespace
}  // namespace liebench::step_differences_test
