#pragma once

#include <Eigen/Core>
#include <cmath>

#include "groups/lie_group.h"
#include "groups/quaternion.h"
#include "groups/rotation_algebra.h"
#include "groups/so3.h"

namespace liebench {

// Rotations in space as unit quaternions p: p' = 1/2 p (0, omega) with omega the angular velocity in the body
// frame. p and -p are one rotation; log takes the one with p0 >= 0. [Hairer, Lubich & Wanner 2006, VII.5]
template <Scalar T>
struct S3 : RotationAlgebra<T> {
  using Scalar = T;
  using Element = Quaternion<T>;
  using typename RotationAlgebra<T>::Tangent;
  using Stacked = Eigen::Matrix<T, 4, 1>;
  template <class U>
  using rebind = S3<U>;
  using Represented = SO3<T>;
  static constexpr int dimension = 3;
  static constexpr bool commutative = false;
  static constexpr const char* name = "S3";

  static Element identity() { return {T(1.0), T(0.0), T(0.0), T(0.0)}; }
  static Element compose(const Element& a, const Element& b) { return quaternion_product<T>(a, b); }
  static Element inverse(const Element& p) { return quaternion_conjugate<T>(p); }

  // (cos(x/2), sin(x/2) / x v), x = |v|
  static Element exp(const Tangent& v) {
    const auto [cosine, sine] = half_angle<T>(v.squaredNorm());
    return quaternion_of<T>(cosine, v * sine);
  }
  static Tangent log(const Element& p) { return quaternion_log<T>(p); }

  static typename SO3<T>::Element represented(const Element& p) { return rotation_matrix<T>(p); }
  static Element representative(const typename SO3<T>::Element& R) { return SO3<T>::quaternion(R); }

  // As in SO3.
  static typename SO3<T>::Element matrix(const Element& p) { return rotation_matrix<T>(p); }
  static Tangent rotate(const Element& p, const Tangent& w) { return quaternion_rotate<T>(p, w); }
  static Tangent rotate_back(const Element& p, const Tangent& w) { return quaternion_rotate_back<T>(p, w); }

  static Stacked stacked(const Element& p) { return p; }
  static Element unstacked(const Stacked& s) { return s; }
  template <class U>
  static typename S3<U>::Element cast(const Element& p) {
    return p.template cast<U>();
  }

  // From p - q, or p + q where -p is next to q, so that nothing cancels: conj(q) (p - q) = exp(v~) - 1, whose
  // imaginary part is sin(|v|/2) / |v| v.
  static Eigen::Vector3d separation(const Element& q, const Element& p) {
    const Quaternion<double> from = q.template cast<double>(), to = p.template cast<double>();
    const bool flip = from.dot(to) < 0.0;
    const Quaternion<double> difference = (flip ? Element(-p - q) : Element(p - q)).template cast<double>();
    const Quaternion<double> back = quaternion_conjugate<double>(from);
    if (!(difference.norm() < 0.1)) return quaternion_log<double>(quaternion_product<double>(back, to));
    const Eigen::Vector3d half = imaginary<double>(quaternion_product<double>(back, difference));
    const double sine = half.norm();
    return sine == 0.0 ? Eigen::Vector3d(2.0 * half) : Eigen::Vector3d(half * (2.0 * std::asin(sine) / sine));
  }

  // | |p|^2 - 1 |
  static T defect(const Element& p) {
    const T excess = p.squaredNorm() - T(1.0);
    return excess < 0.0 ? T(-excess) : excess;
  }

  // p (3 - |p|^2) / 2, the first Newton step towards p / |p|: the defect is squared.
  static Element renormalized(const Element& p) { return p * ((T(3.0) - p.squaredNorm()) * T(0.5)); }
};

}  // namespace liebench
