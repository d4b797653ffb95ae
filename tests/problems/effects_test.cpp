#include <gtest/gtest.h>

#include <cmath>

#include "problems/effects/applied_force.h"
#include "problems/effects/contact.h"
#include "problems/effects/drag.h"
#include "problems/effects/point_gravity.h"
#include "tests/support/effect_laws.h"

// Effects on one body.

namespace liebench::effects_test {
namespace {

using Eigen::Vector3d;
const Vector3d ex = Vector3d::UnitX(), ey = Vector3d::UnitY(), ez = Vector3d::UnitZ();
using Vector12 = Eigen::Matrix<double, 12, 1>;

TwoStates<double> at_rest() {
  return {RigidState<double>::ground(), RigidState<double>::ground()};
}
void expect_wrench(const Vector12& w, const Vector3d& force, const Vector3d& torque) {
  EXPECT_LT((w.head<3>() - force).norm(), 16 * effect_eps * (1.0 + force.norm()));
  EXPECT_LT((w.segment<3>(3) - torque).norm(), 16 * effect_eps * (1.0 + torque.norm()));
}

PointGravity<double> planet() {
  return {5.0, {1.0, 0.0, -1.0}, 2.0, Vector3d(1.0, 2.0, 3.0).asDiagonal()};
}

TEST(PointGravity, ForceAndEnergyOnAPrincipalAxis) {
  auto s = at_rest();
  s.a.x = {3.0, 0.0, -1.0};
  // d = 2 e_x: U = -GM m / 2 - 7.5 / 8, f = -GM m / 4 - 22.5 / 16.
  EXPECT_NEAR(planet().energy<double>(s.a, s.b), -5.9375, 16 * effect_eps);
  expect_wrench(wrenches<double>(planet(), 0.0, s), -3.90625 * ex, 0.0 * ex);
}

TEST(PointGravity, TorqueTurnsTheLeastInertiaToTheCentre) {
  auto s = at_rest();
  s.a.x = {3.0, 0.0, -1.0};
  s.a.R = SO3<double>::exp(ez * std::atan(1.0));
  // rho = sqrt(2) (1, -1, 0): (3 GM / 32) (J_y - J_x) rho_x rho_y.
  EXPECT_NEAR(wrenches<double>(planet(), 0.0, s)(5), -0.9375, 16 * effect_eps);
}

TEST(PointGravity, BallIsAttractedAsAPoint) {
  auto ball = planet(), point = planet();
  ball.inertia = 3.0 * Eigen::Matrix3d::Identity();
  point.inertia.setZero();
  auto s = RandomStates(1).states();
  s.a.x += 3.0 * ex;
  const Vector12 w = wrenches<double>(point, 0.0, s);
  EXPECT_EQ(w.tail<9>().norm(), 0.0);
  EXPECT_LT((wrenches<double>(ball, 0.0, s) - w).norm(), 100 * effect_eps);
}

TEST(PointGravity, Laws) {
  RandomStates random(2);
  for (int n = 0; n < 5; ++n) {
    auto s = random.states();
    s.a.x += 3.0 * ey;
    expect_wrenches_are_gradient(planet(), s);
    expect_jets_are_differences(planet(), 0.0, s);
    expect_cast_agrees(planet(), 0.0, s);
  }
}

const Drag<double> drag{1.0, 2.0, 0.5, 0.25};

TEST(Drag, OpposesLinearlyAndQuadratically) {
  auto s = at_rest();
  s.a.u = {3.0, 4.0, 0.0};
  s.a.omega = {0.0, 0.0, 2.0};
  expect_wrench(wrenches<double>(drag, 0.0, s), {-33.0, -44.0, 0.0}, {0.0, 0.0, -2.0});
  EXPECT_NEAR(power(drag, 0.0, s), -11.0 * 25.0 - 4.0, 1e3 * effect_eps);
}

TEST(Drag, DerivativeAtRestIsThatOfTheLinearPart) {
  const auto J = wrench_jacobian(drag, 0.0, at_rest());
  Eigen::Matrix<double, 12, 24> expected = Eigen::Matrix<double, 12, 24>::Zero();
  expected.block<3, 3>(0, 6).diagonal().setConstant(-1.0);
  expected.block<3, 3>(3, 9).diagonal().setConstant(-0.5);
  EXPECT_EQ(J, expected);
}

TEST(Drag, Laws) {
  RandomStates random(3);
  for (int n = 0; n < 5; ++n) {
    const auto s = random.states();
    expect_jets_are_differences(drag, 0.0, s);
    expect_cast_agrees(drag, 0.0, s);
    EXPECT_LT(power(drag, 0.0, s), 0.0);
  }
}

TEST(AppliedForce, ActsInTheFrameThatIsNamed) {
  auto s = at_rest();
  s.a.R = SO3<double>::exp(ez * (2.0 * std::atan(1.0)));
  AppliedForce<double> push{ex, 0.5 * ez, ex, ForceFrame::inertial, TimeFunction<double>::constant(2.0)};
  expect_wrench(wrenches<double>(push, 0.0, s), 2.0 * ex, -ez);
  push.frame = ForceFrame::body;
  expect_wrench(wrenches<double>(push, 0.0, s), 2.0 * ey, ez);
}

TEST(AppliedForce, Laws) {
  RandomStates random(4);
  for (const ForceFrame frame : {ForceFrame::inertial, ForceFrame::body}) {
    const AppliedForce<double> push{{0.3, -0.2, 0.7},
                                    {0.1, 0.4, -0.6},
                                    {0.5, 0.2, -0.3},
                                    frame,
                                    TimeFunction<double>::expression("1 + sin(2*pi*t)")};
    const auto s = random.states();
    expect_jets_are_differences(push, 0.2, s);
    expect_cast_agrees(push, 0.2, s);
    EXPECT_LT((wrenches<double>(push, 0.25, s) - 2.0 * wrenches<double>(push, 0.0, s)).norm(),
              16 * effect_eps);
  }
}

// A ball on the floor: penetration 0.2 where its centre is at the origin.
Contact<double> ball_contact(ContactLaw law = ContactLaw::linear) {
  return {{0.0, 0.0, 0.0}, 0.5, {7.0, -3.0, -0.3}, {0.0, 0.0, 2.0}, law, 10.0, 2.0, 0.5, 4.0};
}

TEST(Contact, NormalForceFollowsThePenetration) {
  const auto s = at_rest();
  expect_wrench(wrenches<double>(ball_contact(), 0.0, s), 2.0 * ez, 0.0 * ex);
  EXPECT_NEAR(ball_contact().energy<double>(s.a, s.b), 0.2, 16 * effect_eps);
  const auto hertz = ball_contact(ContactLaw::hertz);
  expect_wrench(wrenches<double>(hertz, 0.0, s), 10.0 * std::pow(0.2, 1.5) * ez, 0.0 * ex);
  EXPECT_NEAR(hertz.energy<double>(s.a, s.b), 4.0 * std::pow(0.2, 2.5), 16 * effect_eps);
}

TEST(Contact, DampingNeverAttracts) {
  auto s = at_rest();
  s.a.u = -ez;
  expect_wrench(wrenches<double>(ball_contact(), 0.0, s), 4.0 * ez, 0.0 * ex);
  s.a.u = 3.0 * ez;
  EXPECT_EQ(wrenches<double>(ball_contact(), 0.0, s), Vector12::Zero());
}

TEST(Contact, EndsWhereTheSphereLeavesThePlane) {
  auto s = at_rest();
  s.a.x = 0.25 * ez;
  s.a.u = {1.0, 0.0, -1.0};
  EXPECT_EQ(wrenches<double>(ball_contact(), 0.0, s), Vector12::Zero());
  EXPECT_EQ(ball_contact().energy<double>(s.a, s.b), 0.0);
  EXPECT_EQ(wrench_jacobian(ball_contact(), 0.0, s).norm(), 0.0);
}

TEST(Contact, FrictionActsOnTheSlidingPointAndNotOnARollingOne) {
  auto s = at_rest();
  s.a.u = 3.0 * ex;
  // mu f_n 3 / 5, with the arm 0.5.
  expect_wrench(wrenches<double>(ball_contact(), 0.0, s), {-0.6, 0.0, 2.0}, 0.3 * ey);
  s.a.omega = 6.0 * ey;
  expect_wrench(wrenches<double>(ball_contact(), 0.0, s), 2.0 * ez, 0.0 * ex);
}

TEST(Contact, Laws) {
  RandomStates random(5);
  for (const ContactLaw law : {ContactLaw::linear, ContactLaw::hertz})
    for (int n = 0; n < 4; ++n) {
      Contact<double> contact = ball_contact(law);
      contact.point = 0.5 * random.vector();
      contact.normal = random.vector();
      auto s = random.states();
      // Half of the radius deep, where the stencil and the damping leave it in contact.
      contact.damping = 0.25;
      contact.plane_point = s.a.point(contact.point) - 0.25 * contact.normal / contact.normal.norm();
      ASSERT_GT(wrenches<double>(contact, 0.0, s).norm(), 0.0);
      expect_jets_are_differences(contact, 0.0, s);
      expect_cast_agrees(contact, 0.0, s);
      expect_wrenches_are_gradient(
          [&] {
            auto smooth = contact;
            smooth.friction = 0.0;
            return smooth;
          }(),
          s);
      s.a.u = s.a.omega = Vector3d::Zero();
      expect_jets_are_differences(contact, 0.0, s);
    }
}

}  // namespace
}  // namespace liebench::effects_test
