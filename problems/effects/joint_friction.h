#pragma once

#include <string_view>

#include "groups/decimal.h"
#include "problems/effects/smooth_sign.h"
#include "problems/scene_bodies.h"

// Coulomb friction of a constant size in joints, regularised.

namespace liebench {

// In a revolute joint: torque -T_c tanh(w / w_s) about its axis n, of a, on b, the opposite on a, w = n . (omega_b - omega_a) the
// relative angular velocity about it.
template <class T>
struct RevoluteFriction {
  static constexpr std::string_view name = "revolute_friction";
  static constexpr bool two_bodies = true, uses_pose = true, uses_velocity = true;
  Eigen::Matrix<T, 3, 1> axis_a;  // n, frame of a; of any length
  T torque, slip_rate;            // T_c, N m; w_s > 0, rad/s

  template <class U>
  RevoluteFriction<U> cast() const {
    return {decimal_vector<U>(axis_a), decimal<U>(torque), decimal<U>(slip_rate)};
  }
  template <class U>
  void add_wrenches(const T&, const RigidState<U>& a, const RigidState<U>& b, Wrench<U>& on_a,
                    Wrench<U>& on_b) const {
    using Vector = Eigen::Matrix<U, 3, 1>;
    const Vector axis = (axis_a / axis_a.norm()).template cast<U>(), n = a.R * axis;
    const U rate = n.dot(b.R * b.omega) - axis.dot(a.omega);
    const U size = U(torque) * smooth_sign<U>(rate / U(slip_rate));
    on_a.torque += axis * size;
    on_b.torque -= b.R.transpose() * n * size;
  }
};

// In a prismatic joint: force -F_c tanh(v / v_s) along its axis n, of a, on b at a point p_b of it, the opposite on a at the same
// place, v the velocity of p_b along n as a sees it.
template <class T>
struct PrismaticFriction {
  static constexpr std::string_view name = "prismatic_friction";
  static constexpr bool two_bodies = true, uses_pose = true, uses_velocity = true;
  Eigen::Matrix<T, 3, 1> axis_a;   // n, frame of a; of any length
  Eigen::Matrix<T, 3, 1> point_b;  // frame of b, m
  T force, slip_velocity;          // F_c, N; v_s > 0, m/s

  template <class U>
  PrismaticFriction<U> cast() const {
    return {decimal_vector<U>(axis_a), decimal_vector<U>(point_b), decimal<U>(force),
            decimal<U>(slip_velocity)};
  }
  template <class U>
  void add_wrenches(const T&, const RigidState<U>& a, const RigidState<U>& b, Wrench<U>& on_a,
                    Wrench<U>& on_b) const {
    using Vector = Eigen::Matrix<U, 3, 1>;
    const Vector n = a.R * (axis_a / axis_a.norm()).template cast<U>();
    const Vector s_b = point_b.template cast<U>(), s_a = a.body_point(b.point(s_b));
    const U velocity = n.dot(b.point_velocity(s_b) - a.point_velocity(s_a));
    const Vector friction = n * (U(force) * smooth_sign<U>(velocity / U(slip_velocity)));
    on_a += Wrench<U>::at(a, s_a, friction);
    on_b += Wrench<U>::at(b, s_b, -friction);
  }
};

}  // namespace liebench
