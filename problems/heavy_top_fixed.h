#pragma once

#include <Eigen/Core>

#include "groups/s3.h"
#include "groups/so3.h"
#include "problems/heavy_top_data.h"
#include "problems/system.h"

namespace liebench {

// Eq. (57): the heavy top as rotation about its tip, unconstrained on a group of rotations (SO3, S3), with J about
// the tip:
//   0 = J Omega' + Omega x J Omega - X x R^T m gamma
template <class Rotations>
class FixedHeavyTop {
 public:
  using T = typename Rotations::Scalar;
  using Scalar = T;
  using Group = Rotations;
  template <class U>
  using rebind = FixedHeavyTop<typename Rotations::template rebind<U>>;
  static constexpr int constraints = 0;
  static constexpr bool constant_mass = true;

  using Vector = Eigen::Matrix<T, 3, 1>;
  using Matrix = Eigen::Matrix<T, 3, 3>;
  using Element = typename Group::Element;
  using NoMultipliers = Eigen::Matrix<T, 0, 1>;

  explicit FixedHeavyTop(const HeavyTopParameters& parameters)
      : parameters_(parameters),
        data_(parameters),
        inertia_(data_.inertia_about_tip()),
        weight_(data_.weight()) {}

  template <class U>
  rebind<U> cast() const {
    return rebind<U>(parameters_);
  }

  const Matrix& mass_matrix(const Element&) const { return inertia_; }
  Vector momentum(const Element&, const Vector& w) const { return inertia_ * w; }
  Vector force(const T&, const Element& q, const Vector& omega) const {
    return omega.cross(inertia_ * omega) - data_.center_of_mass.cross(Group::rotate_back(q, weight_));
  }
  Matrix damping(const T&, const Element&, const Vector& omega) const {
    return skew(omega) * inertia_ - skew(inertia_ * omega);
  }
  // D(R^T gamma) . (R skew(w)) = -w x R^T gamma
  Matrix stiffness(const T&, const Element& q, const Vector&, const Vector&, const NoMultipliers&) const {
    return -(skew(data_.center_of_mass) * skew(Group::rotate_back(q, weight_)));
  }
  T energy(const Element& q, const Vector& omega) const {
    return omega.dot(inertia_ * omega) * 0.5 - weight_.dot(Group::rotate(q, data_.center_of_mass));
  }

  T angular_momentum(const Element& q, const Vector& omega) const {
    return data_.vertical().dot(Group::rotate(q, inertia_ * omega));
  }

  Element initial_configuration() const { return configuration(data_.R0); }
  Vector initial_velocity() const { return data_.omega0; }

  // State of this formulation for the rigid motion (R, Omega) about the tip.
  static constexpr const char* formulation = Group::name;
  Element configuration(const Matrix& R) const { return Group::representative(R); }
  Vector velocity(const Matrix&, const Vector& omega) const { return omega; }
  Vector acceleration(const Matrix&, const Vector&, const Vector& omega_dot) const { return omega_dot; }
  NoMultipliers multipliers(const Matrix&, const Vector&, const Vector&) const { return {}; }

 private:
  HeavyTopParameters parameters_;
  HeavyTopData<T> data_;
  Matrix inertia_;  // about the tip
  Vector weight_;   // m gamma, inertial frame, N
};

template <class T>
using HeavyTopSO3 = FixedHeavyTop<SO3<T>>;
template <class T>
using HeavyTopS3 = FixedHeavyTop<S3<T>>;

}  // namespace liebench
