#pragma once

#include <cmath>
#include <string_view>

#include "groups/decimal.h"
#include "problems/scene_bodies.h"

namespace liebench {

// A spring and a damper between a point of a and one of b: force k (L - L_0) + c L' along the line that joins them, positive in
// tension. The points may not meet.
template <class T>
struct SpringDamper {
  static constexpr std::string_view name = "spring_damper";
  static constexpr bool two_bodies = true, uses_pose = true, uses_velocity = true;
  Eigen::Matrix<T, 3, 1> point_a, point_b;  // body frames, m
  T stiffness, damping, rest_length;        // N/m, N s/m, m

  template <class U>
  SpringDamper<U> cast() const {
    return {decimal_vector<U>(point_a), decimal_vector<U>(point_b), decimal<U>(stiffness),
            decimal<U>(damping), decimal<U>(rest_length)};
  }
  template <class U>
  void add_wrenches(const T&, const RigidState<U>& a, const RigidState<U>& b, Wrench<U>& on_a,
                    Wrench<U>& on_b) const {
    using Vector = Eigen::Matrix<U, 3, 1>;
    const Vector s_a = point_a.template cast<U>(), s_b = point_b.template cast<U>();
    const Vector apart = b.point(s_b) - a.point(s_a);
    const U length = apart.norm();
    const U rate = apart.dot(b.point_velocity(s_b) - a.point_velocity(s_a)) / length;
    const U tension = U(stiffness) * (length - U(rest_length)) + U(damping) * rate;
    const Vector force = apart * (tension / length);
    const Wrench<U> first = Wrench<U>::at(a, s_a, force), second = Wrench<U>::at(b, s_b, -force);
    on_a.force += first.force;
    on_a.torque += first.torque;
    on_b.force += second.force;
    on_b.torque += second.torque;
  }
  template <class U>
  U energy(const RigidState<U>& a, const RigidState<U>& b) const {
    const U stretch =
        (b.point(point_b.template cast<U>()) - a.point(point_a.template cast<U>())).norm() - U(rest_length);
    return U(T(0.5) * stiffness) * stretch * stretch;
  }
};

}  // namespace liebench
