#pragma once

#include <Eigen/Core>

#include "groups/lie_group.h"

namespace liebench {

// R^n with addition: exp is the identity map and every commutator vanishes.
template <Scalar T, int n>
struct RealSpace {
  using Scalar = T;
  using Element = Eigen::Matrix<T, n, 1>;
  using Tangent = Eigen::Matrix<T, n, 1>;
  using TangentMatrix = Eigen::Matrix<T, n, n>;
  using Stacked = Eigen::Matrix<T, n, 1>;
  template <class U>
  using rebind = RealSpace<U, n>;
  using Represented = RealSpace;
  static constexpr int dimension = n;
  static constexpr bool commutative = true;

  static Element identity() { return Element::Constant(T(0.0)); }
  static Element compose(const Element& a, const Element& b) { return a + b; }
  static Element inverse(const Element& q) { return -q; }
  static Element exp(const Tangent& v) { return v; }
  static Tangent log(const Element& q) { return q; }
  static Tangent commutator(const Tangent&, const Tangent&) { return Tangent::Constant(T(0.0)); }
  static TangentMatrix ad(const Tangent&) { return TangentMatrix::Constant(T(0.0)); }
  static TangentMatrix tangent(const Tangent&) { return TangentMatrix::Identity(); }
  static TangentMatrix tangent_inverse(const Tangent&) { return TangentMatrix::Identity(); }
  static Tangent tangent_times(const Tangent&, const Tangent& w) { return w; }
  static Tangent tangent_inverse_times(const Tangent&, const Tangent& w) { return w; }
  static Tangent coadjoint(const Tangent&, const Tangent&) { return Tangent::Constant(T(0.0)); }
  static Tangent tangent_inverse_transposed_change(const Tangent&, const Tangent&) {
    return Tangent::Constant(T(0.0));
  }
  static Tangent adjoint_transposed_change(const Tangent&, const Tangent&) {
    return Tangent::Constant(T(0.0));
  }
  template <class Derived>
  static Eigen::Matrix<T, Derived::RowsAtCompileTime, n> times_tangent(const Eigen::MatrixBase<Derived>& A,
                                                                       const Tangent&) {
    return A;
  }
  static Element represented(const Element& q) { return q; }
  static Element representative(const Element& q) { return q; }
  static Stacked stacked(const Element& q) { return q; }
  static Element unstacked(const Stacked& s) { return s; }
  template <class U>
  static typename RealSpace<U, n>::Element cast(const Element& q) {
    return q.template cast<U>();
  }
  static T rotation_angle(const Tangent&) { return T(0.0); }
  static Eigen::Matrix<double, n, 1> separation(const Element& q, const Element& p) {
    return (p - q).eval().template cast<double>();
  }
  static T defect(const Element&) { return T(0.0); }
  static Element renormalized(const Element& q) { return q; }
};

}  // namespace liebench
