#pragma once

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "groups/extended.h"
#include "groups/so3.h"
#include "problems/scene_bodies.h"
#include "tests/support/jets.h"

// Laws of effects (problems/effects) at given states of their bodies, and the states.

namespace liebench {

inline constexpr double effect_eps = std::numeric_limits<double>::epsilon();

template <class U>
struct TwoStates {
  RigidState<U> a, b;
};

// Places, velocities and directions of size one, the same in every run.
class RandomStates {
 public:
  explicit RandomStates(unsigned seed) : random_(seed) {}
  Eigen::Vector3d vector() { return {number(), number(), number()}; }
  Eigen::Matrix3d rotation() { return SO3<double>::exp(2.0 * vector()); }
  RigidState<double> state() { return {vector(), rotation(), vector(), vector()}; }
  TwoStates<double> states() { return {state(), state()}; }

 private:
  double number() { return double(random_()) / 2147483648.0 - 1.0; }
  std::mt19937 random_;
};

// b as a joint has it: turned from a by the angle [rad] about the axis n_a at the rate [rad/s], centres in one place.
inline TwoStates<double> turned(const RigidState<double>& a, const Eigen::Vector3d& n_a, double angle,
                                double rate) {
  const Eigen::Matrix3d Q = SO3<double>::exp(n_a * angle);
  return {a, {a.x, a.R * Q, a.u, Q.transpose() * (a.omega + n_a * rate)}};
}

// The wrenches (f_a, tau_a, f_b, tau_b).
template <class U, class E, class T>
Eigen::Matrix<U, 12, 1> wrenches(const E& effect, const T& t, const TwoStates<U>& s) {
  Wrench<U> on_a = Wrench<U>::zero(), on_b = Wrench<U>::zero();
  effect.template add_wrenches<U>(t, s.a, s.b, on_a, on_b);
  Eigen::Matrix<U, 12, 1> all;
  all << on_a.force, on_a.torque, on_b.force, on_b.torque;
  return all;
}

// Changed by (delta x, delta theta, delta x', delta Omega).
template <class U>
RigidState<U> moved(const RigidState<double>& s, const Eigen::Matrix<U, 12, 1>& delta) {
  const Eigen::Matrix<U, 3, 1> turn = delta.template segment<3>(3);
  return {s.x.cast<U>() + delta.template head<3>(), s.R.cast<U>() * SO3<U>::exp(turn),
          s.u.cast<U>() + delta.template segment<3>(6), s.omega.cast<U>() + delta.template tail<3>()};
}
template <class U>
TwoStates<U> moved(const TwoStates<double>& s, const Eigen::Matrix<U, 24, 1>& delta) {
  return {moved<U>(s.a, delta.template head<12>()), moved<U>(s.b, delta.template tail<12>())};
}
template <int n>
Eigen::Matrix<ceres::Jet<double, n>, n, 1> jet_variables() {
  Eigen::Matrix<ceres::Jet<double, n>, n, 1> delta;
  for (int i = 0; i < n; ++i) delta(i) = ceres::Jet<double, n>(0.0, i);
  return delta;
}

// Of the wrenches by what moves the bodies, 12 x 24.
template <class E>
Eigen::Matrix<double, 12, 24> wrench_jacobian(const E& effect, double t, const TwoStates<double>& s) {
  using Jet = ceres::Jet<double, 24>;
  const auto w = wrenches<Jet>(effect, t, moved<Jet>(s, jet_variables<24>()));
  Eigen::Matrix<double, 12, 24> J;
  for (int i = 0; i < 12; ++i) J.row(i) = w(i).v.transpose();
  return J;
}

template <class E>
void expect_jets_are_differences(const E& effect, double t, const TwoStates<double>& s) {
  const Eigen::Matrix<double, 12, 24> J = wrench_jacobian(effect, t, s);
  ASSERT_TRUE(J.allFinite());
  Eigen::Matrix<double, 12, 24> D;
  for (int j = 0; j < 24; ++j)
    D.col(j) = five_point_derivative<double>([&](double step) {
      Eigen::Matrix<double, 24, 1> delta = Eigen::Matrix<double, 24, 1>::Zero();
      delta(j) = step;
      return wrenches<double>(effect, t, moved<double>(s, delta));
    });
  // eps^(4/5) |f^(5)|: of a wrench of size one, up to 5! / 2^-5 where 1 / (1 + x)^2 is its law.
  const double size = std::max(J.cwiseAbs().maxCoeff(), 1.0);
  EXPECT_LT((J - D).cwiseAbs().maxCoeff(), 4e3 * std::pow(effect_eps, 0.8) * size);
}

// Without velocities the wrenches are minus the gradient of the energy.
template <class E>
void expect_wrenches_are_gradient(const E& effect, TwoStates<double> s) {
  for (RigidState<double>* body : {&s.a, &s.b}) body->u = body->omega = Eigen::Vector3d::Zero();
  using Jet = ceres::Jet<double, 24>;
  const TwoStates<Jet> jets = moved<Jet>(s, jet_variables<24>());
  const Jet energy = effect.template energy<Jet>(jets.a, jets.b);
  Eigen::Matrix<double, 12, 1> expected;
  expected << -energy.v.segment<6>(0), -energy.v.segment<6>(12);
  const Eigen::Matrix<double, 12, 1> w = wrenches<double>(effect, 0.0, s);
  // Some tens of operations on numbers of the wrenches' size.
  EXPECT_LT((w - expected).cwiseAbs().maxCoeff(), 100 * effect_eps * std::max(w.norm(), 1.0));
}

// Neither a resultant force nor a moment about the origin.
template <class E>
void expect_balance(const E& effect, double t, const TwoStates<double>& s) {
  const Eigen::Matrix<double, 12, 1> w = wrenches<double>(effect, t, s);
  const double tolerance = 50 * effect_eps * std::max(w.norm(), 1.0);
  EXPECT_GT(w.norm(), 0.0);
  EXPECT_LT((w.segment<3>(0) + w.segment<3>(6)).norm(), tolerance);
  const Eigen::Vector3d on_a = s.a.x.cross(w.segment<3>(0)) + s.a.R * w.segment<3>(3);
  const Eigen::Vector3d on_b = s.b.x.cross(w.segment<3>(6)) + s.b.R * w.segment<3>(9);
  EXPECT_LT((on_a + on_b).norm(), tolerance);
}

// In extended precision the same to the round-off of double.
template <class E>
void expect_cast_agrees(const E& effect, double t, const TwoStates<double>& s) {
  using Delta = Eigen::Matrix<Extended, 24, 1>;
  const auto extended = wrenches<Extended>(effect.template cast<Extended>(), Extended(t),
                                           moved<Extended>(s, Delta::Constant(Extended(0.0))));
  const Eigen::Matrix<double, 12, 1> w = wrenches<double>(effect.template cast<double>(), t, s);
  EXPECT_LT((extended.template cast<double>() - w).cwiseAbs().maxCoeff(),
            50 * effect_eps * std::max(w.norm(), 1.0));
}

// The power of the wrenches, W.
template <class E>
double power(const E& effect, double t, const TwoStates<double>& s) {
  Eigen::Matrix<double, 12, 1> velocities;
  velocities << s.a.u, s.a.omega, s.b.u, s.b.omega;
  return velocities.dot(wrenches<double>(effect, t, s));
}

}  // namespace liebench
