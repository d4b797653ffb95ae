#pragma once

#include <string_view>

#include "groups/decimal.h"
#include "problems/effects/joint_angle.h"

namespace liebench {

// A spring and a damper on the angle phi of a revolute joint: torque -(k (phi - phi_0) + c phi') about its axis on b, the opposite
// on a. phi is that within (-pi, pi]: the torque jumps where a turn is complete, at phi = pi.
template <class T>
struct TorsionalSpring {
  static constexpr std::string_view name = "torsional_spring";
  static constexpr bool two_bodies = true, uses_pose = true, uses_velocity = true;
  JointAngle<T> angle;
  T stiffness, damping, rest_angle;  // N m/rad, N m s/rad, rad

  template <class U>
  TorsionalSpring<U> cast() const {
    return {angle.template cast<U>(), decimal<U>(stiffness), decimal<U>(damping), decimal<U>(rest_angle)};
  }
  template <class U>
  void add_wrenches(const T&, const RigidState<U>& a, const RigidState<U>& b, Wrench<U>& on_a,
                    Wrench<U>& on_b) const {
    const auto phi = angle.template at<U>(a, b);
    const U torque = -U(stiffness) * (phi.value() - U(rest_angle)) - U(damping) * phi.rate();
    phi.add_torques(torque, on_a, on_b);
  }
  template <class U>
  U energy(const RigidState<U>& a, const RigidState<U>& b) const {
    const U twist = angle.template at<U>(a, b).value() - U(rest_angle);
    return U(T(0.5) * stiffness) * twist * twist;
  }
};

}  // namespace liebench
