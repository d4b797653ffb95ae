#pragma once

#include <string_view>

#include "groups/decimal.h"
#include "problems/scene_bodies.h"

namespace liebench {

// The weight of one body, f = m gamma, its factors as the data gives them. An effect on one body or two is written for states of any scalar U made from its own T:
//
//   name, two_bodies       what the scene calls it; whether it acts between two bodies, the second of which may be the ground
//   uses_pose, uses_velocity    whether its wrenches depend on them in (x, R, x', Omega)
//   add_wrenches(t, a, b, on_a, on_b)    what it applies to the bodies
//   energy(a, b)           its potential, J; absent where it has none
//   cast<U>()              the effect in the scalar U
template <class T>
struct UniformGravity {
  static constexpr std::string_view name = "uniform_gravity";
  static constexpr bool two_bodies = false, uses_pose = false, uses_velocity = false;
  T mass;                                          // kg
  Eigen::Matrix<T, 3, 1> gravity;                  // gamma, inertial frame, m/s^2
  Eigen::Matrix<T, 3, 1> weight = gravity * mass;  // N

  template <class U>
  UniformGravity<U> cast() const {
    return {decimal<U>(mass), decimal_vector<U>(gravity)};
  }
  template <class U>
  void add_wrenches(const T&, const RigidState<U>&, const RigidState<U>&, Wrench<U>& on_a, Wrench<U>&) const {
    on_a.force += weight.template cast<U>();
  }
  template <class U>
  U energy(const RigidState<U>& a, const RigidState<U>&) const {
    return -weight.template cast<U>().dot(a.x);
  }
};

}  // namespace liebench
