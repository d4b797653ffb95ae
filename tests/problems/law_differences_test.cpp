#include "problems/law_differences.h"

#include <gtest/gtest.h>

#include <cmath>

#include "groups/extended.h"

namespace liebench::law_differences_test {
namespace {

template <class T, class F>
SidedDerivative derivative_of(const F& f, double unit = 1.0) {
  return sided_derivative<T>(
      [&](const T& x) { return WitnessVector<T>(WitnessVector<T>::Constant(1, f(x))); }, unit);
}

TEST(LawDifferences, InExtendedPrecisionAreRightToTheRoundOffOfDouble) {
  const auto D = derivative_of<Extended>([](const Extended& x) { return Extended(exp(sin(x) + 0.5)); });
  const double expected = std::exp(0.5);
  EXPECT_NEAR(D.left(0), expected, D.error(0) + double_eps * expected);
  EXPECT_NEAR(D.right(0), expected, D.error(0) + double_eps * expected);
  // 64 roundings of size 1.6, 16 sqrt(eps) apart.
  EXPECT_LT(D.error(0), 8 * double_eps);
  EXPECT_NEAR(D.nearest(0, expected), expected, D.error(0));
}

TEST(LawDifferences, InDoubleErrByNoMoreThanTheySay) {
  for (const double frequency : {1.0, 30.0, 1e3}) {
    const auto D = derivative_of<double>([&](double x) { return std::sin(frequency * x + 1.0); });
    const double expected = frequency * std::cos(1.0);
    EXPECT_LE(std::abs(D.left(0) - expected), D.error(0)) << frequency;
    EXPECT_LE(std::abs(D.right(0) - expected), D.error(0)) << frequency;
    EXPECT_LT(D.error(0), 1e-8 * std::pow(frequency, 3)) << frequency;
  }
}

TEST(LawDifferences, SeeASmallScale) {
  // Friction: tanh(x / w), whose scale the step in double does not resolve and that in extended precision does.
  const double w = 1e-5;
  const auto D = derivative_of<Extended>([&](const Extended& x) { return Extended(tanh(x / w + 0.3)); });
  const double expected = (1.0 - std::pow(std::tanh(0.3), 2)) / w;
  EXPECT_NEAR(D.left(0), expected, D.error(0) + 8 * double_eps * expected);
  EXPECT_LT(D.error(0), 1e-12 * expected);
}

TEST(LawDifferences, HaveBothSidesOfAKink) {
  const auto D =
      derivative_of<Extended>([](const Extended& x) { return x < Extended(0.0) ? Extended(0.0) : x * 3.0; });
  EXPECT_NEAR(D.left(0), 0.0, D.error(0));
  EXPECT_NEAR(D.right(0), 3.0, D.error(0));
  EXPECT_EQ(D.nearest(0, 2.0), 2.0);
  EXPECT_EQ(D.nearest(0, 4.0), D.right(0));
  EXPECT_EQ(D.nearest(0, -1.0), D.left(0));
}

TEST(LawDifferences, TakeTheAbsoluteSquareAtRest) {
  // Quadratic drag, |x| x: a jump of the second derivative only.
  const auto D = derivative_of<Extended>([](const Extended& x) { return Extended(abs(x) * x * 5.0); });
  EXPECT_NEAR(D.left(0), 0.0, D.error(0));
  EXPECT_NEAR(D.right(0), 0.0, D.error(0));
  EXPECT_LT(D.error(0), 1e-13);
}

TEST(LawDifferences, OfTheSecondOrderKnowTheirError) {
  const auto second = []<class T>(auto f, T, double unit) {
    return second_derivative<T>(
        [&](const T& x) { return WitnessVector<T>(WitnessVector<T>::Constant(1, T(f(x)))); }, unit, 1.0);
  };
  const double expected = -std::sin(0.7);
  const auto wide = second([](const Extended& x) { return sin(x + 0.7); }, Extended(0.0), 1.0);
  EXPECT_NEAR(wide.value(0), expected, wide.error(0) + 2 * double_eps);
  EXPECT_LT(wide.error(0), double_eps);
  const auto narrow = second([](double x) { return std::sin(x + 0.7); }, 0.0, 1.0);
  EXPECT_NEAR(narrow.value(0), expected, narrow.error(0));
  EXPECT_LT(narrow.error(0), 1e-7);
}

TEST(LawDifferences, ANumberThatIsNoneIsNoExpectation) {
  const auto D = derivative_of<double>([](double x) { return std::sqrt(x); });
  EXPECT_TRUE(std::isnan(D.nearest(0, 1.0)));
}

}  // namespace
}  // namespace liebench::law_differences_test
