#pragma once

#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <vector>

#include "groups/extended.h"
#include "problems/heavy_top_parameters.h"

// What the witnesses of the heavy top share: the 50-digit scalar and the data in it, no method and no
// formulation.

namespace liebench {

using Wide =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>, boost::multiprecision::et_off>;
using WideVector = std::array<Wide, 3>;
using WideMatrix = std::array<WideVector, 3>;

// HeavyTopParameters, their decimals read to 50 digits.
struct HeavyTopWideData {
  WideMatrix inertia;          // J_fix: about the tip, body frame [kg m^2]
  WideMatrix inertia_inverse;  // J_fix^{-1}
  WideVector first_moment;     // m X, body frame [kg m]
  WideVector gravity;          // gamma, inertial frame [m/s^2]
  WideVector omega;            // Omega(0), body frame [rad/s]
  std::array<Wide, 4> orientation;

  // Throws std::invalid_argument when a number is not finite, the quaternion vanishes, or J_fix is not
  // symmetric and positive definite.
  explicit HeavyTopWideData(const HeavyTopParameters& parameters);

  // (m |X| |gamma| / J)^{1/2} with the smallest J that the body could turn about [rad/s]: what an angular
  // velocity is measured against when it is small or zero.
  double pendulum_frequency() const;
};

// What a witness says of one time: R (body to inertial frame) and Omega (body frame [rad/s]).
struct HeavyTopWitness {
  double t = 0;
  WideMatrix R;
  WideVector omega;
};

WideVector cross(const WideVector& a, const WideVector& b);
Wide dot(const WideVector& a, const WideVector& b);
double norm(const WideVector& v);
WideVector multiply(const WideMatrix& A, const WideVector& x);
WideMatrix multiply(const WideMatrix& A, const WideMatrix& B);
WideMatrix transposed(const WideMatrix& A);

// The rotation matrix of the unit quaternion (w, x, y, z).
WideMatrix rotation_matrix(const std::array<Wide, 4>& p);

// The nearest double-double, and back (exact).
Extended to_extended(const Wide& x);
Wide to_wide(const Extended& x);

}  // namespace liebench
