#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "groups/so3.h"
#include "problems/heavy_top.h"
#include "problems/heavy_top_parameters.h"

// Heavy tops and states for tests: what holds for the default top alone (a diagonal inertia, X on an axis,
// gravity on another) is no law.

namespace liebench {

// Numbers in [-1, 1), the same in every run and on every platform.
class RandomNumbers {
 public:
  explicit RandomNumbers(unsigned seed) : engine_(seed) {}
  double operator()() { return double(engine_()) / 2147483648.0 - 1.0; }
  template <int n>
  Eigen::Matrix<double, n, 1> vector() {
    Eigen::Matrix<double, n, 1> v;
    for (int i = 0; i < n; ++i) v(i) = (*this)();
    return v;
  }

 private:
  std::mt19937 engine_;
};

// A top without any symmetry: full inertia matrix, X and gravity in general position.
inline HeavyTopParameters unsymmetric_top(unsigned seed) {
  RandomNumbers random(seed);
  HeavyTopParameters p;
  p.mass = 3 + random();
  // J = A A^T + 1/2 I, exactly symmetric.
  Eigen::Matrix3d A;
  for (int i = 0; i < 3; ++i) A.row(i) = 0.4 * random.vector<3>().transpose();
  const Eigen::Matrix3d J = A * A.transpose() + 0.5 * Eigen::Matrix3d::Identity();
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      p.inertia[i][j] = J(Eigen::Index(i < j ? i : j), Eigen::Index(i < j ? j : i));
  for (std::size_t i = 0; i < 3; ++i) {
    p.center_of_mass[i] = random();
    p.gravity[i] = 9 * random();
    p.angular_velocity[i] = 3 * random();
  }
  for (double& x : p.orientation) x = random();
  return p;
}

// The default top and two unsymmetric ones.
inline std::vector<HeavyTopParameters> sample_tops() {
  return {HeavyTopParameters{}, unsymmetric_top(1), unsymmetric_top(2)};
}

// The top turning slowly: with |Omega| of a few rad/s a step of 1/100 s resolves it, and all terms
// (gyroscopic, gravity, commutators) matter alike.
inline HeavyTopParameters slow_top() {
  HeavyTopParameters p;
  p.angular_velocity = {1.2, 4.0, -0.8};
  p.orientation = {0.9, 0.3, -0.2, 0.1};
  return p;
}

// A rigid motion: attitude, angular velocity and its rate, body frame.
struct TopState {
  Eigen::Matrix3d R;
  Eigen::Vector3d omega, omega_dot;
};

inline std::vector<TopState> sample_states() {
  std::vector<TopState> all;
  RandomNumbers random(77);
  for (const double speed : {0.0, 1.0, 150.0}) {
    const Eigen::Matrix3d R = SO3<double>::exp(3 * random.vector<3>());
    all.push_back({R, speed * random.vector<3>(), (1 + speed) * random.vector<3>()});
  }
  return all;
}

}  // namespace liebench
