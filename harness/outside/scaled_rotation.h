#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "groups/rotation_algebra.h"

// The rotation of a quaternion p of any length, that of p / |p|: stages and iterates of a solver that does not know the
// unit sphere leave it, and what they leave it by turns nothing. With p = (p0, u):
//
//   R(p) w   = ((p0^2 - u.u) w + 2 (u.w) u + 2 p0 u x w) / |p|^2,   R(p)^T w = R(conj p) w

namespace liebench::outside {

using Vector3 = Eigen::Vector3d;
using Vector4 = Eigen::Vector4d;
using Matrix3 = Eigen::Matrix3d;
using Matrix34 = Eigen::Matrix<double, 3, 4>;

// R(p)^T w, and its derivative by p, 3 x 4, `turned` the former.
inline Vector3 turn_back(const Vector4& p, const Vector3& w) {
  const Vector3 u = p.tail<3>();
  const double uu = u.squaredNorm(), p0 = p(0);
  return ((p0 * p0 - uu) * w + 2.0 * (u.dot(w) * u - p0 * u.cross(w))) / (p0 * p0 + uu);
}
inline Matrix34 turn_back_derivative(const Vector4& p, const Vector3& w, const Vector3& turned) {
  const Vector3 u = p.tail<3>();
  Matrix34 D;
  D.col(0) = 2.0 * (p(0) * w - u.cross(w));
  D.rightCols<3>() = 2.0 * (u * w.transpose() - w * u.transpose() + p(0) * skew(w));
  D.rightCols<3>().diagonal().array() += 2.0 * u.dot(w);
  return (D - 2.0 * turned * p.transpose()) / p.squaredNorm();
}

// R(p)^T
inline Matrix3 rotation_back(const Vector4& p) {
  Matrix3 R;
  for (int i = 0; i < 3; ++i) R.col(i) = turn_back(p, Vector3::Unit(i));
  return R;
}

// R(p) w, and its derivative.
inline Vector4 conjugate(const Vector4& p) {
  return {p(0), -p(1), -p(2), -p(3)};
}
inline Vector3 turn(const Vector4& p, const Vector3& w) {
  return turn_back(conjugate(p), w);
}
inline Matrix34 turn_derivative(const Vector4& p, const Vector3& w, const Vector3& turned) {
  Matrix34 D = turn_back_derivative(conjugate(p), w, turned);
  D.rightCols<3>() *= -1.0;
  return D;
}

// p (0, omega) / 2, the rate of p.
inline Vector4 quaternion_rate(const Vector4& p, const Vector3& omega) {
  const Vector3 u = p.tail<3>();
  Vector4 rate;
  rate << -0.5 * u.dot(omega), 0.5 * (p(0) * omega + u.cross(omega));
  return rate;
}

// p (0, omega) = Q(p) omega = P(omega) p, both matrices.
inline Eigen::Matrix<double, 4, 3> times_imaginary(const Vector4& p) {
  Eigen::Matrix<double, 4, 3> Q;
  Q << -p(1), -p(2), -p(3),  //
      p(0), -p(3), p(2),     //
      p(3), p(0), -p(1),     //
      -p(2), p(1), p(0);
  return Q;
}
inline Eigen::Matrix4d imaginary_factor(const Vector3& omega) {
  Eigen::Matrix4d P;
  P << 0.0, -omega(0), -omega(1), -omega(2),  //
      omega(0), 0.0, omega(2), -omega(1),     //
      omega(1), -omega(2), 0.0, omega(0),     //
      omega(2), omega(1), -omega(0), 0.0;
  return P;
}

}  // namespace liebench::outside
