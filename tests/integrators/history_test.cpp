#include "integrators/history.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "groups/extended.h"

namespace liebench {
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
}  // namespace liebench
