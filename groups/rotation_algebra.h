#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "groups/rotation_coefficients.h"
#include "groups/scalar.h"

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

// I + f skew(v) + g skew(v)^2, with skew(v)^2 = v v^T - |v|^2 I written out: nothing cancels on the diagonal.
template <class T>
Eigen::Matrix<T, 3, 3> skew_polynomial(const Eigen::Matrix<T, 3, 1>& v, const T& f, const T& g) {
  const T xx = v(0) * v(0), yy = v(1) * v(1), zz = v(2) * v(2);
  const T gxy = g * v(0) * v(1), gxz = g * v(0) * v(2), gyz = g * v(1) * v(2);
  const T fx = f * v(0), fy = f * v(1), fz = f * v(2);
  const T one(1.0);
  Eigen::Matrix<T, 3, 3> m;
  m << one - g * (yy + zz), gxy - fz, gxz + fy,  //
      gxy + fz, one - g * (xx + zz), gyz - fx,   //
      gxz - fy, gyz + fx, one - g * (xx + yy);
  return m;
}

// What all representations of rotations share: the Lie algebra R^3 with the vector product and its tangent
// operators.
template <Scalar T>
struct RotationAlgebra {
  using Tangent = Eigen::Matrix<T, 3, 1>;
  using TangentMatrix = Eigen::Matrix<T, 3, 3>;

  static Tangent commutator(const Tangent& v, const Tangent& w) { return v.cross(w); }
  static TangentMatrix ad(const Tangent& v) { return skew(v); }

  // I - b skew(v) + c skew(v)^2
  static TangentMatrix tangent(const Tangent& v) {
    const T x_squared = v.squaredNorm();
    return skew_polynomial<T>(v, -sinc_versine<T>(x_squared).versine, sine_defect<T>(x_squared));
  }

  // I + 1/2 skew(v) + d skew(v)^2; singular at |v| = 2 pi
  static TangentMatrix tangent_inverse(const Tangent& v) {
    return skew_polynomial<T>(v, T(0.5), cotangent_defect<T>(v.squaredNorm()));
  }

  static Tangent tangent_times(const Tangent& v, const Tangent& w) {
    const T x_squared = v.squaredNorm();
    const Tangent once = v.cross(w);
    return w - sinc_versine<T>(x_squared).versine * once + sine_defect<T>(x_squared) * v.cross(once);
  }

  static Tangent tangent_inverse_times(const Tangent& v, const Tangent& w) {
    const Tangent once = v.cross(w);
    return w + T(0.5) * once + cotangent_defect<T>(v.squaredNorm()) * v.cross(once);
  }

  static Tangent coadjoint(const Tangent& v, const Tangent& w) { return w.cross(v); }
  static Tangent tangent_inverse_transposed_change(const Tangent& v, const Tangent& w) {
    const Tangent once = v.cross(w);
    return cotangent_defect<T>(v.squaredNorm()) * v.cross(once) - T(0.5) * once;
  }
  // exp(skew(v))^T = I - s skew(v) + b skew(v)^2
  static Tangent adjoint_transposed_change(const Tangent& v, const Tangent& w) {
    const auto [sinc, versine] = sinc_versine<T>(v.squaredNorm());
    const Tangent once = v.cross(w);
    return versine * v.cross(once) - sinc * once;
  }

  template <class Derived>
  static Eigen::Matrix<T, Derived::RowsAtCompileTime, 3> times_tangent(const Eigen::MatrixBase<Derived>& A,
                                                                       const Tangent& v) {
    return A * tangent(v);
  }

  static T rotation_angle(const Tangent& v) { return v.norm(); }
};

}  // namespace liebench
