#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "groups/decimal.h"

namespace liebench {

// A rigid body in a uniform gravity field, one of whose points (the tip) is held at the origin of the
// inertial frame.
//
//   R' = R Omega^,    J_fix Omega' = (J_fix Omega) x Omega + m X x (R^T gamma)
//
// R turns body-frame coordinates into inertial ones, Omega is the angular velocity in the body frame, and
// J_fix the inertia about the tip (inertia_about_tip). The default is the fast heavy top of Wieloch & Arnold,
// after Bruels & Cardona (2010) and Geradin & Cardona (2001). SI units.
//
// Each double means its shortest decimal: read it with decimal<T>() of groups/decimal.h.
struct HeavyTopParameters {
  using Vector = std::array<double, 3>;
  using Matrix = std::array<Vector, 3>;

  double mass = 15;  // [kg]
  // About the centre of mass, body frame [kg m^2].
  Matrix inertia{{{0.234375, 0, 0}, {0, 0.46875, 0}, {0, 0, 0.234375}}};
  Vector center_of_mass{0, 1, 0};             // X: from the tip, body frame [m]
  Vector gravity{0, 0, -9.81};                // gamma: inertial frame [m/s^2]
  Vector angular_velocity{0, 150, -4.61538};  // Omega(0): body frame [rad/s]
  // R(0) as a quaternion (w, x, y, z) of any positive length; normalised on use.
  std::array<double, 4> orientation{1, 0, 0, 0};

  bool operator==(const HeavyTopParameters&) const = default;
};

template <class T, std::size_t N>
std::array<T, N> decimal(const std::array<double, N>& v) {
  std::array<T, N> result;
  for (std::size_t i = 0; i < N; ++i) result[i] = decimal<T>(v[i]);
  return result;
}

// J_fix = J_cm + m (|X|^2 I - X X^T): inertia about the tip, body frame [kg m^2], in the arithmetic of T.
template <class T>
std::array<std::array<T, 3>, 3> inertia_about_tip(const HeavyTopParameters& parameters) {
  const T mass = decimal<T>(parameters.mass);
  const std::array<T, 3> X = decimal<T>(parameters.center_of_mass);
  std::array<std::array<T, 3>, 3> J;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      J[i][j] = decimal<T>(parameters.inertia[i][j]) - mass * X[i] * X[j];
      if (i == j) J[i][j] += mass * (X[0] * X[0] + X[1] * X[1] + X[2] * X[2]);
    }
  }
  return J;
}

// The unit quaternion (w, x, y, z) of R(0), in the arithmetic of T.
template <class T>
std::array<T, 4> initial_orientation(const HeavyTopParameters& parameters) {
  using std::sqrt;
  std::array<T, 4> p = decimal<T>(parameters.orientation);
  const T length = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3]);
  for (T& x : p) x /= length;
  return p;
}

}  // namespace liebench
