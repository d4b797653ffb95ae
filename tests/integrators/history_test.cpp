#include "integrators/history.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <type_traits>

#include "groups/extended.h"

namespace liebench::history_test {
namespace {

using Vector = Eigen::Vector2d;

TEST(History, KeepsTheNewestFirst) {
  History<Vector, 4> history;
  EXPECT_EQ(history.size(), 0);
  for (int n = 0; n < 11; ++n) {
    history.push(Vector(n, -n));
    EXPECT_EQ(history.size(), std::min(n + 1, 4));
    for (int i = 0; i < history.size(); ++i) EXPECT_EQ(history[i], Vector(n - i, i - n)) << n << ' ' << i;
  }
}

TEST(History, ForgetsWhatIsBeyondItsCapacity) {
  History<Vector, 1> history;
  history.push(Vector(1, 2));
  history.push(Vector(3, 4));
  EXPECT_EQ(history.size(), 1);
  EXPECT_EQ(history[0], Vector(3, 4));
}

TEST(History, ElementsCanBeChanged) {
  History<Vector, 3> history;
  for (int n = 0; n < 5; ++n) history.push(Vector(n, 0));
  history[1] += Vector(0, 7);
  EXPECT_EQ(history[0], Vector(4, 0));
  EXPECT_EQ(history[1], Vector(3, 7));
  EXPECT_EQ(history[2], Vector(2, 0));
}

// A ring, for any size; sums go by threes, and for six without a loop.
TEST(History, OfRunTimeSizeIsTheSameAsOfFixedSize) {
  const auto expect_same = []<int n>(std::integral_constant<int, n>) {
    using Fixed = Eigen::Matrix<double, n, 1>;
    History<Fixed, 5> fixed(4);
    History<Eigen::VectorXd, 5> ring(4, Eigen::VectorXd::Zero(n));
    for (int step = 1; step < 12; ++step) {
      Fixed value;
      for (int i = 0; i < n; ++i) value(i) = std::sin(1.0 + step * (i + 1));
      fixed.push(value);
      ring.push(value);
      ASSERT_EQ(ring.size(), fixed.size());
      for (int i = 0; i < 4; ++i) EXPECT_EQ(Fixed(ring[i]), fixed[i]) << n << ' ' << step;
      EXPECT_EQ(Fixed(ring.extrapolated()), fixed.extrapolated()) << n << ' ' << step;
    }
  };
  expect_same(std::integral_constant<int, 1>());
  expect_same(std::integral_constant<int, 3>());
  expect_same(std::integral_constant<int, 6>());
  expect_same(std::integral_constant<int, 11>());
}

// Integers: every operation is exact.
TEST(History, ExtrapolatesPolynomialsUpToItsDegreeExactly) {
  const auto polynomial = [](int degree, int n) {
    Vector value(1, 2);
    for (int i = 0; i < degree; ++i) value = value * n + Vector(i + 3, 5 - 2 * i);
    return value;
  };
  for (int degree = 0; degree < 6; ++degree) {
    History<Vector, 6> history;
    for (int n = -4; n < 9; ++n) {
      if (history.size() > degree) {
        EXPECT_EQ(history.extrapolated(), polynomial(degree, n)) << degree << ' ' << n;
      }
      history.push(polynomial(degree, n));
    }
  }
}

TEST(History, DoesNotExtrapolateHigherDegrees) {
  History<Vector, 3> history;
  for (int n = 0; n < 3; ++n) history.push(Vector(n * n * n, 0));
  EXPECT_EQ(history.extrapolated(), Vector(27 - 6, 0));  // the third difference of n^3 is 6
}

TEST(History, ExtrapolatesInTheScalarOfTheVectors) {
  using Wide = Eigen::Matrix<Extended, 3, 1>;
  History<Wide, 3> history;
  const Extended third = Extended(1.0) / 3.0;
  for (int n = 1; n <= 3; ++n) history.push(Wide::Constant(third * double(n)));
  const double error = to_double(Extended(history.extrapolated()(1) - third * 4.0));
  EXPECT_LE(std::abs(error), 20 * to_double(Eigen::NumTraits<Extended>::epsilon()));
}

}  // namespace
}  // namespace liebench::history_test
