#pragma once

#include <Eigen/Core>
#include <concepts>

#include "groups/direct_product.h"
#include "groups/real_space.h"
#include "groups/s3.h"
#include "groups/so3.h"
#include "problems/heavy_top_data.h"
#include "problems/system.h"

namespace liebench {

// Eq. (58): the heavy top as a free body, q = (x, R) in R^3 x Rotations (SO3, S3), v = (u, Omega) with u in the
// inertial frame, held at its tip by three constraints; J about the centre of mass, lambda in the body frame, N:
//   0 = m u' - m gamma - R lambda
//   0 = J Omega' + Omega x J Omega + R^T x x lambda      (R^T x = X where the constraint holds)
//   0 = X - R^T x
template <class Rotations>
class FreeHeavyTop {
 public:
  using T = typename Rotations::Scalar;
  using Scalar = T;
  using Group = DirectProduct<RealSpace<T, 3>, Rotations>;
  template <class U>
  using rebind = FreeHeavyTop<typename Rotations::template rebind<U>>;
  static constexpr int constraints = 3;
  static constexpr bool constant_mass = true;
  static constexpr int mass_block = 3;

  using Vector = Eigen::Matrix<T, 3, 1>;
  using Matrix = Eigen::Matrix<T, 3, 3>;
  using Vector6 = Eigen::Matrix<T, 6, 1>;
  using Matrix6 = Eigen::Matrix<T, 6, 6>;
  using Gradient = Eigen::Matrix<T, 3, 6>;
  using Element = typename Group::Element;

  explicit FreeHeavyTop(const HeavyTopParameters& parameters)
      : parameters_(parameters),
        data_(parameters),
        mass_matrix_(data_.body_mass_matrix()),
        weight_(data_.weight()) {}

  template <class U>
  rebind<U> cast() const {
    return rebind<U>(parameters_);
  }

  const Matrix6& mass_matrix(const Element&) const { return mass_matrix_; }
  Vector6 momentum(const Element&, const Vector6& w) const { return data_.body_momentum(w); }
  Vector6 force(const T&, const Element&, const Vector6& v) const {
    const Vector omega = v.template tail<3>();
    return join(-weight_, omega.cross(data_.inertia * omega));
  }
  Matrix6 damping(const T&, const Element&, const Vector6& v) const {
    const Vector omega = v.template tail<3>();
    Matrix6 C = Matrix6::Constant(T(0.0));
    C.template bottomRightCorner<3, 3>() = skew(omega) * data_.inertia - skew(data_.inertia * omega);
    return C;
  }
  // D(B^T lambda): D(R) . w = R skew(w_R),  D(R^T x) . w = R^T w_x - w_R x R^T x
  Matrix6 stiffness(const T&, const Element& q, const Vector6&, const Vector6&, const Vector& lambda) const {
    const Matrix& R = Rotations::matrix(q.second);
    const Vector y = position_in_body(q);
    const Matrix L = skew(lambda);
    Matrix6 K;
    K.template topLeftCorner<3, 3>().setConstant(T(0.0));
    K.template topRightCorner<3, 3>() = R * L;
    K.template bottomLeftCorner<3, 3>() = -(L * R.transpose());
    K.template bottomRightCorner<3, 3>() = -(L * skew(y));
    return K;
  }
  T energy(const Element& q, const Vector6& v) const {
    return v.dot(momentum(q, v)) * 0.5 - weight_.dot(q.first);
  }

  T angular_momentum(const Element& q, const Vector6& v) const {
    const Vector momentum = data_.mass * v.template head<3>();
    const Vector spin = data_.inertia * v.template tail<3>();
    return data_.vertical().dot(q.first.cross(momentum) + Rotations::rotate(q.second, spin));
  }

  Vector constraint(const Element& q) const { return data_.center_of_mass - position_in_body(q); }
  Gradient constraint_gradient(const Element& q) const {
    const Matrix Rt = Rotations::matrix(q.second).transpose();
    Gradient B;
    B << -Rt, -skew(Rt * q.first);
    return B;
  }
  Vector6 constraint_force(const Element& q, const Vector& lambda) const {
    return join(-Rotations::rotate(q.second, lambda), position_in_body(q).cross(lambda));
  }
  // D_q(B(q) v) . (q w~), 3 x 6
  Gradient constraint_gradient_derivative(const Element& q, const Vector6& v) const {
    const Matrix Rt = Rotations::matrix(q.second).transpose();
    const Matrix W = skew(v.template tail<3>());
    Gradient Z;
    Z << W * Rt, W * skew(Rt * q.first) - skew(Rt * v.template head<3>());
    return Z;
  }
  Vector constraint_curvature(const Element& q, const Vector6& v) const {
    const Vector omega = v.template tail<3>();
    const Vector y = position_in_body(q);
    const Vector w = Rotations::rotate_back(q.second, v.template head<3>());
    return omega.cross(w) * T(2.0) - omega.cross(omega.cross(y));
  }

  Element initial_configuration() const { return configuration(data_.R0); }
  Vector6 initial_velocity() const { return velocity(data_.R0, data_.omega0); }

  // State of this formulation for the rigid motion (R, Omega) about the tip: x = R X, u = R (Omega x X),
  // u' = R (Omega x (Omega x X) + Omega' x X), lambda = R^T m (u' - gamma).
  static constexpr const char* formulation = std::same_as<Rotations, SO3<T>> ? "R3xSO3" : "R3xS3";
  Element configuration(const Matrix& R) const {
    return Group::representative({R * data_.center_of_mass, R});
  }
  Vector6 velocity(const Matrix& R, const Vector& omega) const {
    return join(R * omega.cross(data_.center_of_mass), omega);
  }
  Vector6 acceleration(const Matrix& R, const Vector& omega, const Vector& omega_dot) const {
    return join(R * data_.center_acceleration(omega, omega_dot), omega_dot);
  }
  Vector multipliers(const Matrix& R, const Vector& omega, const Vector& omega_dot) const {
    return data_.mass * data_.center_acceleration(omega, omega_dot) - R.transpose() * weight_;
  }

 private:
  static Vector6 join(const Vector& first, const Vector& second) {
    Vector6 v;
    v << first, second;
    return v;
  }
  static Vector position_in_body(const Element& q) { return Rotations::rotate_back(q.second, q.first); }

  HeavyTopParameters parameters_;
  HeavyTopData<T> data_;
  Matrix6 mass_matrix_;
  Vector weight_;  // m gamma, inertial frame, N
};

template <class T>
using HeavyTopR3xSO3 = FreeHeavyTop<SO3<T>>;
template <class T>
using HeavyTopR3xS3 = FreeHeavyTop<S3<T>>;

}  // namespace liebench
