#pragma once

#include <string_view>

#include "groups/decimal.h"
#include "problems/scene_bodies.h"
#include "problems/time_function.h"

namespace liebench {

enum class ForceFrame {
  inertial,
  body,  // force and torque turn with the body
};

// A force F at a point of one body and a torque on it, both times a factor c(t).
template <class T>
struct AppliedForce {
  static constexpr std::string_view name = "applied_force";
  static constexpr bool two_bodies = false, uses_pose = true, uses_velocity = false;
  Eigen::Matrix<T, 3, 1> force, torque;  // in `frame`, N, N m
  Eigen::Matrix<T, 3, 1> point;          // body frame, m
  ForceFrame frame;
  TimeFunction<T> factor;  // c

  template <class U>
  AppliedForce<U> cast() const {
    return {decimal_vector<U>(force), decimal_vector<U>(torque), decimal_vector<U>(point), frame,
            factor.template cast<U>()};
  }
  template <class U>
  void add_wrenches(const T& t, const RigidState<U>& a, const RigidState<U>&, Wrench<U>& on_a,
                    Wrench<U>&) const {
    using Vector = Eigen::Matrix<U, 3, 1>;
    const T c = factor.at(t);
    const Vector s = point.template cast<U>();
    const Vector f = (force * c).template cast<U>(), tau = (torque * c).template cast<U>();
    if (frame == ForceFrame::body)
      on_a += Wrench<U>{a.R * f, s.cross(f) + tau};
    else
      on_a += Wrench<U>{f, s.cross(a.R.transpose() * f) + a.R.transpose() * tau};
  }
};

}  // namespace liebench
