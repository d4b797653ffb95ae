#pragma once

#include "benchmarks/floors/rotation.h"
#include "problems/heavy_top_parameters.h"

// The heavy top by hand: the numbers of the fast top, with what is special to it - diagonal inertia, centre of mass on
// the second axis, gravity against the third.

namespace liebench::floors::top {

inline constexpr HeavyTopParameters data{};
inline constexpr double mass = data.mass;
inline constexpr double arm = data.center_of_mass[1];
inline constexpr double weight = data.mass * data.gravity[2];  // third component
// Moments of inertia about the centre of mass, and about the tip.
inline constexpr double J1 = data.inertia[0][0], J2 = data.inertia[1][1], J3 = data.inertia[2][2];
inline constexpr double tip1 = J1 + mass * arm * arm, tip2 = J2, tip3 = J3 + mass * arm * arm;

// J h dv'/dd + h C dv/dd of the rotation about the centre of mass; C = skew(w) J - skew(J w)
template <class Closure, class Vector>
Mat3 rotational_inertia(double h, const Vec3& w, const Closure& closure, const Vector& change) {
  const Mat3 C{0.0, (J3 - J2) * w.z, (J3 - J2) * w.y, (J1 - J3) * w.z,
               0.0, (J1 - J3) * w.x, (J2 - J1) * w.y, (J2 - J1) * w.x,
               0.0};
  return diagonal(J1, J2, J3) * closure.acceleration_derivative(h, change) +
         (h * C) * closure.velocity_derivative(h, change);
}

}  // namespace liebench::floors::top
