#pragma once

#include <optional>
#include <string_view>

#include "groups/decimal.h"
#include "problems/effects/joint_angle.h"
#include "problems/effects/smooth_sign.h"
#include "problems/prescribed_motion.h"

namespace liebench {

// A motor in a revolute joint that follows a target angle c(t): torque about the axis on b, the opposite on a,
//
//   tau = -k_p (phi - c) - k_d (phi' - c'),  phi - c to within (-pi, pi]
//
// with a torque limit L instead L tanh(tau / L).
template <class T>
struct Motor {
  static constexpr std::string_view name = "motor";
  static constexpr bool two_bodies = true, uses_pose = true, uses_velocity = true;
  JointAngle<T> angle;
  PrescribedMotion<T> target;     // c, rad
  T proportional, derivative;     // k_p, k_d, N m/rad, N m s/rad
  std::optional<T> torque_limit;  // L > 0, N m

  template <class U>
  Motor<U> cast() const {
    Motor<U> motor{angle.template cast<U>(),
                   target.template cast<U>(),
                   decimal<U>(proportional),
                   decimal<U>(derivative),
                   {}};
    if (torque_limit) motor.torque_limit = decimal<U>(*torque_limit);
    return motor;
  }
  template <class U>
  void add_wrenches(const T& t, const RigidState<U>& a, const RigidState<U>& b, Wrench<U>& on_a,
                    Wrench<U>& on_b) const {
    const auto phi = angle.template at<U>(a, b);
    const auto c = target.at(t);
    U torque = -U(proportional) * phi.difference(c[0]) - U(derivative) * (phi.rate() - U(c[1]));
    if (torque_limit) torque = U(*torque_limit) * smooth_sign<U>(torque / U(*torque_limit));
    phi.add_torques(torque, on_a, on_b);
  }
};

}  // namespace liebench
