#pragma once

#include <Eigen/Core>
#include <vector>

#include "groups/extended.h"
#include "tests/support/any_group.h"

namespace liebench {

// The samples and measures of the property tests for a group.
//
// Tolerances are counted in eps, the unit of the group's scalar, times a scale of the data. The constants
// come from a count of roundings: an element is a sum of some four products of numbers that are each the
// result of some four operations, so that `few` = 16 bounds one operation of a group, and n operations make n
// few. A wrong sign or coefficient is an error of the size of the data.
template <class T>
class GroupSamples {
 public:
  using Vector = typename AnyGroup<T>::Vector;
  using Matrix = typename AnyGroup<T>::Matrix;
  static constexpr double few = 16.0;

  explicit GroupSamples(const AnyGroup<T>& group) : group_(group) {}
  const AnyGroup<T>& group() const { return group_; }

  static double eps();
  // pi, rounded to the scalar.
  static T pi();
  // Euclidean length as a double, without underflow of the squares.
  template <class Derived>
  static double length(const Eigen::MatrixBase<Derived>& v) {
    return length_of(v.template cast<double>());
  }
  // ||p - q||_F of the representations.
  static double distance(const Vector& p, const Vector& q) { return length(p - q); }
  // What round-off in q is relative to: entries of size 1 even where the element is close to zero.
  static double scale(const Vector& q) { return 1.0 + length(q); }
  // Angles below pi, on both sides of the places (1/2, 2) where series and closed forms meet.
  static std::vector<double> angles();
  static Matrix unit_matrix(Eigen::Index size);

  // The representation of q next to `near`: exp o log may change it to another.
  Vector representation(const Vector& q, const Vector& near) const;
  // Every example direction, turned into a vector of this rotation angle, or of this length where it does not
  // turn anything.
  std::vector<Vector> tangents(const T& angle) const;
  // Elements all over the group: running products of exponentials.
  std::vector<Vector> elements() const;
  // e^{ad(v)} w = sum_k ad(v)^k w / k!, for |v| <= 4: the last term is below 4^60 / 60! = 2e-46.
  Vector exponential_of_ad(const Vector& v, const Vector& w) const;
  // sum_{k >= 0} (-1)^k / (k+1)! ad(v)^k, for |v| <= 4.
  Matrix tangent_series(const Vector& v) const;

 private:
  static double length_of(const Eigen::MatrixXd& v);
  const AnyGroup<T>& group_;
};

extern template class GroupSamples<double>;
extern template class GroupSamples<Extended>;

// The same samples as elements and vectors of G.
template <LieGroup G>
struct LieGroupSamples : GroupSamples<typename G::Scalar> {
  using T = typename G::Scalar;
  static std::vector<typename G::Tangent> tangents(const T& angle) {
    std::vector<typename G::Tangent> all;
    for (const auto& v : GroupSamples<T>(any_group<G>()).tangents(angle)) all.push_back(v);
    return all;
  }
  static std::vector<typename G::Element> elements() {
    std::vector<typename G::Element> all;
    for (const auto& q : GroupSamples<T>(any_group<G>()).elements()) all.push_back(G::unstacked(q));
    return all;
  }
};

}  // namespace liebench
