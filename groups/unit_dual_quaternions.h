#pragma once

#include <Eigen/Core>
#include <cmath>

#include "groups/quaternion.h"
#include "groups/rigid_motion_algebra.h"

namespace liebench {

// Rigid motions as unit dual quaternions p + eps d, eps^2 = 0: the rotation p, |p| = 1, and d = 1/2 (0, x) p with
// the position x, so that p . d = 0. Stored as (p, d), 8 numbers; (p, d) and (-p, -d) are one motion.
// What holds for unit quaternions holds here for dual numbers, and the dual part is a derivative. [Study 1903]
template <Scalar T>
struct UnitDualQuaternions : RigidMotionAlgebra<T> {
  using Scalar = T;
  using Algebra = RigidMotionAlgebra<T>;
  using Element = Eigen::Matrix<T, 8, 1>;
  using typename Algebra::Represented;
  using typename Algebra::Tangent;
  using typename Algebra::Vector;
  using Stacked = Eigen::Matrix<T, 8, 1>;
  template <class U>
  using rebind = UnitDualQuaternions<U>;
  static constexpr const char* name = "UDQ";

  static Quaternion<T> real(const Element& q) { return q.template head<4>(); }
  static Quaternion<T> dual(const Element& q) { return q.template tail<4>(); }

  static Element identity() {
    Element q = Element::Constant(T(0.0));
    q(0) = T(1.0);
    return q;
  }
  static Element compose(const Element& a, const Element& b) {
    return element(quaternion_product<T>(real(a), real(b)),
                   quaternion_product<T>(real(a), dual(b)) + quaternion_product<T>(dual(a), real(b)));
  }
  static Element inverse(const Element& q) {
    return element(quaternion_conjugate<T>(real(q)), quaternion_conjugate<T>(dual(q)));
  }

  // p = (cos(x/2), s Omega), s = sin(x/2) / x, x = |Omega|, and its derivative along U: with h = -(1/x) ds/dx
  //   d = (-1/2 s (Omega . U), s U - h (Omega . U) Omega)
  static Element exp(const Tangent& v) {
    const Vector U = Algebra::shift(v), omega = Algebra::turn(v);
    const T x_squared = omega.squaredNorm(), rate = omega.dot(U);
    const auto [cosine, sine] = half_angle<T>(x_squared);
    const T turning = half_sine_slope<T>(x_squared) * rate;
    return element(quaternion_of<T>(cosine, omega * sine),
                   quaternion_of<T>(T(sine * rate * -0.5), U * sine - omega * turning));
  }
  // Changing the sign of both parts changes neither the position nor the rotation vector.
  static Tangent log(const Element& q) {
    const Vector omega = quaternion_log<T>(real(q));
    return Algebra::join(Algebra::log_position(position(q), omega), omega);
  }

  static typename Represented::Element represented(const Element& q) {
    return {position(q), rotation_matrix<T>(real(q))};
  }
  static Element representative(const typename Represented::Element& r) {
    const Quaternion<T> p = SO3<T>::quaternion(r.second);
    return element(p, quaternion_product<T>(quaternion_of<T>(T(0.0), r.first), p) * T(0.5));
  }

  // As in RigidMotions: x = 2 d conj(p), R^T x = 2 conj(p) d.
  static Vector position(const Element& q) {
    return imaginary<T>(quaternion_product<T>(dual(q), quaternion_conjugate<T>(real(q)))) * T(2.0);
  }
  static Vector position_in_body(const Element& q) {
    return imaginary<T>(quaternion_product<T>(quaternion_conjugate<T>(real(q)), dual(q))) * T(2.0);
  }
  static Vector rotate(const Element& q, const Vector& w) { return quaternion_rotate<T>(real(q), w); }
  static Vector rotate_back(const Element& q, const Vector& w) {
    return quaternion_rotate_back<T>(real(q), w);
  }

  static Stacked stacked(const Element& q) { return q; }
  static Element unstacked(const Stacked& s) { return s; }
  template <class U>
  static typename UnitDualQuaternions<U>::Element cast(const Element& q) {
    return q.template cast<U>();
  }

  // From p - q, or p + q where -p is next to q, as in S3: with conj(q) (p - q) = w + eps z the motion is
  // (1 + w) + eps z, its position 2 z conj(1 + w).
  static Eigen::Matrix<double, 6, 1> separation(const Element& q, const Element& p) {
    using Doubles = UnitDualQuaternions<double>;
    const bool flip = q.template head<4>().dot(p.template head<4>()) < 0.0;
    const Element difference = flip ? Element(-p - q) : Element(p - q);
    // In T: a position far from the origin multiplies the error of this product.
    const typename Doubles::Element apart = cast<double>(compose(inverse(q), difference));
    Quaternion<double> turn = Doubles::real(apart);
    const bool near = turn.norm() < 0.1;
    Eigen::Vector3d omega = 2.0 * imaginary<double>(turn);
    const double sine = 0.5 * omega.norm();
    turn(0) += 1.0;
    if (!near) {
      omega = quaternion_log<double>(turn);
    } else if (sine > 0.0) {
      omega *= std::asin(sine) / sine;
    }
    const Eigen::Vector3d x = Doubles::position(Doubles::element(turn, Doubles::dual(apart)));
    return Doubles::join(Doubles::log_position(x, omega), omega);
  }

  // The larger of | |p|^2 - 1 | and |2 p . d|, the real and the dual part of q conj(q) - 1.
  static T defect(const Element& q) {
    const T real_part = q.template head<4>().squaredNorm() - T(1.0);
    const T dual_part = q.template head<4>().dot(q.template tail<4>()) * 2.0;
    const T a = real_part < 0.0 ? T(-real_part) : real_part, b = dual_part < 0.0 ? T(-dual_part) : dual_part;
    return a < b ? b : a;
  }

  // p k with k = (3 - |p|^2) / 2, and d k less its part along p k: both parts of the defect are of second order
  // then. (The Newton step for q conj(q) = 1 in dual numbers is d k - (p . d) p.)
  static Element renormalized(const Element& q) {
    const T square = q.template head<4>().squaredNorm();
    const T k = (T(3.0) - square) * T(0.5);
    const T along = q.template head<4>().dot(q.template tail<4>()) * (T(2.0) - square) * k;
    return element(real(q) * k, dual(q) * k - real(q) * along);
  }

  // For other scalars' motions.
  using Algebra::join;
  using Algebra::log_position;
  static Element element(const Quaternion<T>& p, const Quaternion<T>& d) {
    Element q;
    q << p, d;
    return q;
  }
};

}  // namespace liebench
