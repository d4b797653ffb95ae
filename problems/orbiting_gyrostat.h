#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string_view>

#include "groups/decimal.h"
#include "groups/quaternion.h"
#include "groups/rotation_algebra.h"
#include "groups/so3.h"
#include "problems/parameter.h"
#include "problems/system.h"

namespace liebench {

struct OrbitingGyrostatParameters {
  std::array<double, 3> inertia{4, 11, 13};
  double orbital_rate = 0.0011;
  std::array<double, 3> wheel_momentum{0, 0.002, 0.01};
  std::array<double, 4> orientation{0.9, 0.3, -0.2, 0.2};
  std::array<double, 3> angular_velocity{0.0008, -0.001, 0.0015};
};

// The attitude of a satellite with a momentum wheel on a circular orbit [Hughes, Spacecraft Attitude Dynamics, 1986, chapters 9 and
// 11]. R turns coordinates of the body's principal axes into those of the orbit's frame (x away from the earth, z along the orbit's
// normal), which turns with the rate n about z; Omega is the body's angular velocity relative to that frame, in body coordinates:
//
//   0 = J (Omega + n c)' + (Omega + n c) x (J (Omega + n c) + s) - 3 n^2 e x J e,    e = R^T e_x,  c = R^T e_z,  c' = c x Omega
//
// with s the momentum of the wheel, whose speed is held. Kept is the energy relative to the turning frame.
template <class T>
class OrbitingGyrostat {
 public:
  static constexpr std::string_view name = "orbiting_gyrostat";
  static constexpr std::string_view summary =
      "satellite with a momentum wheel on a circular orbit, under the gravity gradient (Hughes 1986)";
  static constexpr std::string_view formulation = "SO3";
  static constexpr std::array velocity_names{"omega_x", "omega_y", "omega_z"};
  using Parameters = OrbitingGyrostatParameters;
  static constexpr std::array parameter_list{
      parameter<&Parameters::inertia>(
          {"inertia", "kg m^2", {1e-6, 1e6}, "J, principal moments, wheel included"}),
      parameter<&Parameters::orbital_rate>({"orbital_rate", "rad/s", {0, 1}, "n"}),
      parameter<&Parameters::wheel_momentum>({"wheel_momentum", "kg m^2/s", {}, "s, body frame"}),
      parameter<&Parameters::orientation>(
          {"orientation", "", {}, "R(t_0), body to orbit frame: quaternion w, x, y, z of any length"}),
      parameter<&Parameters::angular_velocity>(
          {"angular_velocity", "rad/s", {}, "Omega(t_0), relative to the orbit frame, body frame"})};
  static std::optional<ParameterRefusal> refusal(const Parameters& p) {
    for (std::size_t i = 0; i < 3; ++i)
      if (p.inertia[i] > p.inertia[(i + 1) % 3] + p.inertia[(i + 2) % 3])
        return ParameterRefusal{"inertia", "moments none of which exceeds the sum of the others"};
    if (p.orientation == std::array<double, 4>{})
      return ParameterRefusal{"orientation", "4 numbers that are not all zero"};
    return std::nullopt;
  }

  using Scalar = T;
  using Group = SO3<T>;
  template <class U>
  using rebind = OrbitingGyrostat<U>;
  static constexpr int constraints = 0;
  static constexpr bool constant_mass = true;
  using Vector = Eigen::Matrix<T, 3, 1>;
  using Matrix = Eigen::Matrix<T, 3, 3>;
  using NoMultipliers = Eigen::Matrix<T, 0, 1>;

  explicit OrbitingGyrostat(const Parameters& parameters)
      : parameters_(parameters),
        J_(vector(parameters.inertia)),
        s_(vector(parameters.wheel_momentum)),
        n_(decimal<T>(parameters.orbital_rate)) {}
  template <class U>
  OrbitingGyrostat<U> cast() const {
    return OrbitingGyrostat<U>(parameters_);
  }

  Matrix mass_matrix(const Matrix&) const { return J_.asDiagonal(); }
  Vector momentum(const Matrix&, const Vector& w) const { return J_.cwiseProduct(w); }
  Vector force(const T&, const Matrix& R, const Vector& omega) const {
    const Vector e = radial(R), nc = n_ * normal(R), total = omega + nc;
    return J_.cwiseProduct(nc.cross(omega)) + total.cross(J_.cwiseProduct(total) + s_) -
           T(3.0) * n_ * n_ * e.cross(J_.cwiseProduct(e));
  }
  Matrix damping(const T&, const Matrix& R, const Vector& omega) const {
    const Vector nc = n_ * normal(R);
    return J_.asDiagonal() * skew(nc) + gyroscopic(omega + nc);
  }
  // D(e) . (R w~) = e x w, and that of c likewise
  Matrix stiffness(const T&, const Matrix& R, const Vector& omega, const Vector&,
                   const NoMultipliers&) const {
    const Vector e = radial(R), nc = n_ * normal(R);
    const Matrix gradient = skew(e) * J_.asDiagonal() - skew(J_.cwiseProduct(e));
    return (gyroscopic(omega + nc) - J_.asDiagonal() * skew(omega)) * skew(nc) -
           T(3.0) * n_ * n_ * gradient * skew(e);
  }
  T energy(const Matrix& R, const Vector& omega) const {
    const Vector e = radial(R), nc = n_ * normal(R);
    return T(0.5) * (omega.dot(J_.cwiseProduct(omega)) - nc.dot(J_.cwiseProduct(nc))) - nc.dot(s_) +
           T(1.5) * n_ * n_ * e.dot(J_.cwiseProduct(e));
  }
  // None is kept: the force is symmetric about no axis.
  T angular_momentum(const Matrix&, const Vector&) const { return T(0.0); }
  Matrix initial_configuration() const {
    Eigen::Matrix<T, 4, 1> p;
    for (std::size_t i = 0; i < 4; ++i) p(Eigen::Index(i)) = decimal<T>(parameters_.orientation[i]);
    return rotation_matrix<T>(p / p.norm());
  }
  Vector initial_velocity() const { return vector(parameters_.angular_velocity); }

 private:
  static Vector vector(const std::array<double, 3>& a) {
    return {decimal<T>(a[0]), decimal<T>(a[1]), decimal<T>(a[2])};
  }
  static Vector radial(const Matrix& R) { return R.row(0).transpose(); }
  static Vector normal(const Matrix& R) { return R.row(2).transpose(); }
  // w -> D(Omega x (J Omega + s)) . w
  Matrix gyroscopic(const Vector& omega) const {
    return skew(omega) * J_.asDiagonal() - skew(J_.cwiseProduct(omega) + s_);
  }

  Parameters parameters_;
  Vector J_, s_;
  T n_;
};

}  // namespace liebench
