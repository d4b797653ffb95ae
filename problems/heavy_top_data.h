#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "groups/decimal.h"
#include "groups/quaternion.h"
#include "problems/heavy_top_parameters.h"

namespace liebench {

// The parameters in the scalar T.
template <Scalar T>
struct HeavyTopData {
  using Vector = Eigen::Matrix<T, 3, 1>;
  using Matrix = Eigen::Matrix<T, 3, 3>;

  T mass;                 // m, kg
  Matrix inertia;         // J about the centre of mass, body frame, kg m^2
  Vector center_of_mass;  // X, body frame, m
  Vector gravity;         // gamma, inertial frame, m/s^2
  Matrix R0;              // R(0)
  Vector omega0;          // Omega(0), body frame, rad/s

  explicit HeavyTopData(const HeavyTopParameters& p)
      : mass(decimal<T>(p.mass)),
        center_of_mass(vector(p.center_of_mass)),
        gravity(vector(p.gravity)),
        omega0(vector(p.angular_velocity)) {
    for (std::size_t i = 0; i < 3; ++i) inertia.row(Eigen::Index(i)) = vector(p.inertia[i]).transpose();
    Eigen::Matrix<T, 4, 1> orientation;
    for (std::size_t i = 0; i < 4; ++i) orientation(Eigen::Index(i)) = decimal<T>(p.orientation[i]);
    R0 = rotation_matrix<T>(orientation / orientation.norm());
  }

  // m gamma, inertial frame, N.
  Vector weight() const { return gravity * mass; }

  // The direction against gravity; that of the third axis where there is none.
  Vector vertical() const {
    const T size = gravity.norm();
    if (T(0.0) < size) return -gravity / size;
    return Vector(T(0.0), T(0.0), T(1.0));
  }

  // J about the tip (Steiner), kg m^2.
  Matrix inertia_about_tip() const {
    return inertia + mass * (center_of_mass.squaredNorm() * Matrix::Identity() -
                             center_of_mass * center_of_mass.transpose());
  }

  // R^T u' of the centre of mass, u = R (Omega x X), for the motion about the tip; body frame, m/s^2.
  Vector center_acceleration(const Vector& omega, const Vector& omega_dot) const {
    return omega.cross(omega.cross(center_of_mass)) + omega_dot.cross(center_of_mass);
  }

  // diag(m I, J), of the free body.
  Eigen::Matrix<T, 6, 6> body_mass_matrix() const {
    Eigen::Matrix<T, 6, 6> M = Eigen::Matrix<T, 6, 6>::Constant(T(0.0));
    M.template topLeftCorner<3, 3>().diagonal().setConstant(mass);
    M.template bottomRightCorner<3, 3>() = inertia;
    return M;
  }
  Eigen::Matrix<T, 6, 1> body_momentum(const Eigen::Matrix<T, 6, 1>& w) const {
    Eigen::Matrix<T, 6, 1> p;
    p << mass * w.template head<3>(), inertia * w.template tail<3>();
    return p;
  }

 private:
  static Vector vector(const std::array<double, 3>& a) {
    return Vector(decimal<T>(a[0]), decimal<T>(a[1]), decimal<T>(a[2]));
  }
};

}  // namespace liebench
