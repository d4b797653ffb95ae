#pragma once

#include <ceres/jet.h>

#include <Eigen/Core>
#include <concepts>
#include <type_traits>
#include <vector>

#include "groups/extended.h"
#include "groups/lie_group.h"
#include "tests/support/lie_group_examples.h"

// A Lie group behind one type, its elements as their stacked representations: what is tested of every group is compiled once for
// a scalar, and not once for each group.

namespace liebench {

template <class T>
class AnyGroup {
 public:
  using Vector = Eigen::Matrix<T, Eigen::Dynamic, 1>;
  using Matrix = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;

  AnyGroup() = default;
  AnyGroup(const AnyGroup&) = delete;
  AnyGroup& operator=(const AnyGroup&) = delete;
  virtual ~AnyGroup() = default;

  // The concept LieGroup.
  virtual int dimension() const = 0;
  virtual bool commutative() const = 0;
  virtual Vector identity() const = 0;
  virtual Vector compose(const Vector& a, const Vector& b) const = 0;
  virtual Vector inverse(const Vector& q) const = 0;
  virtual Vector exp(const Vector& v) const = 0;
  virtual Vector log(const Vector& q) const = 0;
  virtual Vector commutator(const Vector& v, const Vector& w) const = 0;
  virtual Matrix ad(const Vector& v) const = 0;
  virtual Matrix tangent(const Vector& v) const = 0;
  virtual Matrix tangent_inverse(const Vector& v) const = 0;
  virtual Vector tangent_times(const Vector& v, const Vector& w) const = 0;
  virtual Vector tangent_inverse_times(const Vector& v, const Vector& w) const = 0;
  virtual Vector coadjoint(const Vector& v, const Vector& w) const = 0;
  virtual Vector tangent_inverse_transposed_change(const Vector& v, const Vector& w) const = 0;
  virtual Vector adjoint_transposed_change(const Vector& v, const Vector& w) const = 0;
  // For A of four rows.
  virtual Matrix times_tangent(const Matrix& A, const Vector& v) const = 0;
  virtual Vector represented(const Vector& q) const = 0;
  virtual Vector represented_identity() const = 0;
  virtual Vector representative(const Vector& r) const = 0;
  virtual T rotation_angle(const Vector& v) const = 0;
  virtual Eigen::VectorXd separation(const Vector& q, const Vector& p) const = 0;
  virtual T defect(const Vector& q) const = 0;
  virtual Vector renormalized(const Vector& q) const = 0;

  // LieGroupExamples.
  virtual std::vector<Vector> directions() const = 0;
  virtual std::vector<Vector> representations(const Vector& q) const = 0;
  virtual Vector represented_exp(const Vector& v) const = 0;
  virtual Vector represented_product(const Vector& a, const Vector& b) const = 0;

  // cast(): q in half of its digits (float for double, double for Extended) and back, in Extended and back, in double.
  virtual Vector through_half_precision(const Vector& q) const = 0;
  virtual Vector through_extended(const Vector& q) const = 0;
  virtual Eigen::VectorXd in_double(const Vector& q) const = 0;

  // The same group in double, and derivatives by Jets there; column i along the i-th component of delta, at delta = 0:
  // of log(exp(v)^-1 exp(v + delta)), log(exp(delta) exp(w) exp(-delta)), log(exp(delta)), and, in columns of their own, of the
  // entries of T(delta) and T^-1(delta).
  virtual const AnyGroup<double>& doubles() const = 0;
  virtual Eigen::MatrixXd exp_by_jets(const Eigen::VectorXd& v) const = 0;
  virtual Eigen::MatrixXd conjugate_by_jets(const Eigen::VectorXd& w) const = 0;
  virtual Eigen::MatrixXd log_exp_by_jets() const = 0;
  virtual Eigen::MatrixXd tangent_by_jets() const = 0;
  virtual Eigen::MatrixXd tangent_inverse_by_jets() const = 0;
};

template <LieGroup G>
const AnyGroup<typename G::Scalar>& any_group();

template <LieGroup G>
class HeldGroup final : public AnyGroup<typename G::Scalar> {
  using T = typename G::Scalar;
  using Examples = LieGroupExamples<G>;
  using Represented = typename G::Represented;
  using Doubles = typename G::template rebind<double>;
  static_assert(LieGroup<Represented> && std::same_as<typename Represented::Scalar, T>);
  static_assert(std::same_as<typename Represented::Represented, Represented>);
  static_assert(Represented::dimension == G::dimension);
  static_assert(std::same_as<typename Represented::template rebind<double>, typename Doubles::Represented>);

 public:
  using typename AnyGroup<T>::Vector;
  using typename AnyGroup<T>::Matrix;

  int dimension() const override { return G::dimension; }
  bool commutative() const override { return G::commutative; }
  Vector identity() const override { return stacked(G::identity()); }
  Vector compose(const Vector& a, const Vector& b) const override {
    return stacked(G::compose(element(a), element(b)));
  }
  Vector inverse(const Vector& q) const override { return stacked(G::inverse(element(q))); }
  Vector exp(const Vector& v) const override { return stacked(G::exp(v)); }
  Vector log(const Vector& q) const override { return G::log(element(q)); }
  Vector commutator(const Vector& v, const Vector& w) const override { return G::commutator(v, w); }
  Matrix ad(const Vector& v) const override { return G::ad(v); }
  Matrix tangent(const Vector& v) const override { return G::tangent(v); }
  Matrix tangent_inverse(const Vector& v) const override { return G::tangent_inverse(v); }
  Vector tangent_times(const Vector& v, const Vector& w) const override { return G::tangent_times(v, w); }
  Vector tangent_inverse_times(const Vector& v, const Vector& w) const override {
    return G::tangent_inverse_times(v, w);
  }
  Vector coadjoint(const Vector& v, const Vector& w) const override { return G::coadjoint(v, w); }
  Vector tangent_inverse_transposed_change(const Vector& v, const Vector& w) const override {
    return G::tangent_inverse_transposed_change(v, w);
  }
  Vector adjoint_transposed_change(const Vector& v, const Vector& w) const override {
    return G::adjoint_transposed_change(v, w);
  }
  Matrix times_tangent(const Matrix& A, const Vector& v) const override {
    return G::times_tangent(Eigen::Matrix<T, 4, G::dimension>(A), v);
  }
  Vector represented(const Vector& q) const override {
    return stacked_represented(G::represented(element(q)));
  }
  Vector represented_identity() const override { return stacked_represented(Represented::identity()); }
  Vector representative(const Vector& r) const override {
    return stacked(G::representative(Represented::unstacked(r)));
  }
  T rotation_angle(const Vector& v) const override { return G::rotation_angle(v); }
  Eigen::VectorXd separation(const Vector& q, const Vector& p) const override {
    return G::separation(element(q), element(p));
  }
  T defect(const Vector& q) const override { return G::defect(element(q)); }
  Vector renormalized(const Vector& q) const override { return stacked(G::renormalized(element(q))); }

  std::vector<Vector> directions() const override {
    std::vector<Vector> all;
    for (const auto& v : Examples::directions()) all.push_back(v);
    return all;
  }
  std::vector<Vector> representations(const Vector& q) const override {
    std::vector<Vector> all;
    for (const auto& p : Examples::representations(element(q))) all.push_back(stacked(p));
    return all;
  }
  Vector represented_exp(const Vector& v) const override {
    return stacked_represented(Examples::represented_exp(v));
  }
  Vector represented_product(const Vector& a, const Vector& b) const override {
    return stacked_represented(
        Examples::represented_product(Represented::unstacked(a), Represented::unstacked(b)));
  }

  Vector through_half_precision(const Vector& q) const override {
    return through<std::conditional_t<std::same_as<T, double>, float, double>>(q);
  }
  Vector through_extended(const Vector& q) const override { return through<Extended>(q); }
  Eigen::VectorXd in_double(const Vector& q) const override {
    return Doubles::stacked(G::template cast<double>(element(q)));
  }

  const AnyGroup<double>& doubles() const override { return any_group<Doubles>(); }
  Eigen::MatrixXd exp_by_jets(const Eigen::VectorXd& v) const override {
    if constexpr (std::same_as<T, double>)
      return derivatives(
          Jets::log(Jets::compose(Jets::inverse(Jets::exp(constant(v))), Jets::exp(varied(v)))));
    else
      return doubles().exp_by_jets(v);
  }
  Eigen::MatrixXd conjugate_by_jets(const Eigen::VectorXd& w) const override {
    if constexpr (std::same_as<T, double>) {
      const auto delta = varied(zero());
      return derivatives(Jets::log(
          Jets::compose(Jets::compose(Jets::exp(delta), Jets::exp(constant(w))), Jets::exp(-delta))));
    } else {
      return doubles().conjugate_by_jets(w);
    }
  }
  Eigen::MatrixXd log_exp_by_jets() const override {
    if constexpr (std::same_as<T, double>)
      return derivatives(Jets::log(Jets::exp(varied(zero()))));
    else
      return doubles().log_exp_by_jets();
  }
  Eigen::MatrixXd tangent_by_jets() const override {
    if constexpr (std::same_as<T, double>)
      return derivatives(Jets::tangent(varied(zero())));
    else
      return doubles().tangent_by_jets();
  }
  Eigen::MatrixXd tangent_inverse_by_jets() const override {
    if constexpr (std::same_as<T, double>)
      return derivatives(Jets::tangent_inverse(varied(zero())));
    else
      return doubles().tangent_inverse_by_jets();
  }

 private:
  static constexpr int m = G::dimension;
  using Jet = ceres::Jet<double, m>;
  using Jets = typename G::template rebind<Jet>;

  static typename G::Element element(const Vector& q) { return G::unstacked(q); }
  static Vector stacked(const typename G::Element& q) { return G::stacked(q); }
  static Vector stacked_represented(const typename Represented::Element& r) {
    return Represented::stacked(r);
  }
  template <class U>
  static Vector through(const Vector& q) {
    using Other = typename G::template rebind<U>;
    return stacked(Other::template cast<T>(G::template cast<U>(element(q))));
  }

  static Eigen::VectorXd zero() { return Eigen::VectorXd::Zero(m); }
  static typename Jets::Tangent constant(const Eigen::VectorXd& v) {
    typename Jets::Tangent x;
    for (int i = 0; i < m; ++i) x(i) = Jet(v(i));
    return x;
  }
  // v + delta, the m components of delta being the variables of the Jets.
  static typename Jets::Tangent varied(const Eigen::VectorXd& v) {
    typename Jets::Tangent x;
    for (int i = 0; i < m; ++i) x(i) = Jet(v(i), i);
    return x;
  }
  // Row i: the m derivatives of component i.
  template <class Derived>
  static Eigen::MatrixXd derivatives(const Eigen::MatrixBase<Derived>& jets) {
    Eigen::MatrixXd d(jets.size(), m);
    for (Eigen::Index i = 0; i < jets.size(); ++i)
      d.row(i) = jets(i % jets.rows(), i / jets.rows()).v.transpose();
    return d;
  }
};

template <LieGroup G>
const AnyGroup<typename G::Scalar>& any_group() {
  static const HeldGroup<G> group;
  return group;
}

}  // namespace liebench
