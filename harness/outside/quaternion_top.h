#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>

#include "harness/outside/scaled_rotation.h"
#include "problems/heavy_top.h"

namespace liebench::outside {

// The heavy top about its tip, eq. (57), as an ordinary differential equation of y = (p, Omega) in R^7, p the
// quaternion (w, x, y, z):
//
//   p' = p (0, Omega) / 2,   J Omega' = J Omega x Omega + X x R(p)^T m gamma
//
// J about the tip. |p| stays what it is, and has no effect (scaled_rotation.h).
class QuaternionTop {
 public:
  template <class T>
  using System = HeavyTopS3<T>;
  using Data = HeavyTopParameters;
  static constexpr int size = 7;
  using Vector = Eigen::Matrix<double, size, 1>;
  using Matrix = Eigen::Matrix<double, size, size>;

  explicit QuaternionTop(const HeavyTopParameters& parameters) {
    const HeavyTopData<double> data(parameters);
    inertia_ = data.inertia_about_tip();
    inverse_ = inertia_.inverse();
    center_of_mass_ = data.center_of_mass;
    weight_ = data.weight();
    const HeavyTopS3<double> system(parameters);
    initial_ << system.initial_configuration(), system.initial_velocity();
  }

  const Vector& initial() const { return initial_; }
  // Where quaternions begin in y.
  static constexpr std::array<Eigen::Index, 1> quaternions() { return {0}; }

  static Configuration<System<double>> configuration(const Vector& y) { return y.head<4>().normalized(); }
  static Velocity<System<double>> velocity(const Vector& y) { return y.tail<3>(); }
  static Multipliers<System<double>> multipliers(const Vector&) { return {}; }

  void derivative(double, Eigen::Ref<const Vector> y, Eigen::Ref<Vector> f) const {
    const Vector4 p = y.head<4>();
    const Vector3 omega = y.tail<3>();
    f.head<4>() = quaternion_rate(p, omega);
    const Vector3 momentum = inertia_ * omega;
    f.tail<3>() = inverse_ * (momentum.cross(omega) + center_of_mass_.cross(turn_back(p, weight_)));
  }

  // df/dy
  void jacobian(double, Eigen::Ref<const Vector> y, Eigen::Ref<Matrix> J) const {
    const Vector4 p = y.head<4>();
    const Vector3 omega = y.tail<3>();
    J.topLeftCorner<4, 4>() = 0.5 * imaginary_factor(omega);
    J.topRightCorner<4, 3>() = 0.5 * times_imaginary(p);
    J.bottomLeftCorner<3, 4>() =
        inverse_ * (skew(center_of_mass_) * turn_back_derivative(p, weight_, turn_back(p, weight_)));
    J.bottomRightCorner<3, 3>() = inverse_ * (skew(Vector3(inertia_ * omega)) - skew(omega) * inertia_);
  }

 private:
  Matrix3 inertia_, inverse_;
  Vector3 center_of_mass_, weight_;
  Vector initial_;
};

}  // namespace liebench::outside
