#pragma once

#include <cmath>
#include <string_view>

#include "groups/decimal.h"
#include "problems/scene_bodies.h"

namespace liebench {

enum class ContactLaw {
  linear,  // e = 1
  hertz,   // e = 3/2
};

// A sphere of one body against a plane of the ground, by penalty: with the centre p of the sphere, its radius r, the plane through
// p_0 with the unit normal n, and the penetration delta = r - n . (p - p_0), while delta > 0
//
//   normal force    f_n = max(0, k delta^e + c delta') along n
//   friction        -mu f_n s / sqrt(|s|^2 + v_s^2),  s the velocity in the plane of the body's point at p - r n
//   U               k delta^(e+1) / (e + 1)
//
// on the body's point at p - r n.
template <class T>
struct Contact {
  static constexpr std::string_view name = "contact";
  static constexpr bool two_bodies = false, uses_pose = true, uses_velocity = true;
  Eigen::Matrix<T, 3, 1> point;        // the centre of the sphere, body frame, m
  T radius;                            // r, m
  Eigen::Matrix<T, 3, 1> plane_point;  // p_0, inertial frame, m
  Eigen::Matrix<T, 3, 1> normal;       // n, inertial frame, out of the ground; of any length
  ContactLaw law;
  T stiffness, damping;       // k, N/m^e; c, N s/m
  T friction, slip_velocity;  // mu; v_s > 0, m/s

  template <class U>
  Contact<U> cast() const {
    return {decimal_vector<U>(point),
            decimal<U>(radius),
            decimal_vector<U>(plane_point),
            decimal_vector<U>(normal),
            law,
            decimal<U>(stiffness),
            decimal<U>(damping),
            decimal<U>(friction),
            decimal<U>(slip_velocity)};
  }
  template <class U>
  void add_wrenches(const T&, const RigidState<U>& a, const RigidState<U>&, Wrench<U>& on_a,
                    Wrench<U>&) const {
    using std::sqrt;
    using Vector = Eigen::Matrix<U, 3, 1>;
    const U delta = penetration(a);
    if (!(U(T(0.0)) < delta)) return;
    const Vector n = unit_normal().template cast<U>();
    const Vector s = point.template cast<U>() - a.R.transpose() * n * U(radius);
    // n . (omega x r n) = 0: the velocity along n is that of the centre.
    const Vector velocity = a.point_velocity(s);
    const U approach = -n.dot(velocity);
    const U size = U(stiffness) * power(delta) + U(damping) * approach;
    if (!(U(T(0.0)) < size)) return;
    const Vector slip = velocity + n * approach;
    const U regular = sqrt(slip.squaredNorm() + U(slip_velocity * slip_velocity));
    on_a += Wrench<U>::at(a, s, (n - slip * (U(friction) / regular)) * size);
  }
  template <class U>
  U energy(const RigidState<U>& a, const RigidState<U>&) const {
    const U delta = penetration(a);
    if (!(U(T(0.0)) < delta)) return U(T(0.0));
    return U(stiffness / T(law == ContactLaw::hertz ? 2.5 : 2.0)) * delta * power(delta);
  }

 private:
  Eigen::Matrix<T, 3, 1> unit_normal() const { return normal / normal.norm(); }
  template <class U>
  U penetration(const RigidState<U>& a) const {
    const Eigen::Matrix<U, 3, 1> p = a.point(point.template cast<U>());
    return U(radius) - unit_normal().template cast<U>().dot(p - plane_point.template cast<U>());
  }
  // delta^e
  template <class U>
  U power(const U& delta) const {
    using std::sqrt;
    return law == ContactLaw::hertz ? U(delta * sqrt(delta)) : delta;
  }
};

}  // namespace liebench
