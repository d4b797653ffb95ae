#include <gtest/gtest.h>

#include <cmath>

#include "groups/jet.h"
#include "problems/effects/bushing.h"
#include "problems/effects/joint_friction.h"
#include "problems/effects/motor.h"
#include "problems/effects/torsional_spring.h"
#include "tests/support/effect_laws.h"

// Effects between two bodies.

namespace liebench::joint_effects_test {
namespace {

using Eigen::Vector3d;
using Vector12 = Eigen::Matrix<double, 12, 1>;
const Vector3d axis(0.6, 0.0, 0.8);
// References at a right angle to the axis, of other lengths than one.
const JointAngle<double> joint{2.0 * axis, {1.6, 0.0, -1.2}, {0.8, 0.0, -0.6}};

// The torque on b about the axis of a, and that nothing else acts.
double about_axis(const Vector12& w, const TwoStates<double>& s) {
  const Vector3d n = s.a.R * axis, torque = s.b.R * w.tail<3>();
  EXPECT_LT((torque - n * n.dot(torque)).norm(), 32 * effect_eps * (1.0 + torque.norm()));
  EXPECT_LT((s.a.R * w.segment<3>(3) + torque).norm(), 32 * effect_eps * (1.0 + torque.norm()));
  EXPECT_EQ(w.head<3>().norm() + w.segment<3>(6).norm(), 0.0);
  return n.dot(torque);
}
TwoStates<double> joint_at(double angle, double rate) {
  return turned(RandomStates(11).state(), axis, angle, rate);
}

const TorsionalSpring<double> torsion{joint, 3.0, 0.5, 0.25};

TEST(TorsionalSpring, TorqueAboutTheAxis) {
  for (const double angle : {-3.0, -0.5, 0.0, 1.0, 3.0}) {
    const auto s = joint_at(angle, 2.0);
    EXPECT_NEAR(about_axis(wrenches<double>(torsion, 0.0, s), s), -3.0 * (angle - 0.25) - 1.0,
                64 * effect_eps);
    EXPECT_NEAR(torsion.energy<double>(s.a, s.b), 1.5 * (angle - 0.25) * (angle - 0.25), 64 * effect_eps);
  }
}

TEST(TorsionalSpring, DamperTakesItsPower) {
  TorsionalSpring<double> damper = torsion;
  damper.stiffness = 0.0;
  EXPECT_NEAR(power(damper, 0.0, joint_at(0.7, 2.0)), -0.5 * 4.0, 64 * effect_eps);
}

TEST(TorsionalSpring, Laws) {
  RandomStates random(12);
  for (int n = 0; n < 5; ++n) {
    // Near the joint's positions, axes a little apart.
    auto s = turned(random.state(), axis, 0.5 * n - 1.0, 0.5);
    s.b.R = s.b.R * SO3<double>::exp(0.1 * random.vector());
    s.b.x = random.vector();
    expect_wrenches_are_gradient(torsion, s);
    expect_balance(torsion, 0.0, s);
    expect_jets_are_differences(torsion, 0.0, s);
    expect_cast_agrees(torsion, 0.0, s);
  }
  expect_jets_are_differences(torsion, 0.0, {RigidState<double>::ground(), RigidState<double>::ground()});
}

Bushing<double> bushing(RandomStates& random) {
  return {random.vector(), random.rotation(), random.vector(), random.rotation(),
          {1.0, 2.0, 3.0}, {0.4, 0.5, 0.6},   {0.7, 1.5, 2.5}, {0.1, 0.2, 0.3}};
}
// Frames that are those of the bodies, at their centres.
Bushing<double> central_bushing() {
  RandomStates random(13);
  Bushing<double> central = bushing(random);
  central.point_a = central.point_b = Vector3d::Zero();
  central.frame_a = central.frame_b = Eigen::Matrix3d::Identity();
  return central;
}

TEST(Bushing, SpringsAndDampersAlongTheAxes) {
  auto s = turned(RandomStates(14).state(), axis, 0.0, 0.0);
  const Vector3d shift(0.3, -0.2, 0.1), rate(1.0, 2.0, -1.0);
  s.b.x += s.a.R * shift;
  s.b.u += s.a.R * (rate + s.a.omega.cross(shift));
  const Vector12 w = wrenches<double>(central_bushing(), 0.0, s);
  const Vector3d expected(-0.3 - 0.4, 0.4 - 1.0, -0.3 + 0.6);
  EXPECT_LT((s.a.R.transpose() * w.segment<3>(6) - expected).norm(), 32 * effect_eps);
  EXPECT_LT(w.tail<3>().norm(), 32 * effect_eps);
  // (s . k s) / 2 = (0.09 + 0.08 + 0.03) / 2
  EXPECT_NEAR(central_bushing().energy<double>(s.a, s.b), 0.1, 32 * effect_eps);
  Bushing<double> damper = central_bushing();
  damper.stiffness.setZero();
  EXPECT_NEAR(power(damper, 0.0, s), -(0.4 + 2.0 + 0.6), 64 * effect_eps);
}

TEST(Bushing, TorqueOfALargeRotationAboutAnAxisOfTheFrame) {
  const auto s = turned(RandomStates(15).state(), Vector3d::UnitY(), 2.5, -3.0);
  const Vector12 w = wrenches<double>(central_bushing(), 0.0, s);
  EXPECT_LT((w.tail<3>() - Vector3d::UnitY() * (-1.5 * 2.5 + 0.2 * 3.0)).norm(), 64 * effect_eps);
  EXPECT_NEAR(central_bushing().energy<double>(s.a, s.b), 0.75 * 6.25, 64 * effect_eps);
}

TEST(Bushing, Laws) {
  RandomStates random(16);
  for (int n = 0; n < 5; ++n) {
    const Bushing<double> b = bushing(random);
    auto s = random.states();
    // Rotations from zero to 2.8, clear of pi.
    const Eigen::Matrix3d Q = SO3<double>::exp(0.7 * n * random.vector().normalized());
    s.b.R = s.a.R * b.frame_a * Q * b.frame_b.transpose();
    expect_wrenches_are_gradient(b, s);
    expect_balance(b, 0.0, s);
    expect_jets_are_differences(b, 0.0, s);
    expect_cast_agrees(b, 0.0, s);
  }
}

TEST(Bushing, DerivativesWithoutRotationAreThoseOfTheLinearSpring) {
  const auto J =
      wrench_jacobian(central_bushing(), 0.0, {RigidState<double>::ground(), RigidState<double>::ground()});
  Eigen::Matrix<double, 6, 1> k, c;
  k << 1.0, 2.0, 3.0, 0.7, 1.5, 2.5;
  c << 0.4, 0.5, 0.6, 0.1, 0.2, 0.3;
  const Eigen::Matrix<double, 6, 6> K = k.asDiagonal(), C = c.asDiagonal();
  Eigen::Matrix<double, 12, 24> expected;
  expected << -K, -C, K, C, K, C, -K, -C;
  EXPECT_LT((J - expected).cwiseAbs().maxCoeff(), 16 * effect_eps);
}

TEST(Bushing, JetsOverExtendedScalarsHaveTheirPrecision) {
  using Jet = ceres::Jet<Extended, 1>;
  for (const double angle : {0.0, 1e-9, 0.1, 1.0, 2.5}) {
    RigidState<Jet> a = RigidState<Jet>::ground(), b = a;
    const Eigen::Matrix<Jet, 3, 1> turn(Jet(Extended(angle), 0), Jet(0.0), Jet(0.0));
    b.R = SO3<Jet>::exp(turn);
    const Jet torque =
        wrenches<Jet>(central_bushing().cast<Extended>(), Extended(0.0), TwoStates<Jet>{a, b})(9);
    const Extended k = decimal<Extended>(0.7);
    EXPECT_LT(to_double(abs(torque.a + k * angle)), 64 * to_double(Eigen::NumTraits<Extended>::epsilon()));
    EXPECT_LT(to_double(abs(torque.v(0) + k)), 64 * to_double(Eigen::NumTraits<Extended>::epsilon()));
  }
}

const Motor<double> motor{joint, {{0.5, 1.0}, {}}, 3.0, 0.25, {}};

TEST(Motor, TorqueByTheErrorsOfAngleAndRate) {
  const auto s = joint_at(0.7, 2.0);
  // c = 0.5 + t: errors 0.1 and 1 at t = 0.1.
  EXPECT_NEAR(about_axis(wrenches<double>(motor, 0.1, s), s), -0.3 - 0.25, 64 * effect_eps);
}

TEST(Motor, ErrorIsThatWithinHalfATurn) {
  Motor<double> held = motor;
  held.target.polynomial = {-3.0};
  const auto s = joint_at(3.0, 0.0);
  EXPECT_NEAR(about_axis(wrenches<double>(held, 0.0, s), s), 3.0 * (8.0 * std::atan(1.0) - 6.0),
              64 * effect_eps);
}

TEST(Motor, LimitSaturates) {
  Motor<double> limited = motor;
  limited.torque_limit = 2.0;
  const auto s = joint_at(0.7, 2.0);
  EXPECT_NEAR(about_axis(wrenches<double>(limited, 0.1, s), s), -2.0 * std::tanh(0.275), 64 * effect_eps);
  // Where exp of the error overflows, in any scalar.
  limited.proportional = 1e6;
  EXPECT_NEAR(about_axis(wrenches<double>(limited, 0.1, s), s), -2.0, 64 * effect_eps);
  expect_cast_agrees(limited, 0.1, s);
  EXPECT_TRUE(wrench_jacobian(limited, 0.1, s).allFinite());
}

TEST(Motor, Laws) {
  RandomStates random(17);
  for (int n = 0; n < 4; ++n) {
    Motor<double> m = motor;
    m.target.sines.push_back({0.3, 2.0, 0.1});
    if (n % 2 == 1) m.torque_limit = 2.0;
    auto s = turned(random.state(), axis, 0.4 * n, 0.5);
    s.b.R = s.b.R * SO3<double>::exp(0.1 * random.vector());
    s.b.x = random.vector();
    expect_balance(m, 0.3, s);
    expect_jets_are_differences(m, 0.3, s);
    expect_cast_agrees(m, 0.3, s);
  }
}

const RevoluteFriction<double> revolute{2.0 * axis, 3.0, 0.5};

TEST(RevoluteFriction, OpposesTheRate) {
  for (const double rate : {-1000.0, -0.25, 0.0, 0.1, 2.0}) {
    const auto s = joint_at(0.7, rate);
    EXPECT_NEAR(about_axis(wrenches<double>(revolute, 0.0, s), s), -3.0 * std::tanh(2.0 * rate),
                64 * effect_eps);
    EXPECT_NEAR(power(revolute, 0.0, s), -3.0 * std::tanh(2.0 * rate) * rate,
                64 * effect_eps * (1.0 + std::abs(rate)));
  }
}

const PrismaticFriction<double> prismatic{2.0 * axis, {0.2, -0.1, 0.3}, 3.0, 0.5};

TEST(PrismaticFriction, OpposesWhatSlidesAndNotWhatMovesTogether) {
  auto s = turned(RandomStates(18).state(), axis, 0.0, 0.0);
  const Vector3d n = s.a.R * axis, apart = 1.5 * n;
  s.b.x += apart;
  s.b.u += (s.a.R * s.a.omega).cross(apart);
  EXPECT_LT(wrenches<double>(prismatic, 0.0, s).norm(), 64 * effect_eps);
  s.b.u += 0.25 * n;
  EXPECT_LT((wrenches<double>(prismatic, 0.0, s).segment<3>(6) + 3.0 * std::tanh(0.5) * n).norm(),
            64 * effect_eps);
  EXPECT_NEAR(power(prismatic, 0.0, s), -0.75 * std::tanh(0.5), 64 * effect_eps);
}

TEST(JointFriction, Laws) {
  const auto laws = [](const auto& friction, const TwoStates<double>& s) {
    expect_balance(friction, 0.0, s);
    expect_jets_are_differences(friction, 0.0, s);
    expect_cast_agrees(friction, 0.0, s);
    EXPECT_LE(power(friction, 0.0, s), 0.0);
  };
  RandomStates random(19);
  for (int n = 0; n < 5; ++n) {
    laws(revolute, random.states());
    laws(prismatic, random.states());
  }
  const TwoStates<double> rest{RigidState<double>::ground(), RigidState<double>::ground()};
  expect_jets_are_differences(revolute, 0.0, rest);
  expect_jets_are_differences(prismatic, 0.0, rest);
}

}  // namespace
}  // namespace liebench::joint_effects_test
