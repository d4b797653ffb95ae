#pragma once

#include <Eigen/Core>

#include "groups/so3.h"
#include "integrators/starting_values.h"
#include "problems/system.h"

namespace liebench {

// A sphere under a constant torque along its axis of rotation: Omega = (0, 0, 2 + 0.5 t) [rad/s], the attitude turns by
// 2 t + t^2 / 4 about the third axis. J = I.
template <Scalar T>
class SpinningUp {
 public:
  using Scalar = T;
  using Group = SO3<T>;
  template <class U>
  using rebind = SpinningUp<U>;
  static constexpr int constraints = 0;
  static constexpr bool constant_mass = true;
  static constexpr double acceleration = 0.5;  // rad/s^2
  using Vector = Eigen::Matrix<T, 3, 1>;
  using Matrix = Eigen::Matrix<T, 3, 3>;
  using NoMultipliers = Eigen::Matrix<T, 0, 1>;

  template <class U>
  SpinningUp<U> cast() const {
    return {};
  }

  Matrix mass_matrix(const Matrix&) const { return Matrix::Identity(); }
  Vector momentum(const Matrix&, const Vector& w) const { return w; }
  Vector force(const T&, const Matrix&, const Vector&) const { return along_axis(T(-acceleration)); }
  Matrix damping(const T&, const Matrix&, const Vector&) const { return Matrix::Constant(T(0.0)); }
  Matrix stiffness(const T&, const Matrix&, const Vector&, const Vector&, const NoMultipliers&) const {
    return Matrix::Constant(T(0.0));
  }
  T energy(const Matrix&, const Vector& omega) const { return omega.dot(omega) * T(0.5); }
  T angular_momentum(const Matrix&, const Vector& omega) const { return omega(2); }
  Matrix initial_configuration() const { return Matrix::Identity(); }
  Vector initial_velocity() const { return along_axis(T(2.0)); }

  static Vector along_axis(const T& x) { return Vector(T(0.0), T(0.0), x); }
};

// Its motion.
inline SolutionPoint<SpinningUp<double>> spinning_up_point(double t) {
  using S = SpinningUp<double>;
  return {t,
          S::Group::exp(S::along_axis((2.0 + 0.5 * S::acceleration * t) * t)),
          S::along_axis(2.0 + S::acceleration * t),
          S::along_axis(S::acceleration),
          {}};
}

}  // namespace liebench
