#pragma once

#include <string_view>

#include "groups/decimal.h"
#include "groups/jet.h"
#include "groups/so3.h"
#include "problems/scene_bodies.h"

namespace liebench {

// A bushing: springs and dampers in all six directions between a frame of a and a frame of b. With the points p_a, p_b and the
// orientations C_a = R_a A, C_b = R_b B of the frames,
//
//   s = C_a^T (p_b - p_a),  theta = log(C_a^T C_b)         |theta| < pi, where the torque jumps
//   force on b at p_b       -C_a (k s + c s')              on a the opposite, at the same place
//   torque on b             -C_b T(theta)^{-T} K theta - C_a D w,  w = C_a^T (omega_b - omega_a)
//   U                       (s . k s + theta . K theta) / 2
//
// with diagonal k, c, K, D, the omega in the inertial frame and T the tangent operator of SO(3): theta' = T^{-1} C_b^T C_a w.
template <class T>
struct Bushing {
  static constexpr std::string_view name = "bushing";
  static constexpr bool two_bodies = true, uses_pose = true, uses_velocity = true;
  using Vector = Eigen::Matrix<T, 3, 1>;
  using Matrix = Eigen::Matrix<T, 3, 3>;
  Vector point_a;                             // body frame, m
  Matrix frame_a;                             // A, to the frame of a
  Vector point_b;                             // body frame, m
  Matrix frame_b;                             // B, to the frame of b
  Vector stiffness, damping;                  // k and c along the axes of the frame of a, N/m, N s/m
  Vector angular_stiffness, angular_damping;  // K and D about the same, N m/rad, N m s/rad

  // The frames are orthogonal to the precision of U.
  template <class U>
  Bushing<U> cast() const {
    return {decimal_vector<U>(point_a),           SO3<U>::renormalized(decimal_matrix<U>(frame_a)),
            decimal_vector<U>(point_b),           SO3<U>::renormalized(decimal_matrix<U>(frame_b)),
            decimal_vector<U>(stiffness),         decimal_vector<U>(damping),
            decimal_vector<U>(angular_stiffness), decimal_vector<U>(angular_damping)};
  }
  template <class U>
  void add_wrenches(const T&, const RigidState<U>& a, const RigidState<U>& b, Wrench<U>& on_a,
                    Wrench<U>& on_b) const {
    using VectorU = Eigen::Matrix<U, 3, 1>;
    const Relative<U> r(*this, a, b);
    const VectorU s_a = a.body_point(r.p_b), s_b = point_b.template cast<U>();
    const VectorU s_rate = r.C_a.transpose() * (b.point_velocity(s_b) - a.point_velocity(s_a));
    const VectorU force = r.C_a * VectorU(-scaled<U>(stiffness, r.s) - scaled<U>(damping, s_rate));
    on_a += Wrench<U>::at(a, s_a, -force);
    on_b += Wrench<U>::at(b, s_b, force);

    const VectorU w = r.C_a.transpose() * (b.R * b.omega - a.R * a.omega);
    const VectorU elastic =
        SO3<U>::tangent_inverse(r.theta).transpose() * scaled<U>(angular_stiffness, r.theta);
    const VectorU torque = -(r.C_b * elastic) - r.C_a * scaled<U>(angular_damping, w);
    on_a.torque -= a.R.transpose() * torque;
    on_b.torque += b.R.transpose() * torque;
  }
  template <class U>
  U energy(const RigidState<U>& a, const RigidState<U>& b) const {
    const Relative<U> r(*this, a, b);
    return U(T(0.5)) *
           (r.s.dot(scaled<U>(stiffness, r.s)) + r.theta.dot(scaled<U>(angular_stiffness, r.theta)));
  }

 private:
  template <class U>
  struct Relative {
    Relative(const Bushing& bushing, const RigidState<U>& a, const RigidState<U>& b)
        : C_a(a.R * bushing.frame_a.template cast<U>()),
          C_b(b.R * bushing.frame_b.template cast<U>()),
          p_b(b.point(bushing.point_b.template cast<U>())),
          s(C_a.transpose() * (p_b - a.point(bushing.point_a.template cast<U>()))),
          theta(SO3<U>::log(C_a.transpose() * C_b)) {}
    Eigen::Matrix<U, 3, 3> C_a, C_b;
    Eigen::Matrix<U, 3, 1> p_b, s, theta;
  };
  template <class U>
  static Eigen::Matrix<U, 3, 1> scaled(const Vector& diagonal, const Eigen::Matrix<U, 3, 1>& v) {
    return diagonal.template cast<U>().cwiseProduct(v);
  }
};

}  // namespace liebench
