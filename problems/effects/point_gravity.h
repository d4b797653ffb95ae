#pragma once

#include <cmath>
#include <string_view>

#include "groups/decimal.h"
#include "problems/scene_bodies.h"

namespace liebench {

// The attraction of a body by a fixed centre, to the second order in its size: with d from the centre to the centre of mass,
// r = |d|, rho = R^T d and the inertia J about the centre of mass,
//
//   U = -GM m / r - (GM / 2) (tr J / r^3 - 3 rho . J rho / r^5)
//   f = -GM m d / r^3 + (3 GM / (2 r^5)) ((5 rho . J rho / r^2 - tr J) d - 2 R J rho)
//   tau = (3 GM / r^5) rho x J rho                             [Hughes 1986, Spacecraft Attitude Dynamics, 8.1]
//
// f and tau are the gradient of U. A point mass has J = 0.
template <class T>
struct PointGravity {
  static constexpr std::string_view name = "point_gravity";
  static constexpr bool two_bodies = false, uses_pose = true, uses_velocity = false;
  T gravitational_parameter;       // GM, m^3/s^2
  Eigen::Matrix<T, 3, 1> centre;   // inertial frame, m
  T mass;                          // of the body, kg
  Eigen::Matrix<T, 3, 3> inertia;  // of the body, about its centre of mass, body frame, kg m^2

  template <class U>
  PointGravity<U> cast() const {
    return {decimal<U>(gravitational_parameter), decimal_vector<U>(centre), decimal<U>(mass),
            decimal_matrix<U>(inertia)};
  }
  template <class U>
  void add_wrenches(const T&, const RigidState<U>& a, const RigidState<U>&, Wrench<U>& on_a,
                    Wrench<U>&) const {
    using std::sqrt;
    const Arm<U> arm(*this, a);
    const U GM(gravitational_parameter);
    const U r3 = arm.r2 * sqrt(arm.r2);
    const U factor = U(3.0) * GM / (r3 * arm.r2);
    const U along =
        factor * U(0.5) * (U(5.0) * arm.quadratic / arm.r2 - U(inertia.trace())) - GM * U(mass) / r3;
    on_a.force += arm.d * along - a.R * (arm.J_rho * factor);
    on_a.torque += arm.rho.cross(arm.J_rho) * factor;
  }
  template <class U>
  U energy(const RigidState<U>& a, const RigidState<U>&) const {
    using std::sqrt;
    const Arm<U> arm(*this, a);
    const U second = U(0.5) * (U(inertia.trace()) - U(3.0) * arm.quadratic / arm.r2) / arm.r2;
    return -U(gravitational_parameter) * (U(mass) + second) / sqrt(arm.r2);
  }

 private:
  template <class U>
  struct Arm {
    using Vector = Eigen::Matrix<U, 3, 1>;
    Arm(const PointGravity& g, const RigidState<U>& a)
        : d(a.x - g.centre.template cast<U>()),
          rho(a.R.transpose() * d),
          J_rho(g.inertia.template cast<U>() * rho),
          r2(d.squaredNorm()),
          quadratic(rho.dot(J_rho)) {}
    Vector d, rho, J_rho;
    U r2, quadratic;
  };
};

}  // namespace liebench
