#pragma once

#include <Eigen/Core>

#include "groups/decimal.h"
#include "groups/rotation_algebra.h"
#include "groups/so3.h"
#include "problems/system.h"

// The attitude of a small satellite with a permanent magnet in a uniform field, without damping: R turns body-frame coordinates
// into those of the field,
//
//   0 = J Omega' + Omega x J Omega - m x R^T B
//
// Kept are the energy and the angular momentum along B. SI units.
template <liebench::Scalar T>
class MagneticSatellite {
 public:
  using Scalar = T;
  using Group = liebench::SO3<T>;
  template <class U>
  using rebind = MagneticSatellite<U>;
  static constexpr int constraints = 0;
  static constexpr bool constant_mass = true;

  using Vector = Eigen::Matrix<T, 3, 1>;
  using Matrix = Eigen::Matrix<T, 3, 3>;
  using NoMultipliers = Eigen::Matrix<T, 0, 1>;

  // It has no data but constants.
  template <class U>
  MagneticSatellite<U> cast() const {
    return {};
  }

  const Matrix& mass_matrix(const Matrix&) const { return inertia_; }
  Vector momentum(const Matrix&, const Vector& w) const { return inertia_ * w; }
  Vector force(const T&, const Matrix& R, const Vector& omega) const {
    return omega.cross(inertia_ * omega) - moment_.cross(R.transpose() * field_);
  }
  Matrix damping(const T&, const Matrix&, const Vector& omega) const {
    return liebench::skew(omega) * inertia_ - liebench::skew(inertia_ * omega);
  }
  // D(R^T B) . (R w~) = -w x R^T B
  Matrix stiffness(const T&, const Matrix& R, const Vector&, const Vector&, const NoMultipliers&) const {
    return -(liebench::skew(moment_) * liebench::skew(Vector(R.transpose() * field_)));
  }
  T energy(const Matrix& R, const Vector& omega) const {
    return T(0.5) * omega.dot(inertia_ * omega) - field_.dot(R * moment_);
  }
  T angular_momentum(const Matrix& R, const Vector& omega) const {
    return field_.normalized().dot(R * (inertia_ * omega));
  }
  Matrix initial_configuration() const { return Matrix::Identity(); }
  Vector initial_velocity() const { return vector(0.3, -0.2, 0.1); }  // rad/s

 private:
  static Vector vector(double x, double y, double z) {
    return liebench::decimal_vector<T>(Eigen::Vector3d(x, y, z));
  }
  Matrix inertia_ = vector(0.042, 0.035, 0.011).asDiagonal();  // of a cubesat of 4 kg, 30 cm high, kg m^2
  Vector moment_ = vector(0.5, 0.0, 0.3);                      // body frame, A m^2
  Vector field_ = vector(0.0, 1e-5, 3e-5);                     // of the earth, T
};
