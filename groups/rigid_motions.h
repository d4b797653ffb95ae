#pragma once

#include <Eigen/Core>
#include <utility>

#include "groups/rigid_motion_algebra.h"

namespace liebench {

// Rigid motions q = (x, r): the position x in space and a rotation r of the group Rotations (SO3 or S3), composed as
// (x1 + R1 x2, r1 r2). What SE3 and S3R3 share.
template <class Rotations>
struct RigidMotions : RigidMotionAlgebra<typename Rotations::Scalar> {
  using Scalar = typename Rotations::Scalar;
  using Algebra = RigidMotionAlgebra<Scalar>;
  using typename Algebra::Represented;
  using typename Algebra::Tangent;
  using typename Algebra::Vector;
  using Element = std::pair<Vector, typename Rotations::Element>;
  using Stacked = Eigen::Matrix<Scalar, 3 + int(Rotations::Stacked::RowsAtCompileTime), 1>;

  static Element identity() { return {Vector::Constant(Scalar(0.0)), Rotations::identity()}; }
  static Element compose(const Element& a, const Element& b) {
    return {a.first + Rotations::rotate(a.second, b.first), Rotations::compose(a.second, b.second)};
  }
  static Element inverse(const Element& q) {
    return {-Rotations::rotate_back(q.second, q.first), Rotations::inverse(q.second)};
  }
  static Element exp(const Tangent& v) {
    const Vector omega = Algebra::turn(v);
    return {Algebra::exp_position(Algebra::shift(v), omega), Rotations::exp(omega)};
  }
  static Tangent log(const Element& q) {
    const Vector omega = Rotations::log(q.second);
    return Algebra::join(Algebra::log_position(q.first, omega), omega);
  }

  static typename Represented::Element represented(const Element& q) {
    return {q.first, Rotations::represented(q.second)};
  }
  static Element representative(const typename Represented::Element& r) {
    return {r.first, Rotations::representative(r.second)};
  }

  // Common to the representations of rigid motions: x, R^T x, R w and R^T w.
  static Vector position(const Element& q) { return q.first; }
  static Vector position_in_body(const Element& q) { return Rotations::rotate_back(q.second, q.first); }
  static Vector rotate(const Element& q, const Vector& w) { return Rotations::rotate(q.second, w); }
  static Vector rotate_back(const Element& q, const Vector& w) { return Rotations::rotate_back(q.second, w); }

  static Stacked stacked(const Element& q) {
    Stacked s;
    s << q.first, Rotations::stacked(q.second);
    return s;
  }
  static Element unstacked(const Stacked& s) {
    return {s.template head<3>(), Rotations::unstacked(s.template tail<Stacked::RowsAtCompileTime - 3>())};
  }
  template <class U>
  static auto cast(const Element& q) {
    return std::pair(q.first.template cast<U>().eval(), Rotations::template cast<U>(q.second));
  }

  // The translation from x_p - x_q, so that nothing cancels.
  static Eigen::Matrix<double, 6, 1> separation(const Element& q, const Element& p) {
    using Doubles = typename Rotations::template rebind<double>;
    using Motions = RigidMotions<Doubles>;
    const Eigen::Vector3d omega = Rotations::separation(q.second, p.second);
    const Eigen::Vector3d difference = (p.first - q.first).eval().template cast<double>();
    const Eigen::Vector3d in_body =
        Doubles::rotate_back(Rotations::template cast<double>(q.second), difference);
    return Motions::join(Motions::log_position(in_body, omega), omega);
  }
  static Scalar defect(const Element& q) { return Rotations::defect(q.second); }
  static Element renormalized(const Element& q) { return {q.first, Rotations::renormalized(q.second)}; }

  // Of another scalar's motions.
  using Algebra::join;
  using Algebra::log_position;
};

}  // namespace liebench
