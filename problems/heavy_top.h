#pragma once

#include <Eigen/Core>
#include <array>

#include "groups/decimal.h"
#include "groups/direct_product.h"
#include "groups/real_space.h"
#include "groups/so3.h"
#include "problems/heavy_top_parameters.h"
#include "problems/system.h"

// The heavy top of Bruels & Cardona 2010: a rigid body whose tip is fixed at the origin, in uniform gravity.
// Data and frames: HeavyTopParameters.

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

 private:
  static Vector vector(const std::array<double, 3>& a) {
    return Vector(decimal<T>(a[0]), decimal<T>(a[1]), decimal<T>(a[2]));
  }
};

// Eq. (57): the heavy top as rotation about its tip, unconstrained on SO(3), with J about the tip:
//   0 = J Omega' + Omega x J Omega - X x R^T m gamma
template <Scalar T>
class HeavyTopSO3 {
 public:
  using Scalar = T;
  using Group = SO3<T>;
  template <class U>
  using rebind = HeavyTopSO3<U>;
  static constexpr int constraints = 0;
  static constexpr bool constant_mass = true;

  using Vector = Eigen::Matrix<T, 3, 1>;
  using Matrix = Eigen::Matrix<T, 3, 3>;
  using NoMultipliers = Eigen::Matrix<T, 0, 1>;

  explicit HeavyTopSO3(const HeavyTopParameters& parameters)
      : parameters_(parameters),
        data_(parameters),
        inertia_(data_.inertia_about_tip()),
        weight_(data_.gravity * data_.mass) {}

  template <class U>
  HeavyTopSO3<U> cast() const {
    return HeavyTopSO3<U>(parameters_);
  }

  const Matrix& mass_matrix(const Matrix&) const { return inertia_; }
  Vector momentum(const Matrix&, const Vector& w) const { return inertia_ * w; }
  Vector force(const T&, const Matrix& R, const Vector& omega) const {
    return omega.cross(inertia_ * omega) - data_.center_of_mass.cross(R.transpose() * weight_);
  }
  Matrix damping(const T&, const Matrix&, const Vector& omega) const {
    return skew(omega) * inertia_ - skew(inertia_ * omega);
  }
  // D(R^T gamma) . (R skew(w)) = -w x R^T gamma
  Matrix stiffness(const T&, const Matrix& R, const Vector&, const Vector&, const NoMultipliers&) const {
    return -(skew(data_.center_of_mass) * skew(R.transpose() * weight_));
  }
  T energy(const Matrix& R, const Vector& omega) const {
    return omega.dot(inertia_ * omega) * 0.5 - weight_.dot(R * data_.center_of_mass);
  }

  T angular_momentum(const Matrix& R, const Vector& omega) const {
    return data_.vertical().dot(R * (inertia_ * omega));
  }

  Matrix initial_configuration() const { return data_.R0; }
  Vector initial_velocity() const { return data_.omega0; }

  // State of this formulation for the rigid motion (R, Omega) about the tip.
  static constexpr const char* formulation = "SO3";
  Matrix configuration(const Matrix& R) const { return R; }
  Vector velocity(const Matrix&, const Vector& omega) const { return omega; }
  Vector acceleration(const Matrix&, const Vector&, const Vector& omega_dot) const { return omega_dot; }
  NoMultipliers multipliers(const Matrix&, const Vector&, const Vector&) const { return {}; }

 private:
  HeavyTopParameters parameters_;
  HeavyTopData<T> data_;
  Matrix inertia_;  // about the tip
  Vector weight_;   // m gamma, inertial frame, N
};

// Eq. (58): the heavy top as a free body, q = (x, R) in R^3 x SO(3), v = (u, Omega) with u in the inertial
// frame, held at its tip by three constraints; J about the centre of mass, lambda in the body frame, N:
//   0 = m u' - m gamma - R lambda
//   0 = J Omega' + Omega x J Omega + R^T x x lambda      (R^T x = X where the constraint holds)
//   0 = X - R^T x
template <Scalar T>
class HeavyTopR3xSO3 {
 public:
  using Scalar = T;
  using Group = DirectProduct<RealSpace<T, 3>, SO3<T>>;
  template <class U>
  using rebind = HeavyTopR3xSO3<U>;
  static constexpr int constraints = 3;
  static constexpr bool constant_mass = true;

  using Vector = Eigen::Matrix<T, 3, 1>;
  using Matrix = Eigen::Matrix<T, 3, 3>;
  using Vector6 = Eigen::Matrix<T, 6, 1>;
  using Matrix6 = Eigen::Matrix<T, 6, 6>;
  using Gradient = Eigen::Matrix<T, 3, 6>;
  using Element = typename Group::Element;

  explicit HeavyTopR3xSO3(const HeavyTopParameters& parameters)
      : parameters_(parameters), data_(parameters), weight_(data_.gravity * data_.mass) {
    mass_matrix_.setZero();
    mass_matrix_.template topLeftCorner<3, 3>().diagonal().setConstant(data_.mass);
    mass_matrix_.template bottomRightCorner<3, 3>() = data_.inertia;
  }

  template <class U>
  HeavyTopR3xSO3<U> cast() const {
    return HeavyTopR3xSO3<U>(parameters_);
  }

  const Matrix6& mass_matrix(const Element&) const { return mass_matrix_; }
  Vector6 momentum(const Element&, const Vector6& w) const {
    return join(data_.mass * w.template head<3>(), data_.inertia * w.template tail<3>());
  }
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
    const Matrix& R = q.second;
    const Vector y = R.transpose() * q.first;
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
    return data_.vertical().dot(q.first.cross(momentum) + q.second * spin);
  }

  Vector constraint(const Element& q) const { return data_.center_of_mass - q.second.transpose() * q.first; }
  Gradient constraint_gradient(const Element& q) const {
    const Matrix Rt = q.second.transpose();
    Gradient B;
    B << -Rt, -skew(Rt * q.first);
    return B;
  }
  Vector6 constraint_force(const Element& q, const Vector& lambda) const {
    const Vector y = q.second.transpose() * q.first;
    return join(-(q.second * lambda), y.cross(lambda));
  }
  // D_q(B(q) v) . (q w~), 3 x 6
  Gradient constraint_gradient_derivative(const Element& q, const Vector6& v) const {
    const Matrix Rt = q.second.transpose();
    const Matrix W = skew(v.template tail<3>());
    Gradient Z;
    Z << W * Rt, W * skew(Rt * q.first) - skew(Rt * v.template head<3>());
    return Z;
  }
  Vector constraint_curvature(const Element& q, const Vector6& v) const {
    const Vector omega = v.template tail<3>();
    const Vector y = q.second.transpose() * q.first;
    const Vector w = q.second.transpose() * v.template head<3>();
    return omega.cross(w) * T(2.0) - omega.cross(omega.cross(y));
  }

  Element initial_configuration() const { return configuration(data_.R0); }
  Vector6 initial_velocity() const { return velocity(data_.R0, data_.omega0); }

  // State of this formulation for the rigid motion (R, Omega) about the tip: x = R X, u = R (Omega x X),
  // u' = R (Omega x (Omega x X) + Omega' x X), lambda = R^T m (u' - gamma).
  static constexpr const char* formulation = "R3xSO3";
  Element configuration(const Matrix& R) const { return {R * data_.center_of_mass, R}; }
  Vector6 velocity(const Matrix& R, const Vector& omega) const {
    return join(R * omega.cross(data_.center_of_mass), omega);
  }
  Vector6 acceleration(const Matrix& R, const Vector& omega, const Vector& omega_dot) const {
    return join(R * center_acceleration(omega, omega_dot), omega_dot);
  }
  Vector multipliers(const Matrix& R, const Vector& omega, const Vector& omega_dot) const {
    return data_.mass * center_acceleration(omega, omega_dot) - R.transpose() * weight_;
  }

 private:
  static Vector6 join(const Vector& first, const Vector& second) {
    Vector6 v;
    v << first, second;
    return v;
  }
  // R^T u', body frame.
  Vector center_acceleration(const Vector& omega, const Vector& omega_dot) const {
    return omega.cross(omega.cross(data_.center_of_mass)) + omega_dot.cross(data_.center_of_mass);
  }

  HeavyTopParameters parameters_;
  HeavyTopData<T> data_;
  Matrix6 mass_matrix_;
  Vector weight_;  // m gamma, inertial frame, N
};

}  // namespace liebench
