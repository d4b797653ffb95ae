#pragma once

#include <Eigen/Core>

#include "groups/rotation_algebra.h"
#include "groups/s3_r3.h"
#include "groups/se3.h"
#include "groups/unit_dual_quaternions.h"
#include "problems/heavy_top_data.h"
#include "problems/system.h"

namespace liebench {

// The heavy top as a free body on a group of rigid motions (SE3, S3R3, UnitDualQuaternions): v = (U, Omega) with both
// velocities in the body frame, x' = R U; held at its tip by three constraints. J about the centre of mass, lambda
// in the body frame, N, with y = R^T x:
//   0 = m U' + m Omega x U - R^T m gamma - lambda
//   0 = J Omega' + Omega x J Omega + y x lambda      (y = X where the constraint holds)
//   0 = X - y
// A change w of q changes y by D y . w = w_U + y x w_Omega and R^T a by R^T a x w_Omega.
template <class Motions>
class MovingHeavyTop {
 public:
  using T = typename Motions::Scalar;
  using Scalar = T;
  using Group = Motions;
  template <class U>
  using rebind = MovingHeavyTop<typename Motions::template rebind<U>>;
  static constexpr int constraints = 3;
  static constexpr bool constant_mass = true;
  static constexpr int mass_block = 3;

  using Vector = Eigen::Matrix<T, 3, 1>;
  using Matrix = Eigen::Matrix<T, 3, 3>;
  using Vector6 = Eigen::Matrix<T, 6, 1>;
  using Matrix6 = Eigen::Matrix<T, 6, 6>;
  using Gradient = Eigen::Matrix<T, 3, 6>;
  using Element = typename Group::Element;

  explicit MovingHeavyTop(const HeavyTopParameters& parameters)
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
  Vector6 force(const T&, const Element& q, const Vector6& v) const {
    const Vector U = v.template head<3>(), omega = v.template tail<3>();
    return join(omega.cross(U * data_.mass) - Group::rotate_back(q, weight_),
                omega.cross(data_.inertia * omega));
  }
  Matrix6 damping(const T&, const Element&, const Vector6& v) const {
    const Vector U = v.template head<3>(), omega = v.template tail<3>();
    Matrix6 C;
    C.template topLeftCorner<3, 3>() = skew(omega * data_.mass);
    C.template topRightCorner<3, 3>() = -skew(U * data_.mass);
    C.template bottomLeftCorner<3, 3>().setConstant(T(0.0));
    C.template bottomRightCorner<3, 3>() = skew(omega) * data_.inertia - skew(data_.inertia * omega);
    return C;
  }
  Matrix6 stiffness(const T&, const Element& q, const Vector6&, const Vector6&, const Vector& lambda) const {
    const Matrix L = skew(lambda);
    Matrix6 K;
    K.template topLeftCorner<3, 3>().setConstant(T(0.0));
    K.template topRightCorner<3, 3>() = -skew(Group::rotate_back(q, weight_));
    K.template bottomLeftCorner<3, 3>() = -L;
    K.template bottomRightCorner<3, 3>() = -(L * skew(Group::position_in_body(q)));
    return K;
  }
  T energy(const Element& q, const Vector6& v) const {
    return v.dot(momentum(q, v)) * 0.5 - weight_.dot(Group::position(q));
  }

  T angular_momentum(const Element& q, const Vector6& v) const {
    const Vector momentum = data_.mass * v.template head<3>();
    const Vector spin = data_.inertia * v.template tail<3>();
    return data_.vertical().dot(Group::rotate(q, Group::position_in_body(q).cross(momentum) + spin));
  }

  Vector constraint(const Element& q) const { return data_.center_of_mass - Group::position_in_body(q); }
  Gradient constraint_gradient(const Element& q) const {
    Gradient B;
    B << -Matrix::Identity(), -skew(Group::position_in_body(q));
    return B;
  }
  Vector6 constraint_force(const Element& q, const Vector& lambda) const {
    return join(-lambda, Group::position_in_body(q).cross(lambda));
  }
  // D_q(B(q) v) . (q w~) = Omega x D y . w, 3 x 6
  Gradient constraint_gradient_derivative(const Element& q, const Vector6& v) const {
    const Matrix W = skew(v.template tail<3>());
    Gradient Z;
    Z << W, W * skew(Group::position_in_body(q));
    return Z;
  }
  Vector constraint_curvature(const Element& q, const Vector6& v) const {
    const Vector U = v.template head<3>(), omega = v.template tail<3>();
    return omega.cross(U + Group::position_in_body(q).cross(omega));
  }

  Element initial_configuration() const { return configuration(data_.R0); }
  Vector6 initial_velocity() const { return velocity(data_.R0, data_.omega0); }

  // State of this formulation for the rigid motion (R, Omega) about the tip: x = R X, U = Omega x X,
  // U' = Omega' x X, lambda = m (U' + Omega x U) - R^T m gamma.
  static constexpr const char* formulation = Group::name;
  Element configuration(const Matrix& R) const {
    return Group::representative({R * data_.center_of_mass, R});
  }
  Vector6 velocity(const Matrix&, const Vector& omega) const {
    return join(omega.cross(data_.center_of_mass), omega);
  }
  Vector6 acceleration(const Matrix&, const Vector&, const Vector& omega_dot) const {
    return join(omega_dot.cross(data_.center_of_mass), omega_dot);
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

  HeavyTopParameters parameters_;
  HeavyTopData<T> data_;
  Matrix6 mass_matrix_;
  Vector weight_;  // m gamma, inertial frame, N
};

template <class T>
using HeavyTopSE3 = MovingHeavyTop<SE3<T>>;
template <class T>
using HeavyTopS3R3 = MovingHeavyTop<S3R3<T>>;
template <class T>
using HeavyTopUDQ = MovingHeavyTop<UnitDualQuaternions<T>>;

}  // namespace liebench
