#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string_view>
#include <type_traits>
#include <utility>

#include "groups/direct_product.h"
#include "groups/real_space.h"
#include "groups/rotation_algebra.h"
#include "groups/s3.h"
#include "groups/s3_r3.h"
#include "groups/se3.h"
#include "groups/so3.h"
#include "groups/unit_dual_quaternions.h"

// The bodies of a scene: each on a group of its own. Forces and joints see all of them alike, as positions x of the centre of
// mass and rotations R, with x' in the inertial and Omega in the body frame; what the group makes of that is written here.

namespace liebench {

enum class BodyKind {
  r3xso3,  // free body: x in R^3, R in SO(3), velocities (x', Omega)
  r3xs3,   // the same with a unit quaternion
  se3,     // free body as a rigid motion, velocities (U, Omega) with x' = R U
  s3_r3,   // the same with a unit quaternion
  udq,     // the same as a unit dual quaternion
  so3,     // body with a fixed point, velocity Omega
  s3,      // the same with a unit quaternion
  r3,      // point mass, velocity x'
};

// Calls visit(G{}) with the group of the kind.
template <class T, class Visitor>
decltype(auto) visit_group(BodyKind kind, Visitor&& visit) {
  switch (kind) {
    case BodyKind::r3xs3:
      return visit(DirectProduct<RealSpace<T, 3>, S3<T>>{});
    case BodyKind::se3:
      return visit(SE3<T>{});
    case BodyKind::s3_r3:
      return visit(S3R3<T>{});
    case BodyKind::udq:
      return visit(UnitDualQuaternions<T>{});
    case BodyKind::so3:
      return visit(SO3<T>{});
    case BodyKind::s3:
      return visit(S3<T>{});
    case BodyKind::r3:
      return visit(RealSpace<T, 3>{});
    case BodyKind::r3xso3:
      break;
  }
  return visit(DirectProduct<RealSpace<T, 3>, SO3<T>>{});
}

constexpr bool has_fixed_point(BodyKind kind) {
  return kind == BodyKind::so3 || kind == BodyKind::s3;
}
constexpr bool has_body_velocity(BodyKind kind) {
  return kind == BodyKind::se3 || kind == BodyKind::s3_r3 || kind == BodyKind::udq;
}

// What effects and joints see of a body.
template <class T>
struct RigidState {
  using Vector = Eigen::Matrix<T, 3, 1>;
  using Matrix = Eigen::Matrix<T, 3, 3>;
  Vector x;      // centre of mass, inertial frame, m
  Matrix R;      // body to inertial frame
  Vector u;      // x', inertial frame, m/s
  Vector omega;  // body frame, rad/s

  static RigidState ground() {
    return {Vector::Constant(T(0.0)), Matrix::Identity(), Vector::Constant(T(0.0)), Vector::Constant(T(0.0))};
  }
  // A point s of the body, body frame: where it is, and its velocity.
  Vector point(const Vector& s) const { return x + R * s; }
  Vector point_velocity(const Vector& s) const { return u + R * omega.cross(s); }
  // The point of the body that is at p, inertial frame.
  Vector body_point(const Vector& p) const { return R.transpose() * (p - x); }
};

// A force at the centre of mass, inertial frame, N, and a torque about it, body frame, N m.
template <class T>
struct Wrench {
  Eigen::Matrix<T, 3, 1> force, torque;

  static Wrench zero() {
    return {Eigen::Matrix<T, 3, 1>::Constant(T(0.0)), Eigen::Matrix<T, 3, 1>::Constant(T(0.0))};
  }
  // A force that acts at the point s of the body.
  static Wrench at(const RigidState<T>& body, const Eigen::Matrix<T, 3, 1>& s,
                   const Eigen::Matrix<T, 3, 1>& force) {
    return {force, s.cross(body.R.transpose() * force)};
  }
  Wrench& operator+=(const Wrench& other) {
    force += other.force;
    torque += other.torque;
    return *this;
  }
};

// One body in the scalar T; all in SI units.
template <class T>
struct Body {
  using Vector = Eigen::Matrix<T, 3, 1>;
  using Matrix = Eigen::Matrix<T, 3, 3>;
  // Up to 6 x 6, for the velocities of the body.
  using Block = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
  using State = RigidState<T>;

  BodyKind kind = BodyKind::r3xso3;
  Eigen::Index q = 0, v = 0;  // where its coordinates and velocities begin
  T mass = T(1.0);
  Matrix inertia = Matrix::Identity();            // about the centre of mass, body frame
  Matrix inertia_of_motion = Matrix::Identity();  // about the fixed point, where there is one
  Vector arm = Vector::Constant(T(0.0));          // from the fixed point to the centre of mass, body frame
  Vector fixed_point = Vector::Constant(T(0.0));  // inertial frame
  bool gyroscopic = true;                         // Omega x J Omega does not vanish and is not left out

  Eigen::Index velocities() const { return has_fixed_point(kind) || kind == BodyKind::r3 ? 3 : 6; }
  Eigen::Index coordinates() const {
    Eigen::Index rows = 0;
    visit_group<T>(kind, [&]<class G>(G) { rows = G::Stacked::RowsAtCompileTime; });
    return rows;
  }
  bool rotates() const { return kind != BodyKind::r3; }
  // Its velocities are (x', Omega).
  bool plain() const { return kind == BodyKind::r3xso3 || kind == BodyKind::r3xs3; }

  template <class Vectors>
  void read_pose(const Vectors& all, State& s) const {
    switch (kind) {
      case BodyKind::r3xso3:
      case BodyKind::se3:
        s.x = all.template segment<3>(q);
        s.R = Eigen::Map<const Matrix>(all.data() + q + 3);
        return;
      case BodyKind::r3xs3:
      case BodyKind::s3_r3:
        s.x = all.template segment<3>(q);
        s.R = rotation_matrix<T>(Quaternion<T>(all.template segment<4>(q + 3)));
        return;
      case BodyKind::udq: {
        const typename UnitDualQuaternions<T>::Element dual = all.template segment<8>(q);
        s.x = UnitDualQuaternions<T>::position(dual);
        s.R = rotation_matrix<T>(UnitDualQuaternions<T>::real(dual));
        return;
      }
      case BodyKind::so3:
        s.R = Eigen::Map<const Matrix>(all.data() + q);
        s.x = fixed_point + s.R * arm;
        return;
      case BodyKind::s3:
        s.R = rotation_matrix<T>(Quaternion<T>(all.template segment<4>(q)));
        s.x = fixed_point + s.R * arm;
        return;
      case BodyKind::r3:
        s.x = all.template segment<3>(q);
        s.R = Matrix::Identity();
        return;
    }
  }
  template <class Vectors>
  void read_velocity(const Vectors& all, State& s) const {
    if (plain()) {
      s.u = all.template segment<3>(v);
      s.omega = all.template segment<3>(v + 3);
    } else if (has_body_velocity(kind)) {
      s.u = s.R * all.template segment<3>(v);
      s.omega = all.template segment<3>(v + 3);
    } else if (has_fixed_point(kind)) {
      s.omega = all.template segment<3>(v);
      s.u = s.R * s.omega.cross(arm);
    } else {
      s.u = all.template segment<3>(v);
      s.omega = Vector::Constant(T(0.0));
    }
  }

  // Adds the generalized force of a wrench: A^T (f, tau), (x', Omega) = A v.
  template <class Vectors>
  void add(const State& s, const Wrench<T>& w, Vectors& forces) const {
    if (plain()) {
      forces.template segment<3>(v) += w.force;
      forces.template segment<3>(v + 3) += w.torque;
    } else if (has_body_velocity(kind)) {
      forces.template segment<3>(v) += s.R.transpose() * w.force;
      forces.template segment<3>(v + 3) += w.torque;
    } else if (has_fixed_point(kind)) {
      forces.template segment<3>(v) += w.torque + arm.cross(s.R.transpose() * w.force);
    } else {
      forces.template segment<3>(v) += w.force;
    }
  }

  // A, 6 x m: a change w of q moves x by the first three rows and turns R by the last three (body frame).
  Block motion(const State& s) const {
    Block A = Block::Constant(6, velocities(), T(0.0));
    if (has_fixed_point(kind)) {
      A.template topLeftCorner<3, 3>() = -(s.R * skew(arm));
      A.template bottomLeftCorner<3, 3>().setIdentity();
      return A;
    }
    if (has_body_velocity(kind))
      A.template topLeftCorner<3, 3>() = s.R;
    else
      A.template topLeftCorner<3, 3>().setIdentity();
    if (rotates()) A.template bottomRightCorner<3, 3>().setIdentity();
    return A;
  }
  // D(A v) . w, 6 x m, at fixed v.
  Block motion_derivative(const State& s) const {
    Block D = Block::Constant(6, velocities(), T(0.0));
    if (has_fixed_point(kind))
      D.template topLeftCorner<3, 3>() = -(s.R * skew(Vector(s.omega.cross(arm))));
    else if (has_body_velocity(kind))
      D.template topRightCorner<3, 3>() = -(s.R * skew(Vector(s.R.transpose() * s.u)));
    return D;
  }
  // x'' where v does not change: R (Omega x U) of body-fixed velocities.
  Vector drift(const State& s) const {
    if (has_fixed_point(kind)) return s.R * s.omega.cross(s.omega.cross(arm));
    if (has_body_velocity(kind)) return s.R * s.omega.cross(Vector(s.R.transpose() * s.u));
    return Vector::Constant(T(0.0));
  }
  // D(A^T (f, .)) . w, m x m, at a fixed wrench.
  Block force_derivative(const State& s, const Vector& force) const {
    Block D = Block::Constant(velocities(), velocities(), T(0.0));
    if (has_fixed_point(kind))
      D = skew(arm) * skew(Vector(s.R.transpose() * force));
    else if (has_body_velocity(kind))
      D.template topRightCorner<3, 3>() = skew(Vector(s.R.transpose() * force));
    return D;
  }

  // M w.
  template <class Vectors, class Result>
  void add_momentum(const Vectors& w, Result& p) const {
    if (has_fixed_point(kind)) {
      p.template segment<3>(v) = inertia_of_motion * w.template segment<3>(v);
      return;
    }
    p.template segment<3>(v) = mass * w.template segment<3>(v);
    if (rotates()) p.template segment<3>(v + 3) = inertia * w.template segment<3>(v + 3);
  }
  // Its rows of r = M w + h g + f, with the applied forces in place of g, which are overwritten.
  template <class Vectors, class Result>
  void put_equation(const T& h, const Vectors& w, const Vectors& all, const Vectors& f, Vectors& applied,
                    Result& r) const {
    if (plain()) {
      const Vector omega = all.template segment<3>(v + 3);
      Vector turning = -applied.template segment<3>(v + 3);
      if (gyroscopic) turning += omega.cross(inertia * omega);
      r.template segment<3>(v) =
          (mass * w.template segment<3>(v) + h * -applied.template segment<3>(v)) + f.template segment<3>(v);
      r.template segment<3>(v + 3) =
          (inertia * w.template segment<3>(v + 3) + h * turning) + f.template segment<3>(v + 3);
      return;
    }
    const Eigen::Index end = v + velocities();
    for (Eigen::Index i = v; i < end; ++i) applied(i) = -applied(i);
    if (has_inertial_forces()) add_inertial(all, applied);
    add_momentum(w, r);
    for (Eigen::Index i = v; i < end; ++i) r(i) = (r(i) + h * applied(i)) + f(i);
  }
  Block mass_matrix() const {
    Block M = Block::Constant(velocities(), velocities(), T(0.0));
    if (has_fixed_point(kind)) {
      M = inertia_of_motion;
      return M;
    }
    M.template topLeftCorner<3, 3>().diagonal().setConstant(mass);
    if (rotates()) M.template bottomRightCorner<3, 3>() = inertia;
    return M;
  }
  // The inertial forces that are quadratic in v: Omega x J Omega, and m Omega x U of body-fixed velocities.
  template <class Vectors>
  void add_inertial(const Vectors& all, Vectors& g) const {
    if (has_fixed_point(kind)) {
      const Vector omega = all.template segment<3>(v);
      if (gyroscopic) g.template segment<3>(v) += omega.cross(inertia_of_motion * omega);
      return;
    }
    if (!rotates()) return;
    const Vector omega = all.template segment<3>(v + 3);
    if (has_body_velocity(kind)) g.template segment<3>(v) += omega.cross(all.template segment<3>(v) * mass);
    if (gyroscopic) g.template segment<3>(v + 3) += omega.cross(inertia * omega);
  }
  // D_Omega of Omega x J Omega.
  template <class Vectors>
  Matrix gyroscopic_damping(const Vectors& all) const {
    const Vector omega = all.template segment<3>(has_fixed_point(kind) ? v : v + 3);
    const Matrix& J = has_fixed_point(kind) ? inertia_of_motion : inertia;
    return skew(omega) * J - skew(Vector(J * omega));
  }
  // Their derivative with respect to v.
  template <class Vectors>
  Block inertial_damping(const Vectors& all) const {
    Block C = Block::Constant(velocities(), velocities(), T(0.0));
    if (!rotates()) return C;
    if (gyroscopic) C.template bottomRightCorner<3, 3>() = gyroscopic_damping(all);
    if (has_body_velocity(kind)) {
      const Vector omega = all.template segment<3>(v + 3);
      C.template topLeftCorner<3, 3>() = skew(Vector(omega * mass));
      C.template topRightCorner<3, 3>() = -skew(Vector(all.template segment<3>(v) * mass));
    }
    return C;
  }
  // Neither vanishes nor is left out: the Newton matrix has this block.
  bool has_inertial_forces() const { return rotates() && (gyroscopic || has_body_velocity(kind)); }
};

}  // namespace liebench
