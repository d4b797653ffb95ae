#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "groups/lie_group.h"
#include "groups/rotation_coefficients.h"

namespace liebench {

// skew(v) w = v x w
template <class Derived>
Eigen::Matrix<typename Derived::Scalar, 3, 3> skew(const Eigen::MatrixBase<Derived>& v) {
  using T = typename Derived::Scalar;
  const T zero(0.0);
  Eigen::Matrix<T, 3, 3> s;
  s << zero, -v(2), v(1), v(2), zero, -v(0), -v(1), v(0), zero;
  return s;
}

// Rotations in space as matrices R (3 x 3, R^T R = I, det R = 1), R' = R skew(omega) with omega the angular
// velocity in the body frame. Closed forms: METHODS.md section 6 of the design; Hairer, Lubich & Wanner 2006,
// IV.7.
template <Scalar T>
struct SO3 {
  using Scalar = T;
  using Element = Eigen::Matrix<T, 3, 3>;
  using Tangent = Eigen::Matrix<T, 3, 1>;
  using TangentMatrix = Eigen::Matrix<T, 3, 3>;
  using Stacked = Eigen::Matrix<T, 9, 1>;
  template <class U>
  using rebind = SO3<U>;
  static constexpr int dimension = 3;
  static constexpr bool commutative = false;

  static Element identity() { return Element::Identity(); }
  static Element compose(const Element& a, const Element& b) { return a * b; }
  static Element inverse(const Element& q) { return q.transpose(); }

  // I + s skew(v) + b skew(v)^2 with skew(v)^2 = v v^T - |v|^2 I written out, so that the diagonal is 1 -
  // O(|v|^2).
  static Element exp(const Tangent& v) {
    const T xx = v(0) * v(0), yy = v(1) * v(1), zz = v(2) * v(2);
    const auto [s, b] = sinc_versine<T>(xx + yy + zz);
    const T bxy = b * v(0) * v(1), bxz = b * v(0) * v(2), byz = b * v(1) * v(2);
    const T sx = s * v(0), sy = s * v(1), sz = s * v(2);
    const T one(1.0);
    Element R;
    R << one - b * (yy + zz), bxy - sz, bxz + sy,  //
        bxy + sz, one - b * (xx + zz), byz - sx,   //
        bxz - sy, byz + sx, one - b * (xx + yy);
    return R;
  }

  // By the unit quaternion (p0, p), p0 >= 0, and atan2: a few eps for every angle up to and at pi. (acos of
  // the trace loses half of the digits near 0 and near pi.)
  static Tangent log(const Element& R) {
    using std::atan2, std::sqrt;
    Eigen::Matrix<T, 4, 1> p = quaternion(R);
    if (p(0) < 0.0) p = -p;
    const Tangent axis = p.template tail<3>();
    const T sine_squared = axis.squaredNorm();
    const T cosine_squared = p(0) * p(0);
    if (sine_squared <= atan_series_reach * cosine_squared)
      return axis * (T(2.0) / p(0) * atan_ratio<T>(sine_squared / cosine_squared));
    const T sine = sqrt(sine_squared);
    return axis * (atan2(sine, p(0)) * 2.0 / sine);
  }

  static Tangent commutator(const Tangent& v, const Tangent& w) { return v.cross(w); }
  static TangentMatrix ad(const Tangent& v) { return skew(v); }

  // I - b skew(v) + c skew(v)^2
  static TangentMatrix tangent(const Tangent& v) {
    const T x_squared = v.squaredNorm();
    return polynomial(v, -sinc_versine<T>(x_squared).versine, sine_defect<T>(x_squared));
  }

  // I + 1/2 skew(v) + d skew(v)^2; singular at |v| = 2 pi
  static TangentMatrix tangent_inverse(const Tangent& v) {
    return polynomial(v, T(0.5), cotangent_defect<T>(v.squaredNorm()));
  }

  template <class Derived>
  static Eigen::Matrix<T, Derived::RowsAtCompileTime, 3> times_tangent(const Eigen::MatrixBase<Derived>& A,
                                                                       const Tangent& v) {
    return A * tangent(v);
  }

  static Stacked stacked(const Element& R) { return R.reshaped(); }
  template <class U>
  static typename SO3<U>::Element cast(const Element& R) {
    return R.template cast<U>();
  }
  static T rotation_angle(const Tangent& v) { return v.norm(); }

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
  static Eigen::Matrix<T, 4, 1> quaternion(const Element& R) {
    using std::sqrt;
    const T trace = R.trace();
    int largest = -1;
    T value = trace;
    for (int i = 0; i < 3; ++i)
      if (value < R(i, i)) {
        value = R(i, i);
        largest = i;
      }
    Eigen::Matrix<T, 4, 1> p;
    if (largest < 0) {
      const T root = sqrt(trace + 1.0);
      const T f = T(0.5) / root;
      p << root * 0.5, (R(2, 1) - R(1, 2)) * f, (R(0, 2) - R(2, 0)) * f, (R(1, 0) - R(0, 1)) * f;
      return p;
    }
    const int i = largest, j = (i + 1) % 3, k = (i + 2) % 3;
    const T root = sqrt(R(i, i) - R(j, j) - R(k, k) + 1.0);
    const T f = T(0.5) / root;
    p(0) = (R(k, j) - R(j, k)) * f;
    p(1 + i) = root * 0.5;
    p(1 + j) = (R(j, i) + R(i, j)) * f;
    p(1 + k) = (R(k, i) + R(i, k)) * f;
    return p;
  }

  // R of the unit quaternion p = (p0, p1, p2, p3).
  static Element from_quaternion(const Eigen::Matrix<T, 4, 1>& p) {
    const T one(1.0), two(2.0);
    Element R;
    R << one - two * (p(2) * p(2) + p(3) * p(3)), two * (p(1) * p(2) - p(0) * p(3)),
        two * (p(1) * p(3) + p(0) * p(2)),  //
        two * (p(1) * p(2) + p(0) * p(3)), one - two * (p(1) * p(1) + p(3) * p(3)),
        two * (p(2) * p(3) - p(0) * p(1)),  //
        two * (p(1) * p(3) - p(0) * p(2)), two * (p(2) * p(3) + p(0) * p(1)),
        one - two * (p(1) * p(1) + p(2) * p(2));
    return R;
  }

 private:
  // I + f skew(v) + g skew(v)^2
  static TangentMatrix polynomial(const Tangent& v, const T& f, const T& g) {
    const T xx = v(0) * v(0), yy = v(1) * v(1), zz = v(2) * v(2);
    const T gxy = g * v(0) * v(1), gxz = g * v(0) * v(2), gyz = g * v(1) * v(2);
    const T one(1.0);
    TangentMatrix m;
    m << one - g * (yy + zz), gxy - f * v(2), gxz + f * v(1),  //
        gxy + f * v(2), one - g * (xx + zz), gyz - f * v(0),   //
        gxz - f * v(1), gyz + f * v(0), one - g * (xx + yy);
    return m;
  }
};

}  // namespace liebench
