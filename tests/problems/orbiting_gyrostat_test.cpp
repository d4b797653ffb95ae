#include "problems/orbiting_gyrostat.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <type_traits>

#include "problems/check_system.h"
#include "tests/support/jets.h"

namespace liebench::orbiting_gyrostat_test {
namespace {

using Gyrostat = OrbitingGyrostat<double>;
using Vector = Gyrostat::Vector;
using Matrix = Gyrostat::Matrix;

TEST(OrbitingGyrostat, SaysTheSameInAllItsFunctions) {
  OrbitingGyrostatParameters fast;
  fast.orbital_rate = 0.9;
  fast.wheel_momentum = {0.7, -2, 5};
  fast.angular_velocity = {1, -2, 0.5};
  for (const OrbitingGyrostatParameters& parameters : {OrbitingGyrostatParameters{}, fast}) {
    const SystemCheck check = check_system(Gyrostat(parameters));
    EXPECT_TRUE(check.extended);
    ASSERT_NE(check.find(Law::energy_balance), nullptr);
    for (const LawCheck& law : check.laws) EXPECT_TRUE(law.holds) << message(law);
  }
}

// It rests relative to the orbit's frame where the axes of the body are those of the frame and the momentum of the wheel is along the
// orbit's normal. Turned a little about that normal, it swings as a pendulum of frequency n sqrt(3 (J_y - J_x) / J_z) [Hughes 1986,
// section 9.1].
TEST(OrbitingGyrostat, RestsAlongTheOrbitAndSwingsAboutItsNormalAsKnown) {
  OrbitingGyrostatParameters p;
  p.wheel_momentum = {0, 0, 0.01};
  const Gyrostat gyrostat(p);
  const Matrix along = Matrix::Identity();
  const Vector still = Vector::Zero();
  // Round-off of J n^2, 1.6e-5 kg m^2/s^2.
  EXPECT_LE(gyrostat.force(0.0, along, still).norm(), 1e-20);
  const Matrix K = gyrostat.stiffness(0.0, along, still, still, {});
  const double n = p.orbital_rate, squared = 3.0 * n * n * (11.0 - 4.0) / 13.0;
  EXPECT_NEAR(K(2, 2) / 13.0, squared, 1e-14 * squared);
  EXPECT_EQ(K(2, 0), 0.0);
  EXPECT_EQ(K(2, 1), 0.0);
  p.wheel_momentum = {0, 0.01, 0};
  EXPECT_GT(Gyrostat(p).force(0.0, along, still).norm(), 1e-6);
}

// The torque of an inverse-square field, whose centre is a e away, on six masses of 1 kg in pairs at +-b_k on the axes of the body, which
// do not know of J.
Vector torque_on_masses(const Vector& b, const Vector& e, double a, double n) {
  Vector torque = Vector::Zero();
  for (int k = 0; k < 3; ++k)
    for (const double side : {-1.0, 1.0}) {
      const Vector arm = side * b(k) * Vector::Unit(k), from_centre = a * e + arm;
      const double mu = n * n * a * a * a;
      torque += arm.cross(-mu / std::pow(from_centre.norm(), 3) * from_centre);
    }
  return torque;
}

// The momentum in the inertial frame, R_o R (J (Omega + n c) + s) with R_o about z at the rate n, changes by the torque of gravity.
TEST(OrbitingGyrostat, KeepsTheLawOfMomentumInTheInertialFrame) {
  const Vector b(1.0, std::sqrt(2.0), std::sqrt(3.0));
  OrbitingGyrostatParameters p;
  p.inertia = {10, 8, 6};  // 2 (b_2^2 + b_3^2), ...
  p.orbital_rate = 0.6;
  p.wheel_momentum = {0.3, -2, 5};
  p.angular_velocity = {0.4, -0.7, 0.2};
  const Gyrostat gyrostat(p);
  const Matrix R = gyrostat.initial_configuration();
  const Vector omega = gyrostat.initial_velocity();
  const Vector omega_dot = -gyrostat.force(0.0, R, omega).cwiseQuotient(Vector(10, 8, 6));
  const Vector change = directional_derivative_by_jets(
      gyrostat, R, omega, [&](const auto& system, const auto& q, const auto& t) {
        using J = typename std::remove_cvref_t<decltype(system)>::Scalar;
        using JetVector = Eigen::Matrix<J, 3, 1>;
        const JetVector relative = in_scalar_of(system, omega) + in_scalar_of(system, omega_dot) * t;
        const JetVector total = relative + J(p.orbital_rate) * q.row(2).transpose();
        const JetVector momentum = total.cwiseProduct(in_scalar_of(system, Vector(10, 8, 6))) +
                                   in_scalar_of(system, Vector(0.3, -2, 5));
        const JetVector turned = q * momentum, z(J(0.0), J(0.0), J(1.0));
        return JetVector(turned + J(p.orbital_rate) * t * z.cross(turned));
      });
  // The field at the distance a differs from its gradient by (b / a)^2 = 3e-8 of it.
  const Vector torque = R * torque_on_masses(b, R.row(0).transpose(), 1e4, p.orbital_rate);
  EXPECT_GT(torque.norm(), 0.1);
  EXPECT_LE((change - torque).norm(), 1e-6 * torque.norm());
}

TEST(OrbitingGyrostat, RefusesMomentsOfNoBodyAndNoOrientation) {
  OrbitingGyrostatParameters p;
  EXPECT_FALSE(Gyrostat::refusal(p));
  p.inertia = {1, 2, 3};  // of a plate
  EXPECT_FALSE(Gyrostat::refusal(p));
  p.inertia = {1, 2, 3.001};
  ASSERT_TRUE(Gyrostat::refusal(p));
  EXPECT_EQ(Gyrostat::refusal(p)->parameter, "inertia");
  p = {};
  p.orientation = {0, 0, 0, 0};
  ASSERT_TRUE(Gyrostat::refusal(p));
  EXPECT_EQ(Gyrostat::refusal(p)->parameter, "orientation");
}

}  // namespace
}  // namespace liebench::orbiting_gyrostat_test
