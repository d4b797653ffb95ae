#include <gtest/gtest.h>

#include <limits>

#include "harness/outside/quaternion_top.h"
#include "harness/outside/stabilized_top.h"
#include "tests/support/heavy_top_motion.h"

// The equations that are handed to solvers from outside, against the formulations of problems/ and against differences.

namespace liebench::outside {
namespace {

// A top of no symmetry in a general position.
HeavyTopParameters general_top() {
  return {.mass = 3.0,
          .inertia = {{{0.5, 0.05, -0.02}, {0.05, 0.7, 0.04}, {-0.02, 0.04, 0.9}}},
          .center_of_mass = {0.2, 0.9, -0.3},
          .gravity = {0.5, -1.0, -9.81},
          .angular_velocity = {1.0, 7.0, -2.0},
          .orientation = {0.6, -0.3, 0.4, 0.7}};
}

constexpr double eps = std::numeric_limits<double>::epsilon();

// Central differences of step d err by d^2 times third derivatives, and by eps / d times values, both of the size of a
// hundred here.
constexpr double difference = 1e-5;
constexpr double difference_error = 1e-7;

template <class Vector, class Function>
auto differences(const Vector& at, const Function& function) {
  constexpr int size = Vector::RowsAtCompileTime;
  Eigen::Matrix<double, size, size> D;
  for (int i = 0; i < size; ++i) {
    Vector step = Vector::Zero();
    step(i) = difference;
    D.col(i) = (function(Vector(at + step)) - function(Vector(at - step))) / (2.0 * difference);
  }
  return D;
}

QuaternionTop::Vector some_state() {
  QuaternionTop::Vector y;
  y << 0.5, -0.7, 0.3, 0.4, 2.0, -3.0, 5.0;
  return y;
}

TEST(QuaternionTopTest, IsTheTopOfS3OnUnitQuaternions) {
  const QuaternionTop top(general_top());
  const HeavyTopS3<double> system(general_top());
  QuaternionTop::Vector y = some_state(), f;
  y.head<4>().normalize();
  top.derivative(0.0, y, f);
  const Vector4 p = y.head<4>();
  const Vector3 omega = y.tail<3>();
  const Vector3 residual = system.momentum(p, Vector3(f.tail<3>())) + system.force(0.0, p, omega);
  EXPECT_LE(residual.norm(), 100.0 * eps * system.force(0.0, p, omega).norm());
  const Vector4 p_dot = 0.5 * quaternion_product<double>(p, quaternion_of<double>(0.0, omega));
  EXPECT_LE((f.head<4>() - p_dot).norm(), 4.0 * eps * p_dot.norm());
}

TEST(QuaternionTopTest, TheLengthOfTheQuaternionHasNoEffect) {
  const QuaternionTop top(general_top());
  QuaternionTop::Vector y = some_state(), longer = y, f, f_longer;
  longer.head<4>() *= 3.0;
  top.derivative(0.0, y, f);
  top.derivative(0.0, longer, f_longer);
  EXPECT_LE((f_longer.tail<3>() - f.tail<3>()).norm(), 100.0 * eps * f.norm());
  EXPECT_LE(std::abs(f.head<4>().dot(y.head<4>())), 10.0 * eps * f.norm()) << "p' is at right angles to p";
}

TEST(QuaternionTopTest, TheJacobianIsTheDerivative) {
  const QuaternionTop top(general_top());
  QuaternionTop::Matrix J;
  top.jacobian(0.0, some_state(), J);
  const auto D = differences(some_state(), [&](const QuaternionTop::Vector& y) {
    QuaternionTop::Vector f;
    top.derivative(0.0, y, f);
    return f;
  });
  EXPECT_LE((J - D).cwiseAbs().maxCoeff(), difference_error * J.cwiseAbs().maxCoeff());
}

StabilizedTop::Vector some_point() {
  StabilizedTop::Vector y;
  y << 0.3, -0.8, 0.5, 0.5, -0.7, 0.3, 0.4, 1.0, 2.0, -1.5, 2.0, -3.0, 5.0, 10.0, -20.0, 15.0, 0.3, -0.2, 0.1,
      0.6;
  return y;
}
StabilizedTop::Vector some_rate() {
  StabilizedTop::Vector rate;
  for (int i = 0; i < StabilizedTop::size; ++i) rate(i) = std::sin(1.0 + i);
  return rate;
}

TEST(StabilizedTopTest, IsTheTopOfR3xS3WithMultipliersOfTheHiddenConstraint) {
  using System = HeavyTopR3xS3<double>;
  const System system(general_top());
  const StabilizedTop top(general_top());
  StabilizedTop::Vector y = some_point(), F;
  y.segment<4>(3).normalize();
  const StabilizedTop::Vector rate = some_rate();
  top.residual(y, rate, F);
  const Vector4 p = y.segment<4>(3);
  const System::Element q{y.head<3>(), p};
  const System::Vector6 v = y.segment<6>(7), acceleration = rate.segment<6>(7);
  const Vector3 lambda = y.segment<3>(13), eta = y.segment<3>(16);

  System::Vector6 balance =
      system.momentum(q, acceleration) + system.force(0.0, q, v) + system.constraint_force(q, lambda);
  balance.head<3>() /= general_top().mass;
  EXPECT_LE((F.segment<6>(7) - balance).norm(), 1000.0 * eps * balance.norm());

  const System::Vector6 corrected = v - system.constraint_force(q, eta);
  EXPECT_LE((F.head<3>() - (rate.head<3>() - corrected.head<3>())).norm(), 100.0 * eps);
  const Vector4 p_dot =
      0.5 * quaternion_product<double>(p, quaternion_of<double>(0.0, Vector3(corrected.tail<3>()))) +
      y(19) * p;
  EXPECT_LE((F.segment<4>(3) - (rate.segment<4>(3) - p_dot)).norm(), 100.0 * eps);

  EXPECT_LE((F.segment<3>(13) - system.constraint(q)).norm(), 100.0 * eps);
  EXPECT_LE((F.segment<3>(16) + system.constraint_gradient(q) * v).norm(), 100.0 * eps);
  EXPECT_LE(std::abs(F(19)), 4.0 * eps);
}

TEST(StabilizedTopTest, IsFulfilledByTheExactMotion) {
  const HeavyTopParameters parameters = general_top();
  const StabilizedTop top(parameters);
  const HeavyTopMotion motion(parameters, 0.5);
  const HeavyTopR3xS3<double> system(parameters);
  for (const double t : {0.0, 0.2, 0.5}) {
    const auto point = motion.point(system, Extended(t));
    StabilizedTop::Vector y, rate, F;
    y << point.q.first, point.q.second, point.v, point.lambda, Vector4::Zero();
    rate << point.v.head<3>(),
        0.5 * quaternion_product<double>(point.q.second,
                                         quaternion_of<double>(0.0, Vector3(point.v.tail<3>()))),
        point.acceleration, Eigen::Matrix<double, 7, 1>::Zero();
    top.residual(y, rate, F);
    EXPECT_LE(F.cwiseAbs().maxCoeff(), 1000.0 * eps * rate.norm()) << t;
  }
}

TEST(StabilizedTopTest, TheInitialValuesAreConsistent) {
  for (const HeavyTopParameters& parameters : {HeavyTopParameters{}, general_top()}) {
    const StabilizedTop top(parameters);
    StabilizedTop::Vector F;
    top.residual(top.initial(), top.initial_rate(), F);
    EXPECT_LE(F.cwiseAbs().maxCoeff(), 1000.0 * eps * top.initial_rate().norm());
    EXPECT_EQ(top.initial().tail<4>(), Vector4::Zero()) << "eta and mu";
  }
}

TEST(StabilizedTopTest, TheJacobianIsTheDerivative) {
  const StabilizedTop top(general_top());
  const double c = 3.7;
  StabilizedTop::Matrix J;
  top.jacobian(some_point(), c, J);
  const auto residual = [&](const StabilizedTop::Vector& y, const StabilizedTop::Vector& rate) {
    StabilizedTop::Vector F;
    top.residual(y, rate, F);
    return F;
  };
  const StabilizedTop::Matrix D =
      differences(some_point(), [&](const StabilizedTop::Vector& y) { return residual(y, some_rate()); }) +
      c * differences(some_rate(), [&](const StabilizedTop::Vector& r) { return residual(some_point(), r); });
  EXPECT_LE((J - D).cwiseAbs().maxCoeff(), difference_error * J.cwiseAbs().maxCoeff());
}

}  // namespace
}  // namespace liebench::outside
