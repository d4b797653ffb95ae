#include "groups/se3.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "groups/extended.h"
#include "tests/support/lie_group_properties.h"

namespace liebench::se3_test {

namespace {

[[maybe_unused]] const bool tested =
    test_lie_group<SE3<double>>("SE3") && test_lie_group<SE3<Extended>>("SE3Extended");

using Motions = SE3<double>;

Motions::Tangent six(double a, double b, double c, double d, double e, double f) {
  Motions::Tangent v;
  v << a, b, c, d, e, f;
  return v;
}

TEST(SE3, TurnsThePositionThatIsMovedInTheBody) {
  // A quarter turn about e3, then a step along the body's e1, which is e2 now.
  const auto turn = Motions::exp(six(0, 0, 0, 0, 0, std::numbers::pi / 2));
  const auto q = Motions::compose(turn, Motions::exp(six(1, 0, 0, 0, 0, 0)));
  EXPECT_LE((q.first - Eigen::Vector3d::UnitY()).norm(), 4e-16);
}

TEST(SE3, ExpOfConstantVelocityIsACircle) {
  // Forward at speed r while turning at rate 1 about e3: a circle of radius r about (0, r, 0).
  const double r = 2.5, t = 1.2;
  const auto q = Motions::exp(six(r * t, 0, 0, 0, 0, t));
  EXPECT_LE((q.first - Eigen::Vector3d(r * std::sin(t), r * (1 - std::cos(t)), 0)).norm(), 16 * 2.3e-16 * r);
}

TEST(SE3, CommutatorOfATurnAndAStepIsAStep) {
  const auto turn = six(0, 0, 0, 0, 0, 1), step = six(1, 0, 0, 0, 0, 0);
  EXPECT_EQ(Motions::commutator(turn, step), six(0, 1, 0, 0, 0, 0));
  EXPECT_EQ(Motions::commutator(step, turn), six(0, -1, 0, 0, 0, 0));
}

TEST(SE3, PositionsAreThatInSpaceAndThatInTheBody) {
  for (const auto& q : LieGroupSamples<Motions>::elements()) {
    EXPECT_EQ(Motions::position(q), q.first);
    EXPECT_EQ(Motions::position_in_body(q), q.second.transpose() * q.first);
  }
}

}  // namespace
}  // namespace liebench::se3_test
