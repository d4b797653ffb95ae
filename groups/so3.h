#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "groups/lie_group.h"
#include "groups/quaternion.h"
#include "groups/rotation_algebra.h"

namespace liebench {

// Rotations in space as matrices R (3 x 3, R^T R = I, det R = 1), R' = R skew(omega) with omega the angular
// velocity in the body frame. [Hairer, Lubich & Wanner 2006, IV.7]
template <Scalar T>
struct SO3 : RotationAlgebra<T> {
  using Scalar = T;
  using Element = Eigen::Matrix<T, 3, 3>;
  using typename RotationAlgebra<T>::Tangent;
  using Stacked = Eigen::Matrix<T, 9, 1>;
  template <class U>
  using rebind = SO3<U>;
  using Represented = SO3;
  static constexpr int dimension = 3;
  static constexpr bool commutative = false;
  static constexpr const char* name = "SO3";

  static Element identity() { return Element::Identity(); }
  static Element compose(const Element& a, const Element& b) { return a * b; }
  static Element inverse(const Element& q) { return q.transpose(); }

  // I + s skew(v) + b skew(v)^2
  static Element exp(const Tangent& v) {
    const auto [s, b] = sinc_versine<T>(v.squaredNorm());
    return skew_polynomial<T>(v, s, b);
  }

  // By the unit quaternion: accurate to a few eps for every angle up to and at pi. (acos of the trace loses
  // half of the digits near 0 and near pi.)
  static Tangent log(const Element& R) { return quaternion_log<T>(quaternion(R)); }

  static Element represented(const Element& R) { return R; }
  static Element representative(const Element& R) { return R; }

  // Common to the representations of rotations: the rotation matrix R, R w and R^T w.
  static const Element& matrix(const Element& R) { return R; }
  static Tangent rotate(const Element& R, const Tangent& w) { return R * w; }
  static Tangent rotate_back(const Element& R, const Tangent& w) { return R.transpose() * w; }

  static Stacked stacked(const Element& R) { return Eigen::Map<const Stacked>(R.data()); }
  static Element unstacked(const Stacked& s) { return Eigen::Map<const Element>(s.data()); }
  template <class U>
  static typename SO3<U>::Element cast(const Element& R) {
    return R.template cast<U>();
  }

  // From p - q, so that nothing cancels: q^T (p - q) = exp(v~) - I, whose skew part is sin|v| / |v| v.
  static Eigen::Vector3d separation(const Element& q, const Element& p) {
    const Eigen::Matrix3d from = q.template cast<double>();
    const Eigen::Matrix3d difference = (p - q).eval().template cast<double>();
    const Eigen::Matrix3d E = from.transpose() * difference;
    if (!(difference.norm() < 0.1)) return SO3<double>::log(from.transpose() * p.template cast<double>());
    const Eigen::Vector3d skew_part(0.5 * (E(2, 1) - E(1, 2)), 0.5 * (E(0, 2) - E(2, 0)),
                                    0.5 * (E(1, 0) - E(0, 1)));
    const double sine = skew_part.norm();
    return sine == 0.0 ? skew_part : skew_part * (std::asin(sine) / sine);
  }

  // ||R^T R - I||_F
  static T defect(const Element& R) { return (R.transpose() * R - Element::Identity()).norm(); }

  // R (3 I - R^T R) / 2, the first Newton step towards the polar factor: the defect is squared.
  static Element renormalized(const Element& R) {
    return R * (T(1.5) * Element::Identity() - T(0.5) * (R.transpose() * R));
  }

  // Unit quaternion (p0, p1, p2, p3) of R by Shepperd's rule: the largest of trace and diagonal decides, so
  // that the pivot is at least 1/2.
  static Quaternion<T> quaternion(const Element& R) {
    using std::sqrt;
    const T trace = R.trace();
    int largest = -1;
    T value = trace;
    for (int i = 0; i < 3; ++i)
      if (value < R(i, i)) {
        value = R(i, i);
        largest = i;
      }
    Quaternion<T> p;
    if (largest < 0) {
      const T root = sqrt(trace + T(1.0));
      const T f = T(0.5) / root;
      p << root * T(0.5), (R(2, 1) - R(1, 2)) * f, (R(0, 2) - R(2, 0)) * f, (R(1, 0) - R(0, 1)) * f;
      return p;
    }
    const int i = largest, j = (i + 1) % 3, k = (i + 2) % 3;
    const T root = sqrt(R(i, i) - R(j, j) - R(k, k) + T(1.0));
    const T f = T(0.5) / root;
    p(0) = (R(k, j) - R(j, k)) * f;
    p(1 + i) = root * T(0.5);
    p(1 + j) = (R(j, i) + R(i, j)) * f;
    p(1 + k) = (R(k, i) + R(i, k)) * f;
    return p;
  }
};

}  // namespace liebench
