#pragma once

#include <Eigen/Core>
#include <utility>

#include "groups/lie_group.h"

namespace liebench {

// A x B with componentwise operations; tangent vectors (v_A, v_B) stacked in this order. Longer products
// nest.
template <LieGroup A, LieGroup B>
struct DirectProduct {
  using Scalar = typename A::Scalar;
  using Element = std::pair<typename A::Element, typename B::Element>;
  template <class U>
  using rebind = DirectProduct<typename A::template rebind<U>, typename B::template rebind<U>>;
  using Represented = DirectProduct<typename A::Represented, typename B::Represented>;
  static constexpr int a = A::dimension, b = B::dimension;
  static constexpr int dimension = a + b;
  static constexpr bool commutative = A::commutative && B::commutative;
  using Tangent = Eigen::Matrix<Scalar, dimension, 1>;
  using TangentMatrix = Eigen::Matrix<Scalar, dimension, dimension>;
  using Stacked =
      Eigen::Matrix<Scalar, int(A::Stacked::RowsAtCompileTime) + int(B::Stacked::RowsAtCompileTime), 1>;

  static Element identity() { return {A::identity(), B::identity()}; }
  static Element compose(const Element& p, const Element& q) {
    return {A::compose(p.first, q.first), B::compose(p.second, q.second)};
  }
  static Element inverse(const Element& q) { return {A::inverse(q.first), B::inverse(q.second)}; }
  static Element exp(const Tangent& v) { return {A::exp(head(v)), B::exp(tail(v))}; }
  static Tangent log(const Element& q) { return join(A::log(q.first), B::log(q.second)); }
  static Tangent commutator(const Tangent& v, const Tangent& w) {
    return join(A::commutator(head(v), head(w)), B::commutator(tail(v), tail(w)));
  }
  static TangentMatrix ad(const Tangent& v) { return block_diagonal(A::ad(head(v)), B::ad(tail(v))); }
  static TangentMatrix tangent(const Tangent& v) {
    return block_diagonal(A::tangent(head(v)), B::tangent(tail(v)));
  }
  static TangentMatrix tangent_inverse(const Tangent& v) {
    return block_diagonal(A::tangent_inverse(head(v)), B::tangent_inverse(tail(v)));
  }
  static Tangent tangent_times(const Tangent& v, const Tangent& w) {
    return join(A::tangent_times(head(v), head(w)), B::tangent_times(tail(v), tail(w)));
  }
  static Tangent tangent_inverse_times(const Tangent& v, const Tangent& w) {
    return join(A::tangent_inverse_times(head(v), head(w)), B::tangent_inverse_times(tail(v), tail(w)));
  }
  static Tangent coadjoint(const Tangent& v, const Tangent& w) {
    return join(A::coadjoint(head(v), head(w)), B::coadjoint(tail(v), tail(w)));
  }
  static Tangent tangent_inverse_transposed_change(const Tangent& v, const Tangent& w) {
    return join(A::tangent_inverse_transposed_change(head(v), head(w)),
                B::tangent_inverse_transposed_change(tail(v), tail(w)));
  }
  static Tangent adjoint_transposed_change(const Tangent& v, const Tangent& w) {
    return join(A::adjoint_transposed_change(head(v), head(w)),
                B::adjoint_transposed_change(tail(v), tail(w)));
  }
  template <class Derived>
  static Eigen::Matrix<Scalar, Derived::RowsAtCompileTime, dimension> times_tangent(
      const Eigen::MatrixBase<Derived>& M, const Tangent& v) {
    Eigen::Matrix<Scalar, Derived::RowsAtCompileTime, dimension> product;
    product.template leftCols<a>() = A::times_tangent(M.template leftCols<a>(), head(v));
    product.template rightCols<b>() = B::times_tangent(M.template rightCols<b>(), tail(v));
    return product;
  }
  static typename Represented::Element represented(const Element& q) {
    return {A::represented(q.first), B::represented(q.second)};
  }
  static Element representative(const typename Represented::Element& r) {
    return {A::representative(r.first), B::representative(r.second)};
  }
  static Stacked stacked(const Element& q) {
    Stacked s;
    s << A::stacked(q.first), B::stacked(q.second);
    return s;
  }
  static Element unstacked(const Stacked& s) {
    constexpr int rows = A::Stacked::RowsAtCompileTime;
    return {A::unstacked(s.template head<rows>()),
            B::unstacked(s.template tail<Stacked::RowsAtCompileTime - rows>())};
  }
  template <class U>
  static typename rebind<U>::Element cast(const Element& q) {
    return {A::template cast<U>(q.first), B::template cast<U>(q.second)};
  }
  static Scalar rotation_angle(const Tangent& v) {
    const Scalar first = A::rotation_angle(head(v)), second = B::rotation_angle(tail(v));
    return first < second ? second : first;
  }
  static Eigen::Matrix<double, dimension, 1> separation(const Element& q, const Element& p) {
    Eigen::Matrix<double, dimension, 1> v;
    v << A::separation(q.first, p.first), B::separation(q.second, p.second);
    return v;
  }
  static Scalar defect(const Element& q) {
    const Scalar first = A::defect(q.first), second = B::defect(q.second);
    return first < second ? second : first;
  }
  static Element renormalized(const Element& q) {
    return {A::renormalized(q.first), B::renormalized(q.second)};
  }

 private:
  static typename A::Tangent head(const Tangent& v) { return v.template head<a>(); }
  static typename B::Tangent tail(const Tangent& v) { return v.template tail<b>(); }
  static Tangent join(const typename A::Tangent& first, const typename B::Tangent& second) {
    Tangent v;
    v << first, second;
    return v;
  }
  static TangentMatrix block_diagonal(const typename A::TangentMatrix& first,
                                      const typename B::TangentMatrix& second) {
    TangentMatrix m = TangentMatrix::Constant(Scalar(0.0));
    m.template topLeftCorner<a, a>() = first;
    m.template bottomRightCorner<b, b>() = second;
    return m;
  }
};

}  // namespace liebench
