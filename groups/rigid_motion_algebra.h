#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "groups/direct_product.h"
#include "groups/real_space.h"
#include "groups/rotation_algebra.h"
#include "groups/rotation_coefficients.h"
#include "groups/so3.h"

namespace liebench {

// D(f skew(v) + g skew(v)^2) . u for coefficients f, g of |v|^2 whose slopes (1/x) df/dx, (1/x) dg/dx, x = |v|,
// are f_slope and g_slope:
//
//   f skew(u) + g (skew(u) skew(v) + skew(v) skew(u)) + (v . u) (f_slope skew(v) + g_slope skew(v)^2)
//
// written out as in skew_polynomial: no sum of the diagonal holds a term and its negative.
template <class T>
Eigen::Matrix<T, 3, 3> skew_polynomial_derivative(const Eigen::Matrix<T, 3, 1>& v,
                                                  const Eigen::Matrix<T, 3, 1>& u, const T& f,
                                                  const T& f_slope, const T& g, const T& g_slope) {
  const T rate = v.dot(u);
  const Eigen::Matrix<T, 3, 1> skew_part = u * f + v * T(rate * f_slope);
  // The symmetric part is w v^T + v w^T less its trace, w = g u + (v . u) g_slope v / 2.
  const Eigen::Matrix<T, 3, 1> w = u * g + v * T(rate * g_slope * 0.5);
  const T xx = w(0) * v(0) * 2.0, yy = w(1) * v(1) * 2.0, zz = w(2) * v(2) * 2.0;
  const T xy = w(0) * v(1) + w(1) * v(0), xz = w(0) * v(2) + w(2) * v(0), yz = w(1) * v(2) + w(2) * v(1);
  Eigen::Matrix<T, 3, 3> m;
  m << -(yy + zz), xy - skew_part(2), xz + skew_part(1),  //
      xy + skew_part(2), -(xx + zz), yz - skew_part(0),   //
      xz - skew_part(1), yz + skew_part(0), -(xx + yy);
  return m;
}

// What all representations of rigid motions (x, R), composed as (x1 + R1 x2, R1 R2), share: the Lie algebra se(3)
// of v = (U, Omega), velocity and angular velocity in the body frame: x' = R U, R' = R skew(Omega), with
//
//   [v, w] = (Omega_v x U_w + U_v x Omega_w, Omega_v x Omega_w)
//   ad(v) = [skew(Omega) skew(U); 0 skew(Omega)]
//
// An analytic function of ad(v) has the same blocks [F, D; 0, F]: F that of skew(Omega), D its derivative along U.
template <Scalar T>
struct RigidMotionAlgebra {
  using Tangent = Eigen::Matrix<T, 6, 1>;
  using TangentMatrix = Eigen::Matrix<T, 6, 6>;
  using Vector = Eigen::Matrix<T, 3, 1>;
  using Matrix = Eigen::Matrix<T, 3, 3>;
  using Represented = DirectProduct<RealSpace<T, 3>, SO3<T>>;
  static constexpr int dimension = 6;
  static constexpr bool commutative = false;

  static Tangent commutator(const Tangent& v, const Tangent& w) {
    return join(turn(v).cross(shift(w)) + shift(v).cross(turn(w)), turn(v).cross(turn(w)));
  }
  static TangentMatrix ad(const Tangent& v) { return blocks(skew(turn(v)), skew(shift(v))); }

  static TangentMatrix tangent(const Tangent& v) {
    const TangentBlocks T_v = tangent_blocks(v);
    return blocks(T_v.diagonal, T_v.upper);
  }

  // I + 1/2 ad(v) + ...; singular at |Omega| = 2 pi
  static TangentMatrix tangent_inverse(const Tangent& v) {
    const Vector omega = turn(v);
    const T x_squared = omega.squaredNorm();
    const T d = cotangent_defect<T>(x_squared);
    return blocks(
        skew_polynomial<T>(omega, T(0.5), d),
        skew_polynomial_derivative<T>(omega, shift(v), T(0.5), T(0.0), d, cotangent_slope<T>(x_squared)));
  }

  static Tangent tangent_times(const Tangent& v, const Tangent& w) {
    const T x_squared = turn(v).squaredNorm();
    return polynomial_times(v, w, w, T(-sinc_versine<T>(x_squared).versine), versine_slope<T>(x_squared),
                            sine_defect<T>(x_squared), T(-sine_defect_slope<T>(x_squared)));
  }
  static Tangent tangent_inverse_times(const Tangent& v, const Tangent& w) {
    const T x_squared = turn(v).squaredNorm();
    return polynomial_times(v, w, w, T(0.5), T(0.0), cotangent_defect<T>(x_squared),
                            cotangent_slope<T>(x_squared));
  }

  static Tangent coadjoint(const Tangent& v, const Tangent& w) {
    return join(shift(w).cross(turn(v)), shift(w).cross(shift(v)) + turn(w).cross(turn(v)));
  }
  static Tangent tangent_inverse_transposed_change(const Tangent& v, const Tangent& w) {
    const T x_squared = turn(v).squaredNorm();
    return transposed_change(v, w, T(0.5), T(0.0), cotangent_defect<T>(x_squared),
                             cotangent_slope<T>(x_squared));
  }
  // F = exp(skew(Omega)) = I + s skew(Omega) + b skew(Omega)^2; (1/x) ds/dx = (cos x - s) / x^2 = c - b
  static Tangent adjoint_transposed_change(const Tangent& v, const Tangent& w) {
    const T x_squared = turn(v).squaredNorm();
    const auto [sinc, versine] = sinc_versine<T>(x_squared);
    return transposed_change(v, w, sinc, T(sine_defect<T>(x_squared) - versine), versine,
                             T(-versine_slope<T>(x_squared)));
  }

  // [A1 F, A1 D + A2 F] for A = [A1, A2]
  template <class Derived>
  static Eigen::Matrix<T, Derived::RowsAtCompileTime, 6> times_tangent(const Eigen::MatrixBase<Derived>& A,
                                                                       const Tangent& v) {
    const TangentBlocks T_v = tangent_blocks(v);
    Eigen::Matrix<T, Derived::RowsAtCompileTime, 6> product;
    product.template leftCols<3>() = A.template leftCols<3>().lazyProduct(T_v.diagonal);
    product.template rightCols<3>() = A.template leftCols<3>().lazyProduct(T_v.upper);
    product.template rightCols<3>() += A.template rightCols<3>().lazyProduct(T_v.diagonal);
    return product;
  }

  static T rotation_angle(const Tangent& v) { return turn(v).norm(); }

 protected:
  static Vector shift(const Tangent& v) { return v.template head<3>(); }
  static Vector turn(const Tangent& v) { return v.template tail<3>(); }
  static Tangent join(const Vector& first, const Vector& second) {
    Tangent v;
    v << first, second;
    return v;
  }

  // The position of exp(v~): T(-Omega) U, T(-Omega) = I + b skew(Omega) + c skew(Omega)^2.
  static Vector exp_position(const Vector& U, const Vector& omega) {
    const T x_squared = omega.squaredNorm();
    return skew_polynomial<T>(omega, sinc_versine<T>(x_squared).versine, sine_defect<T>(x_squared)) * U;
  }
  // U of the position: T^{-1}(-Omega) x.
  static Vector log_position(const Vector& x, const Vector& omega) {
    return skew_polynomial<T>(omega, T(-0.5), cotangent_defect<T>(omega.squaredNorm())) * x;
  }

 private:
  // start + ((F - I) a + D alpha, (F - I) alpha) for w = (a, alpha), F = I + f skew(Omega) + g skew(Omega)^2 and D
  // its derivative along U, by vector products; slopes as in skew_polynomial_derivative.
  static Tangent polynomial_times(const Tangent& v, const Tangent& w, const Tangent& start, const T& f,
                                  const T& f_slope, const T& g, const T& g_slope) {
    const Vector U = shift(v), omega = turn(v);
    const T rate = omega.dot(U);
    const Vector a_once = omega.cross(shift(w)), once = omega.cross(turn(w)), across = U.cross(turn(w));
    const Vector twice = omega.cross(once);
    return join(shift(start) + f * (a_once + across) + g * (omega.cross(a_once + across) + U.cross(once)) +
                    rate * (f_slope * once + g_slope * twice),
                turn(start) + f * once + g * twice);
  }
  // ((F^T - I) a, D^T a + (F^T - I) alpha): F^T and D^T are F and D with -f for f, and change places.
  static Tangent transposed_change(const Tangent& v, const Tangent& w, const T& f, const T& f_slope,
                                   const T& g, const T& g_slope) {
    const Tangent change = polynomial_times(v, join(turn(w), shift(w)), Tangent::Constant(T(0.0)), T(-f),
                                            T(-f_slope), g, g_slope);
    return join(turn(change), shift(change));
  }

  struct TangentBlocks {
    Matrix diagonal, upper;
  };
  // F = I - b skew(Omega) + c skew(Omega)^2 and its derivative along U.
  static TangentBlocks tangent_blocks(const Tangent& v) {
    const Vector omega = turn(v);
    const T x_squared = omega.squaredNorm();
    const T minus_b = -sinc_versine<T>(x_squared).versine, c = sine_defect<T>(x_squared);
    return {skew_polynomial<T>(omega, minus_b, c),
            skew_polynomial_derivative<T>(omega, shift(v), minus_b, versine_slope<T>(x_squared), c,
                                          T(-sine_defect_slope<T>(x_squared)))};
  }
  static TangentMatrix blocks(const Matrix& diagonal, const Matrix& upper) {
    TangentMatrix m;
    m.template topLeftCorner<3, 3>() = diagonal;
    m.template topRightCorner<3, 3>() = upper;
    m.template bottomLeftCorner<3, 3>().setConstant(T(0.0));
    m.template bottomRightCorner<3, 3>() = diagonal;
    return m;
  }
};

}  // namespace liebench
