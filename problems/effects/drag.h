#pragma once

#include <cmath>
#include <string_view>

#include "groups/decimal.h"
#include "problems/scene_bodies.h"

namespace liebench {

// The drag of a medium at rest on one body, linear and quadratic, about its centre of mass:
//
//   f = -(c_1 + c_2 |x'|) x',  tau = -(d_1 + d_2 |Omega|) Omega
template <class T>
struct Drag {
  static constexpr std::string_view name = "drag";
  static constexpr bool two_bodies = false, uses_pose = false, uses_velocity = true;
  T linear, quadratic;                  // c_1, c_2, N s/m, N s^2/m^2
  T angular_linear, angular_quadratic;  // d_1, d_2, N m s/rad, N m s^2/rad^2

  template <class U>
  Drag<U> cast() const {
    return {decimal<U>(linear), decimal<U>(quadratic), decimal<U>(angular_linear),
            decimal<U>(angular_quadratic)};
  }
  template <class U>
  void add_wrenches(const T&, const RigidState<U>& a, const RigidState<U>&, Wrench<U>& on_a,
                    Wrench<U>&) const {
    on_a.force -= a.u * (U(linear) + U(quadratic) * length<U>(a.u));
    on_a.torque -= a.omega * (U(angular_linear) + U(angular_quadratic) * length<U>(a.omega));
  }

 private:
  // |v|; at v = 0 a constant, so that |v| v has its derivative, zero, by Jets.
  template <class U>
  static U length(const Eigen::Matrix<U, 3, 1>& v) {
    using std::sqrt;
    const U square = v.squaredNorm();
    return U(T(0.0)) < square ? U(sqrt(square)) : U(T(0.0));
  }
};

}  // namespace liebench
