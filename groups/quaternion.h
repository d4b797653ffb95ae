#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "groups/rotation_coefficients.h"
#include "groups/scalar.h"

// Quaternions (p0, p1, p2, p3), p0 the real part. A unit quaternion p turns w into p w conj(p).

namespace liebench {

template <class T>
using Quaternion = Eigen::Matrix<T, 4, 1>;

template <class T>
Quaternion<T> quaternion_product(const Quaternion<T>& p, const Quaternion<T>& q) {
  Quaternion<T> r;
  r << p(0) * q(0) - p(1) * q(1) - p(2) * q(2) - p(3) * q(3),
      p(0) * q(1) + p(1) * q(0) + p(2) * q(3) - p(3) * q(2),
      p(0) * q(2) - p(1) * q(3) + p(2) * q(0) + p(3) * q(1),
      p(0) * q(3) + p(1) * q(2) - p(2) * q(1) + p(3) * q(0);
  return r;
}

template <class T>
Quaternion<T> quaternion_conjugate(const Quaternion<T>& p) {
  return {p(0), -p(1), -p(2), -p(3)};
}

// Real part `real`, imaginary part `v`.
template <class T>
Quaternion<T> quaternion_of(const T& real, const Eigen::Matrix<T, 3, 1>& v) {
  return {real, v(0), v(1), v(2)};
}

template <class T>
Eigen::Matrix<T, 3, 1> imaginary(const Quaternion<T>& p) {
  return p.template tail<3>();
}

// R w for the rotation matrix R of p, and R^T w: w +- 2 p0 p x w + 2 p x (p x w), half of the products that
// the matrix takes.
template <class T>
Eigen::Matrix<T, 3, 1> quaternion_rotate(const Quaternion<T>& p, const Eigen::Matrix<T, 3, 1>& w) {
  const Eigen::Matrix<T, 3, 1> axis = imaginary<T>(p);
  const Eigen::Matrix<T, 3, 1> twice = axis.cross(w) * T(2.0);
  return w + twice * p(0) + axis.cross(twice);
}
template <class T>
Eigen::Matrix<T, 3, 1> quaternion_rotate_back(const Quaternion<T>& p, const Eigen::Matrix<T, 3, 1>& w) {
  const Eigen::Matrix<T, 3, 1> axis = imaginary<T>(p);
  const Eigen::Matrix<T, 3, 1> twice = axis.cross(w) * T(2.0);
  return w - twice * p(0) + axis.cross(twice);
}

// The rotation vector of the unit quaternion p, of length at most pi: that of -p where p0 < 0, the same
// rotation. By atan2, accurate to a few eps for every angle.
template <class T>
Eigen::Matrix<T, 3, 1> quaternion_log(const Quaternion<T>& p) {
  using std::atan2, std::sqrt;
  const bool flip = p(0) < 0.0;
  const T cosine = flip ? T(-p(0)) : p(0);
  const Eigen::Matrix<T, 3, 1> axis(flip ? T(-p(1)) : p(1), flip ? T(-p(2)) : p(2), flip ? T(-p(3)) : p(3));
  const T sine_squared = axis.squaredNorm();
  const T cosine_squared = cosine * cosine;
  if (sine_squared <= T(atan_series_reach) * cosine_squared)
    return axis * (T(2.0) / cosine * atan_ratio<T>(sine_squared / cosine_squared));
  const T sine = sqrt(sine_squared);
  return axis * (atan2(sine, cosine) * T(2.0) / sine);
}

// The rotation matrix of the unit quaternion p.
template <class T>
Eigen::Matrix<T, 3, 3> rotation_matrix(const Quaternion<T>& p) {
  const T one(1.0), two(2.0);
  Eigen::Matrix<T, 3, 3> R;
  R << one - two * (p(2) * p(2) + p(3) * p(3)), two * (p(1) * p(2) - p(0) * p(3)),
      two * (p(1) * p(3) + p(0) * p(2)),  //
      two * (p(1) * p(2) + p(0) * p(3)), one - two * (p(1) * p(1) + p(3) * p(3)),
      two * (p(2) * p(3) - p(0) * p(1)),  //
      two * (p(1) * p(3) - p(0) * p(2)), two * (p(2) * p(3) + p(0) * p(1)),
      one - two * (p(1) * p(1) + p(2) * p(2));
  return R;
}

}  // namespace liebench
