#pragma once

#include <Eigen/Core>
#include <concepts>

#include "groups/scalar.h"

// A Lie group G of dimension m in left trivialisation: q' = DL_q(e) v~, v in R^m [Bruels & Cardona 2010].

namespace liebench {

// What every group gives, all as static functions of a type that holds no state:
//
//   identity(), compose(a, b), inverse(a)   the group
//   exp(v)               exp(v~), v in R^m; valid for every finite v
//   log(q)               v with exp(v~) = q and every rotation angle in [0, pi]
//   commutator(v, w)     the vector of [v~, w~], the operator v^ w of eq. (15)
//   ad(v)                its matrix, m x m: ad(v) w = commutator(v, w)
//   tangent(v)           T(v) = dexp_{-v}, m x m: d exp(v~) = exp(v~) (T(v) dv)~
//   tangent_inverse(v)   T(v)^{-1}; singular where a rotation angle is 2 pi
//   tangent_times(v, w)  T(v) w, by vector products
//   tangent_inverse_times(v, w)   T(v)^{-1} w, by vector products
//   coadjoint(v, w)      ad(v)^T w, by vector products; and of momenta, w, what these operators change of them:
//   tangent_inverse_transposed_change(v, w)   (T(v)^{-T} - I) w
//   adjoint_transposed_change(v, w)           (Ad(exp(v~))^T - I) w, Ad(exp(v~)) = exp(ad(v))
//   times_tangent(A, v)  A T(v) for A with m columns, without the products that the structure of T makes trivial
//   represented(q)       what q stands for, an element of the group Represented: rotation matrices and positions.
//                        Elements of different groups are compared through it. Its group law need not be that
//                        of G (rigid motions are represented in R^3 x SO(3)).
//   representative(r)    a q with represented(q) = r
//   stacked(q)           the representation as one vector (rotation matrices column by column), for norms
//   unstacked(s)         q with stacked(q) = s
//   cast<U>(q)           the same element in the scalar U, an element of rebind<U>
//   rotation_angle(v)    the largest rotation angle [rad] in exp(v~); 0 where nothing rotates
//   separation(q, p)     v with p = q o exp(v~) in double, to full relative accuracy however close q and p are
//   defect(q)            how far q is from the group (||R^T R - I||_F, ||p|^2 - 1|; 0 in linear spaces), the
//                        largest of a product's
//   renormalized(q)      the element next to q that satisfies the conditions of the representation, for q within
//                        sqrt(eps) of the group (first-order correction)
//
// Types: `Represented`, a Lie group over the same scalar that represents itself; of the same dimension.
// Flags: `commutative` (every commutator vanishes: no method may compute one).
template <class G>
concept LieGroup = Scalar<typename G::Scalar> && std::copyable<typename G::Element> &&
    requires(const typename G::Element& q, const typename G::Tangent& v,
             const Eigen::Matrix<typename G::Scalar, 2, G::dimension>& two_rows) {
  { G::dimension } -> std::convertible_to<int>;
  { G::commutative } -> std::convertible_to<bool>;
  { G::identity() } -> std::same_as<typename G::Element>;
  { G::compose(q, q) } -> std::same_as<typename G::Element>;
  { G::inverse(q) } -> std::same_as<typename G::Element>;
  { G::exp(v) } -> std::same_as<typename G::Element>;
  { G::log(q) } -> std::same_as<typename G::Tangent>;
  { G::commutator(v, v) } -> std::same_as<typename G::Tangent>;
  { G::ad(v) } -> std::same_as<typename G::TangentMatrix>;
  { G::tangent(v) } -> std::same_as<typename G::TangentMatrix>;
  { G::tangent_inverse(v) } -> std::same_as<typename G::TangentMatrix>;
  { G::tangent_times(v, v) } -> std::same_as<typename G::Tangent>;
  { G::tangent_inverse_times(v, v) } -> std::same_as<typename G::Tangent>;
  { G::coadjoint(v, v) } -> std::same_as<typename G::Tangent>;
  { G::tangent_inverse_transposed_change(v, v) } -> std::same_as<typename G::Tangent>;
  { G::adjoint_transposed_change(v, v) } -> std::same_as<typename G::Tangent>;
  { G::times_tangent(two_rows, v) } -> std::same_as<Eigen::Matrix<typename G::Scalar, 2, G::dimension>>;
  { G::represented(q) } -> std::same_as<typename G::Represented::Element>;
  { G::representative(G::represented(q)) } -> std::same_as<typename G::Element>;
  { G::stacked(q) } -> std::same_as<typename G::Stacked>;
  { G::unstacked(G::stacked(q)) } -> std::same_as<typename G::Element>;
  { G::template cast<double>(q) } -> std::same_as<typename G::template rebind<double>::Element>;
  { G::rotation_angle(v) } -> std::same_as<typename G::Scalar>;
  { G::separation(q, q) } -> std::same_as<Eigen::Matrix<double, G::dimension, 1>>;
  { G::defect(q) } -> std::same_as<typename G::Scalar>;
  { G::renormalized(q) } -> std::same_as<typename G::Element>;
};

// The identity matrix and zero of the size of A.
template <class Derived>
auto identity_like(const Eigen::MatrixBase<Derived>& A) {
  return Derived::PlainObject::Identity(A.rows(), A.cols()).eval();
}
template <class Derived>
auto zero_like(const Eigen::MatrixBase<Derived>& A) {
  return Derived::PlainObject::Zero(A.rows(), A.cols()).eval();
}

// A group whose size is known at run time only (the bodies of a scene): the same functions, but of an object, and size() in
// place of the flag `dimension`, which is Eigen::Dynamic; commutative() in place of `commutative`. ad, tangent and
// tangent_inverse may give any type of matrix that has sums, products, multiples and lpNorm. over<U>() is the same group in U.
template <class G>
concept SizedLieGroup = Scalar<typename G::Scalar> && std::copyable<typename G::Element> &&
    requires(const G& group, const typename G::Element& q, const typename G::Tangent& v) {
  requires G::dimension == Eigen::Dynamic;
  { group.size() } -> std::convertible_to<Eigen::Index>;
  { group.commutative() } -> std::same_as<bool>;
  { group.identity() } -> std::same_as<typename G::Element>;
  { group.compose(q, q) } -> std::same_as<typename G::Element>;
  { group.inverse(q) } -> std::same_as<typename G::Element>;
  { group.exp(v) } -> std::same_as<typename G::Element>;
  { group.log(q) } -> std::same_as<typename G::Tangent>;
  { group.commutator(v, v) } -> std::same_as<typename G::Tangent>;
  { group.ad(v) } -> std::same_as<typename G::TangentMatrix>;
  { group.tangent_times(v, v) } -> std::same_as<typename G::Tangent>;
  { group.tangent_inverse_times(v, v) } -> std::same_as<typename G::Tangent>;
  { group.coadjoint(v, v) } -> std::same_as<typename G::Tangent>;
  { group.tangent_inverse_transposed_change(v, v) } -> std::same_as<typename G::Tangent>;
  { group.adjoint_transposed_change(v, v) } -> std::same_as<typename G::Tangent>;
  { group.rotation_angle(v) } -> std::same_as<typename G::Scalar>;
};

}  // namespace liebench
