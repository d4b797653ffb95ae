#pragma once

#include <Eigen/Core>
#include <cmath>

#include "groups/rotation_coefficients.h"
#include "groups/scalar.h"

// Quaternions (p0, p1, p2, p3), p0 the real part. A unit quaternion p turns w into p w conj(p).

namespace liebench {

template <class T>
using Quaternion = Eigen::Matrix<T, 4, 1>;

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
  if (sine_squared <= atan_series_reach * cosine_squared)
    return axis * (T(2.0) / cosine * atan_ratio<T>(sine_squared / cosine_squared));
  const T sine = sqrt(sine_squared);
  return axis * (atan2(sine, cosine) * 2.0 / sine);
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
