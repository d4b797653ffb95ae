#pragma once

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <concepts>
#include <limits>
#include <vector>

#include "groups/extended.h"
#include "groups/lie_group.h"
#include "tests/support/lie_group_examples.h"

// Property tests of a Lie group, templated on the concept of groups/lie_group.h: the axioms, exp and log, ad,
// the tangent operator against analysis, differences and Jets, and what keeps an element in the group. A new
// group joins with
//
//   #include "tests/support/lie_group_properties.h"
//   using Groups = ::testing::Types<SE3<double>, SE3<Extended>>;
//   INSTANTIATE_TYPED_TEST_SUITE_P(SE3, LieGroupProperties, Groups);
//
// inside namespace liebench, and, where it has delicate places or several representations of an element, with a
// specialisation of LieGroupExamples (lie_group_examples.h). Scalars: double and Extended. Of the group's other scalars the suite
// asks for ceres::Jet<double, m> and for double.
//
// Tolerances are counted in eps, the unit of the group's scalar, times a scale of the data. The constants
// come from a count of roundings: an element is a sum of some four products of numbers that are each the
// result of some four operations, so that `few` = 16 bounds one operation of a group, and n operations make n
// few. A wrong sign or coefficient is an error of the size of the data.
//
// Matrix-vector products are lazyProduct() here: Eigen 3.4 makes the result of an ordinary one by
// Matrix(rows, cols), which for two rows of dd_real does not compile (dd_real(long) is ambiguous).

namespace liebench {

// The samples and measures of the suite for the group G.
template <LieGroup G>
struct LieGroupSamples {
  using T = typename G::Scalar;
  using Element = typename G::Element;
  using Tangent = typename G::Tangent;
  using TangentMatrix = typename G::TangentMatrix;
  static constexpr int m = G::dimension;
  static constexpr double few = 16.0;

  static double eps() { return to_double(Eigen::NumTraits<T>::epsilon()); }

  // pi, rounded to the scalar.
  static T pi() {
    if constexpr (std::same_as<T, Extended>) {
      return dd_real::_pi;
    } else {
      return T(3.14159265358979323846);
    }
  }

  // Euclidean length as a double, without underflow of the squares.
  template <class Derived>
  static double length(const Eigen::MatrixBase<Derived>& v) {
    const auto doubles = v.template cast<double>().eval();
    const double largest = doubles.template lpNorm<Eigen::Infinity>();
    return largest > 0.0 ? largest * (doubles / largest).norm() : largest;
  }
  // ||p - q||_F of the representations.
  static double distance(const Element& p, const Element& q) {
    return length((G::stacked(p) - G::stacked(q)).eval());
  }
  // What round-off in q is relative to: entries of size 1 even where the element is close to zero.
  static double scale(const Element& q) { return 1.0 + length(G::stacked(q)); }

  // All representations of q, q itself first, and the one next to `near`, which exp o log may change to another.
  static std::vector<Element> representations(const Element& q) {
    return LieGroupExamples<G>::representations(q);
  }
  static Element representation(const Element& q, const Element& near) {
    Element next = q;
    for (const Element& p : representations(q))
      if (distance(p, near) < distance(next, near)) next = p;
    return next;
  }

  // Every example direction, turned into a vector of this rotation angle, or of this length where it does not
  // turn anything.
  static std::vector<Tangent> tangents(const T& angle) {
    std::vector<Tangent> all;
    for (const Tangent& d : LieGroupExamples<G>::directions()) {
      const T turn = G::rotation_angle(d);
      const T unit = turn > 0.0 ? turn : T(d.norm());
      all.push_back(d * T(angle / unit));
    }
    return all;
  }

  // Elements all over the group: running products of exponentials.
  static std::vector<Element> elements() {
    std::vector<Element> all{G::identity()};
    for (const double angle : {0.4, 1.7, 2.9}) {
      Element q = G::identity();
      for (const Tangent& v : tangents(T(angle))) {
        q = G::compose(q, G::exp(v));
        all.push_back(q);
      }
    }
    return all;
  }

  // Angles below pi, on both sides of the places (1/2, 2) where series and closed forms meet.
  static std::vector<double> angles() {
    return {1e-9, 1e-5, 1e-2, 0.1, 0.3, 0.4999, 0.5001, 1.0, 1.5, 1.9999, 2.0001, 2.5, 3.0, 3.1};
  }

  // e^{ad(v)} w = sum_k ad(v)^k w / k!, for |v| <= 4: the last term is below 4^60 / 60! = 2e-46.
  static Tangent exponential_of_ad(const Tangent& v, const Tangent& w) {
    Tangent sum = w, term = w;
    for (int k = 1; k <= 60; ++k) {
      term = G::commutator(v, term) / T(double(k));
      sum += term;
    }
    return sum;
  }

  // sum_{k >= 0} (-1)^k / (k+1)! ad(v)^k, for |v| <= 4.
  static TangentMatrix tangent_series(const Tangent& v) {
    const TangentMatrix minus_ad = -G::ad(v);
    TangentMatrix sum = TangentMatrix::Identity(), term = TangentMatrix::Identity();
    for (int k = 1; k <= 60; ++k) {
      term = TangentMatrix(term * minus_ad) / T(double(k + 1));
      sum += term;
    }
    return sum;
  }

  using Jet = ceres::Jet<double, m>;
  using Jets = typename G::template rebind<Jet>;
  using Doubles = typename G::template rebind<double>;

  // v + delta, the m components of delta being the variables of the Jets.
  static typename Jets::Tangent varied(const typename Doubles::Tangent& v) {
    typename Jets::Tangent x;
    for (int i = 0; i < m; ++i) x(i) = Jet(v(i), i);
    return x;
  }
  // Row i: the m derivatives of component i.
  template <class Derived>
  static Eigen::MatrixXd derivatives(const Eigen::MatrixBase<Derived>& jets) {
    const auto column = jets.eval();
    Eigen::MatrixXd d(column.size(), m);
    for (Eigen::Index i = 0; i < column.size(); ++i) d.row(i) = column.reshaped()(i).v.transpose();
    return d;
  }
};

template <class G>
class LieGroupProperties : public ::testing::Test {};

TYPED_TEST_SUITE_P(LieGroupProperties);

// --- the group -------------------------------------------------------------------------------------------

TYPED_TEST_P(LieGroupProperties, IdentityIsNeutral) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  for (const auto& q : S::elements()) {
    EXPECT_EQ(S::distance(G::compose(q, G::identity()), q), 0.0);
    EXPECT_EQ(S::distance(G::compose(G::identity(), q), q), 0.0);
  }
}

TYPED_TEST_P(LieGroupProperties, CompositionIsAssociative) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  const auto all = S::elements();
  for (std::size_t i = 0; i + 8 < all.size(); ++i) {
    const auto &a = all[i], &b = all[i + 5], &c = all[i + 8];
    const auto left = G::compose(G::compose(a, b), c), right = G::compose(a, G::compose(b, c));
    EXPECT_LE(S::distance(left, right), 4 * S::few * S::eps() * (S::scale(a) + S::scale(b) + S::scale(c)));
  }
}

TYPED_TEST_P(LieGroupProperties, InverseUndoesComposition) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  // The samples themselves have left the group by the roundings of the (at most 50) products they came from.
  for (const auto& q : S::elements()) {
    const double tolerance = 50 * S::few * S::eps() * S::scale(q);
    EXPECT_LE(S::distance(G::compose(q, G::inverse(q)), G::identity()), tolerance);
    EXPECT_LE(S::distance(G::compose(G::inverse(q), q), G::identity()), tolerance);
  }
}

TYPED_TEST_P(LieGroupProperties, CompositionDoesNotCommuteUnlessTheGroupSaysSo) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  double largest = 0;
  const auto all = S::tangents(typename G::Scalar(1.0));
  for (const auto& v : all)
    for (const auto& w : all)
      largest =
          std::max(largest, S::distance(G::compose(G::exp(v), G::exp(w)), G::compose(G::exp(w), G::exp(v))));
  if (G::commutative) {
    EXPECT_EQ(largest, 0.0);
  } else {
    EXPECT_GT(largest, 0.1);
  }
}

// --- exp and log -----------------------------------------------------------------------------------------

TYPED_TEST_P(LieGroupProperties, ExpOfZeroIsTheIdentity) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  const typename G::Tangent zero = G::Tangent::Constant(typename G::Scalar(0.0));
  EXPECT_EQ(S::distance(G::exp(zero), G::identity()), 0.0);
  EXPECT_EQ(S::length(G::log(G::identity())), 0.0);
}

TYPED_TEST_P(LieGroupProperties, ExpOfTheNegativeIsTheInverse) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  for (const double angle : S::angles())
    for (const auto& v : S::tangents(angle)) {
      const auto q = G::exp(v);
      EXPECT_LE(S::distance(G::exp(-v), G::inverse(q)), S::few * S::eps() * S::scale(q)) << angle;
    }
}

TYPED_TEST_P(LieGroupProperties, ExpIsAdditiveAlongADirection) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using T = typename G::Scalar;
  // exp is valid for every finite v: far beyond pi too. The arguments s v, t v and (s + t) v carry their own
  // roundings, of relative size eps.
  for (const double angle : {1e-300, 1e-160, 1e-9, 0.3, 0.7, 2.0, 3.1, 7.0, 40.0})
    for (const auto& v : S::tangents(T(angle)))
      for (const double s : {0.25, 1.0, -0.6})
        for (const double t : {0.5, 1.3}) {
          const auto sum = G::exp(v * T(T(s) + T(t)));
          const auto product = G::compose(G::exp(v * T(s)), G::exp(v * T(t)));
          EXPECT_LE(S::distance(product, sum), 2 * S::few * S::eps() * (S::scale(sum) + 3 * S::length(v)))
              << angle << ' ' << s << ' ' << t;
        }
}

TYPED_TEST_P(LieGroupProperties, LogUndoesExp) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  for (const double angle : S::angles())
    for (const auto& v : S::tangents(angle))
      EXPECT_LE(S::length((G::log(G::exp(v)) - v).eval()), S::few * S::eps() * S::length(v)) << angle;
}

TYPED_TEST_P(LieGroupProperties, LogUndoesExpOfTinyVectors) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using T = typename G::Scalar;
  // Relative to the vector as long as the scalar has its digits there: a product next to the smallest normal
  // number is known to a few denorm_min (the low part of a double-double underflows first).
  const double underflow = 16 * std::numeric_limits<double>::denorm_min();
  for (const double angle : {1e-300, 1e-160, 1e-150, 1e-100, 1e-20, 1e-9})
    for (const auto& v : S::tangents(T(angle)))
      EXPECT_LE(S::length((G::log(G::exp(v)) - v).eval()), S::few * S::eps() * S::length(v) + underflow)
          << angle;
}

TYPED_TEST_P(LieGroupProperties, LogUndoesExpUpToPi) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using T = typename G::Scalar;
  // No digit is lost near pi: the quaternion's real part is known to eps there, and so is the angle.
  for (const double gap : {1e-3, 1e-6, 1e-10, 1e-14})
    for (const auto& v : S::tangents(T(S::pi() - gap)))
      EXPECT_LE(S::length((G::log(G::exp(v)) - v).eval()), S::few * S::eps() * S::length(v)) << gap;
}

TYPED_TEST_P(LieGroupProperties, LogAtPiTurnsByPiAndGivesTheElement) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using T = typename G::Scalar;
  // The sign of the axis is free at pi, so that the vector is not that of before.
  for (const auto& v : S::tangents(S::pi())) {
    const auto q = G::exp(v), again = G::exp(G::log(q));
    const double tolerance = 2 * S::few * S::eps() * (1 + S::length(v));
    EXPECT_LE(S::distance(S::representation(again, q), q), tolerance);
    if (G::rotation_angle(v) > 0.0) {
      EXPECT_LE(std::abs(to_double(T(G::rotation_angle(G::log(q)) - S::pi()))), tolerance);
    }
  }
}

TYPED_TEST_P(LieGroupProperties, ExpUndoesLog) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  for (const auto& q : S::elements()) {
    // log sees the departure of q from the group, at most 50 products.
    EXPECT_LE(S::distance(S::representation(G::exp(G::log(q)), q), q), 50 * S::few * S::eps() * S::scale(q));
  }
}

TYPED_TEST_P(LieGroupProperties, LogTurnsByAtMostPi) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using T = typename G::Scalar;
  const T bound = S::pi() * T(1.0 + S::few * S::eps());
  for (const double angle : {3.0, 3.2, 4.0, 6.0, 6.3, 9.0, 100.0})
    for (const auto& v : S::tangents(T(angle)))
      EXPECT_TRUE(G::rotation_angle(G::log(G::exp(v))) <= bound) << angle;
}

TYPED_TEST_P(LieGroupProperties, RotationAngleIsHomogeneous) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using T = typename G::Scalar;
  for (const auto& v : S::tangents(T(1.0)))
    for (const double s : {-2.0, 1e-3, 0.7}) {
      const T expected = G::rotation_angle(v) * T(std::abs(s));
      EXPECT_LE(std::abs(to_double(T(G::rotation_angle(v * T(s)) - expected))),
                S::few * S::eps() * std::abs(s));
    }
}

// --- the Lie algebra -------------------------------------------------------------------------------------

TYPED_TEST_P(LieGroupProperties, CommutatorIsAntisymmetric) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  const auto all = S::tangents(typename G::Scalar(1.5));
  for (const auto& v : all)
    for (const auto& w : all) {
      const double tolerance = S::few * S::eps() * S::length(v) * S::length(w);
      EXPECT_LE(S::length((G::commutator(v, w) + G::commutator(w, v)).eval()), tolerance);
    }
}

TYPED_TEST_P(LieGroupProperties, CommutatorObeysTheJacobiIdentity) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  const auto all = S::tangents(typename G::Scalar(1.5));
  for (std::size_t i = 0; i + 5 < all.size(); ++i) {
    const auto &u = all[i], &v = all[i + 3], &w = all[i + 5];
    const auto sum = (G::commutator(u, G::commutator(v, w)) + G::commutator(v, G::commutator(w, u)) +
                      G::commutator(w, G::commutator(u, v)))
                         .eval();
    EXPECT_LE(S::length(sum), 4 * S::few * S::eps() * S::length(u) * S::length(v) * S::length(w));
  }
}

TYPED_TEST_P(LieGroupProperties, AdIsTheMatrixOfTheCommutator) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  const auto all = S::tangents(typename G::Scalar(1.5));
  for (const auto& v : all)
    for (const auto& w : all)
      EXPECT_LE(S::length((G::ad(v).lazyProduct(w) - G::commutator(v, w)).eval()),
                S::few * S::eps() * S::length(v) * S::length(w));
}

TYPED_TEST_P(LieGroupProperties, CommutatorVanishesExactlyWhereTheGroupCommutes) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  double largest = 0;
  const auto all = S::tangents(typename G::Scalar(1.0));
  for (const auto& v : all)
    for (const auto& w : all) largest = std::max(largest, S::length(G::commutator(v, w)));
  EXPECT_EQ(largest == 0.0, bool(G::commutative));
}

TYPED_TEST_P(LieGroupProperties, ConjugationIsTheExponentialOfAd) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using T = typename G::Scalar;
  // exp(v) exp(w) exp(-v) = exp(Ad w), Ad = e^{ad(v)}; its series cancels by the factor e^|v|.
  const auto small = S::tangents(T(0.8));
  for (const double angle : {0.01, 0.6, 1.0, 2.2})
    for (const auto& v : S::tangents(T(angle)))
      for (const auto& w : small) {
        const auto q = G::compose(G::compose(G::exp(v), G::exp(w)), G::exp(-v));
        const double tolerance = 4 * S::few * S::eps() *
                                 (S::scale(G::exp(v)) + std::exp(angle) * (1 + S::length(v)) * S::length(w));
        EXPECT_LE(S::length((G::log(q) - S::exponential_of_ad(v, w)).eval()), tolerance) << angle;
      }
}

TYPED_TEST_P(LieGroupProperties, AdIsTheDerivativeOfConjugation) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using J = typename S::Jets;
  // d/ddelta log(exp(delta) exp(w) exp(-delta)) at delta = 0 is -ad(w).
  const typename S::Doubles::Tangent zero = S::Doubles::Tangent::Zero();
  const auto delta = S::varied(zero);
  for (const auto& direction : LieGroupSamples<typename S::Doubles>::tangents(0.9)) {
    const typename J::Tangent w = direction.template cast<typename S::Jet>();
    // The conjugate of w itself, without log: differentiate w' in exp(w') = exp(delta) exp(w) exp(-delta).
    const auto q = J::compose(J::compose(J::exp(delta), J::exp(w)), J::exp(-delta));
    const Eigen::MatrixXd error = S::derivatives(J::log(q)) + S::Doubles::ad(direction);
    EXPECT_LE(error.norm(), 16 * S::few * 2.3e-16 * direction.norm());
  }
}

// --- the tangent operator --------------------------------------------------------------------------------

TYPED_TEST_P(LieGroupProperties, TangentIsTheDerivativeOfExpByJets) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using J = typename S::Jets;
  using D = typename S::Doubles;
  // exp(v)^{-1} exp(v + delta) = exp(T(v) delta + O(delta^2)), in double for every scalar of G.
  std::vector<double> angles = S::angles();
  for (const double beyond_pi : {3.3, 5.0, 6.2}) angles.push_back(beyond_pi);
  for (const double angle : angles)
    for (const auto& v : LieGroupSamples<D>::tangents(angle)) {
      const auto q = J::compose(J::inverse(J::exp(v.template cast<typename S::Jet>())), J::exp(S::varied(v)));
      const Eigen::MatrixXd error = S::derivatives(J::log(q)) -
                                    G::tangent(v.template cast<typename G::Scalar>()).template cast<double>();
      // The derivative of the rotation matrix is known to eps |v|.
      EXPECT_LE(error.norm(), 4 * S::few * 2.3e-16 * (1 + angle) * (1 + v.norm())) << angle;
    }
}

TYPED_TEST_P(LieGroupProperties, TangentIsTheDerivativeOfExpByDifferences) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using T = typename G::Scalar;
  // Central differences of order 4: error d^4 |f^(5)| / 30 + (3/2) noise / d, noise of a few eps; both are of
  // size eps^(4/5) at d = eps^(1/5).
  const double d = std::pow(S::eps(), 0.2);
  const double tolerance = 8 * S::few * std::pow(S::eps(), 0.8);
  for (const double angle : {1e-9, 0.3, 0.4999, 0.5001, 1.0, 1.9999, 2.0001, 3.0})
    for (const auto& v : S::tangents(T(angle))) {
      const auto back = G::inverse(G::exp(v));
      const auto matrix = G::tangent(v);
      for (int i = 0; i < S::m; ++i) {
        const auto at = [&](double s) -> typename G::Tangent {
          typename G::Tangent w = v;
          w(i) += T(s);
          return G::log(G::compose(back, G::exp(w)));
        };
        const typename G::Tangent difference =
            (T(8.0) * (at(d) - at(-d)) - (at(2 * d) - at(-2 * d))) / T(12.0 * d);
        EXPECT_LE(S::length((difference - matrix.col(i)).eval()), tolerance * (1 + S::length(v))) << angle;
      }
    }
}

TYPED_TEST_P(LieGroupProperties, TangentIsItsSeries) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using T = typename G::Scalar;
  // The series cancels by the factor e^|v|.
  for (const double angle : S::angles())
    for (const auto& v : S::tangents(T(angle)))
      EXPECT_LE(S::length((G::tangent(v) - S::tangent_series(v)).eval()),
                S::few * S::eps() * std::exp(angle) * (1 + S::length(v)))
          << angle;
}

TYPED_TEST_P(LieGroupProperties, TangentInverseIsTheInverse) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using T = typename G::Scalar;
  std::vector<double> angles = S::angles();
  for (const double beyond_pi : {3.2, 4.0, 5.0, 6.0, 6.2}) angles.push_back(beyond_pi);
  const double two_pi = 2 * to_double(S::pi());
  for (const double angle : angles)
    for (const auto& v : S::tangents(T(angle))) {
      const auto product = (G::tangent(v) * G::tangent_inverse(v)).eval();
      // T^{-1} has a pole at 2 pi: its entries grow as the inverse of the distance, and their error, from
      // the rounding of the angle, as the square.
      const double pole = 1 + angle / (two_pi - angle);
      EXPECT_LE(S::length((product - S::TangentMatrix::Identity()).eval()),
                2 * S::few * S::eps() * pole * pole * (1 + S::length(v)))
          << angle;
    }
}

TYPED_TEST_P(LieGroupProperties, TangentLeavesItsOwnArgument) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using T = typename G::Scalar;
  const double underflow = 64 * std::numeric_limits<double>::denorm_min();
  for (const double angle : {1e-300, 1e-160, 1e-9, 0.4, 1.1, 2.6, 3.1, 5.0}) {
    for (const auto& v : S::tangents(T(angle))) {
      const double tolerance = S::few * S::eps() * S::length(v) * (1 + angle) + underflow;
      EXPECT_LE(S::length((G::tangent(v).lazyProduct(v) - v).eval()), tolerance) << angle;
      EXPECT_LE(S::length((G::tangent_inverse(v).lazyProduct(v) - v).eval()), 8 * tolerance) << angle;
    }
  }
}

TYPED_TEST_P(LieGroupProperties, TangentAtTinyVectorsHasTheLinearTermOnly) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using T = typename G::Scalar;
  using Matrix = typename S::TangentMatrix;
  for (const double angle : {1e-300, 1e-160, 1e-40})
    for (const auto& v : S::tangents(T(angle))) {
      // What is beyond the linear term is 1e-80 and less.
      EXPECT_LE(S::length((G::tangent(v) - (Matrix::Identity() - G::ad(v) * T(0.5))).eval()), 1e-79);
      EXPECT_LE(S::length((G::tangent_inverse(v) - (Matrix::Identity() + G::ad(v) * T(0.5))).eval()), 1e-79);
    }
}

TYPED_TEST_P(LieGroupProperties, TimesTangentIsTheProductWithTheMatrix) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using T = typename G::Scalar;
  Eigen::Matrix<T, 4, S::m> A;
  for (int i = 0; i < A.rows(); ++i)
    for (int j = 0; j < A.cols(); ++j) A(i, j) = T(std::cos(3.0 * i + 7.0 * j + 0.1));
  for (const double angle : S::angles())
    for (const auto& v : S::tangents(T(angle)))
      EXPECT_LE(S::length((G::times_tangent(A, v) - A * G::tangent(v)).eval()),
                S::few * S::eps() * S::length(A));
}

TYPED_TEST_P(LieGroupProperties, DerivativesAtZeroAreFiniteAndRight) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using J = typename S::Jets;
  using D = typename S::Doubles;
  // A norm or a division by the angle would make them NaN.
  const typename D::Tangent zero = D::Tangent::Zero();
  const auto delta = S::varied(zero);
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(S::m, S::m);
  EXPECT_EQ((S::derivatives(J::log(J::exp(delta))) - identity).norm(), 0.0);
  const Eigen::MatrixXd tangent = S::derivatives(J::tangent(delta));
  const Eigen::MatrixXd inverse = S::derivatives(J::tangent_inverse(delta));
  for (int i = 0; i < S::m; ++i) {
    const typename D::TangentMatrix half = D::ad(identity.col(i)) * 0.5;
    EXPECT_EQ((tangent.col(i) + half.reshaped()).norm(), 0.0);
    EXPECT_EQ((inverse.col(i) - half.reshaped()).norm(), 0.0);
  }
}

// --- what an element stands for ----------------------------------------------------------------------------

TYPED_TEST_P(LieGroupProperties, RepresentedIsAGroupThatRepresentsItself) {
  using G = TypeParam;
  using R = typename G::Represented;
  static_assert(LieGroup<R> && std::same_as<typename R::Scalar, typename G::Scalar>);
  static_assert(std::same_as<typename R::Represented, R> && R::dimension == G::dimension);
  using Doubles = typename G::template rebind<double>;
  static_assert(std::same_as<typename R::template rebind<double>, typename Doubles::Represented>);
  EXPECT_EQ(LieGroupSamples<R>::distance(G::represented(G::identity()), R::identity()), 0.0);
}

TYPED_TEST_P(LieGroupProperties, RepresentedKeepsProductsAndInverses) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using R = LieGroupSamples<typename G::Represented>;
  using Examples = LieGroupExamples<G>;
  // A quaternion that is off the group by the roundings of 50 products, too, represents what is off by as much.
  const auto all = S::elements();
  for (std::size_t i = 0; i + 5 < all.size(); ++i) {
    const auto &a = all[i], &b = all[i + 5];
    const double tolerance =
        50 * S::few * S::eps() * (R::scale(G::represented(a)) + R::scale(G::represented(b)));
    const auto product = Examples::represented_product(G::represented(a), G::represented(b));
    EXPECT_LE(R::distance(G::represented(G::compose(a, b)), product), tolerance);
    const auto unit = Examples::represented_product(G::represented(a), G::represented(G::inverse(a)));
    EXPECT_LE(R::distance(unit, G::Represented::identity()), tolerance);
  }
}

TYPED_TEST_P(LieGroupProperties, RepresentedOfExpIsKnown) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using R = LieGroupSamples<typename G::Represented>;
  using T = typename G::Scalar;
  for (const double angle : S::angles())
    for (const auto& v : S::tangents(T(angle))) {
      // Series cancel by the factor e^angle.
      const double tolerance = S::few * S::eps() * std::exp(angle) * (1 + S::length(v));
      EXPECT_LE(R::distance(G::represented(G::exp(v)), LieGroupExamples<G>::represented_exp(v)), tolerance)
          << angle;
    }
}

TYPED_TEST_P(LieGroupProperties, RepresentativeRepresentsWhatItIsOf) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using R = LieGroupSamples<typename G::Represented>;
  for (const auto& q : S::elements()) {
    const double tolerance = 50 * S::few * S::eps() * S::scale(q);
    const auto r = G::represented(q);
    EXPECT_LE(R::distance(G::represented(G::representative(r)), r), tolerance);
    EXPECT_LE(S::distance(S::representation(G::representative(r), q), q), tolerance);
  }
}

TYPED_TEST_P(LieGroupProperties, AllRepresentationsAreOneElement) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using R = LieGroupSamples<typename G::Represented>;
  for (const auto& q : S::elements())
    for (const auto& p : S::representations(q)) {
      EXPECT_EQ(R::distance(G::represented(p), G::represented(q)), 0.0);
      EXPECT_EQ(S::length((G::log(p) - G::log(q)).eval()), 0.0);
      EXPECT_EQ(G::separation(q, p).norm(), 0.0);
      // And one element beside it is as far from the one as from the other.
      const auto beside = G::compose(q, G::exp(S::tangents(typename G::Scalar(0.01))[1]));
      EXPECT_EQ((G::separation(p, beside) - G::separation(q, beside)).norm(), 0.0);
    }
}

// --- distances, drift, scalars ---------------------------------------------------------------------------

TYPED_TEST_P(LieGroupProperties, SeparationIsTheLogarithmOfTheQuotient) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using T = typename G::Scalar;
  for (const double angle : {1e-3, 0.02, 0.05, 0.0706, 0.0708, 0.1, 0.5, 2.0, 3.1})
    for (const auto& v : S::tangents(T(angle)))
      for (const auto& q : S::elements()) {
        const auto error = (G::separation(q, G::compose(q, G::exp(v))) - v.template cast<double>()).eval();
        // A result in double, from elements that carry the round-off of up to 50 products.
        EXPECT_LE(error.norm(), S::few * (2.3e-16 * S::length(v) + 50 * S::eps() * S::scale(q))) << angle;
      }
}

TYPED_TEST_P(LieGroupProperties, SeparationOfTinyDistancesIsRelativelyExact) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using T = typename G::Scalar;
  // Next to the identity, whose entries are exact, at every size.
  for (const double angle : {1e-300, 1e-160, 1e-20, 1e-9, 1e-4}) {
    for (const auto& v : S::tangents(T(angle))) {
      const auto error = (G::separation(G::identity(), G::exp(v)) - v.template cast<double>()).eval();
      const double underflow = 16 * std::numeric_limits<double>::denorm_min();
      EXPECT_LE(S::length(error), S::few * 2.3e-16 * S::length(v) + underflow) << angle;
    }
  }
  // Anywhere else as far as the elements themselves are known: in extended precision to all digits of a
  // double down to distances of 1e-15.
  for (const double angle : {1e-15, 1e-12, 1e-9, 1e-5})
    for (const auto& v : S::tangents(T(angle)))
      for (const auto& q : S::elements()) {
        const auto error = (G::separation(q, G::compose(q, G::exp(v))) - v.template cast<double>()).eval();
        EXPECT_LE(error.norm(), S::few * (2.3e-16 * S::length(v) + 4 * S::eps() * S::scale(q))) << angle;
      }
}

TYPED_TEST_P(LieGroupProperties, SeparationOfAnElementFromItselfIsZero) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  for (const auto& q : S::elements()) EXPECT_EQ(G::separation(q, q).norm(), 0.0);
}

TYPED_TEST_P(LieGroupProperties, DefectOfExponentialsIsRoundOff) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using T = typename G::Scalar;
  EXPECT_TRUE(G::defect(G::identity()) == 0.0);
  for (const double angle : S::angles())
    for (const auto& v : S::tangents(T(angle))) EXPECT_LE(to_double(G::defect(G::exp(v))), S::few * S::eps());
  for (const auto& q : S::elements()) EXPECT_LE(to_double(G::defect(q)), 50 * S::few * S::eps());
}

TYPED_TEST_P(LieGroupProperties, RenormalizedSquaresTheDefect) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using T = typename G::Scalar;
  // Elements rounded to half of their digits: float for double, double for Extended.
  using Half = std::conditional_t<std::same_as<T, double>, float, double>;
  using HalfGroup = typename G::template rebind<Half>;
  double largest = 0;
  for (const auto& q : S::elements()) {
    const auto rounded = HalfGroup::template cast<T>(G::template cast<Half>(q));
    const double defect = to_double(G::defect(rounded));
    const auto repaired = G::renormalized(rounded);
    EXPECT_LE(to_double(G::defect(repaired)), defect * defect + S::few * S::eps());
    // The dual part of a dual quaternion moves in proportion to its size.
    EXPECT_LE(S::distance(repaired, rounded), (defect + S::few * S::eps()) * S::scale(q));
    largest = std::max(largest, defect);
  }
  if (largest > 0) {  // the sample was off the group, where one can be off it
    EXPECT_GT(largest, 1e4 * S::eps());
  }
}

TYPED_TEST_P(LieGroupProperties, CastKeepsTheElement) {
  using G = TypeParam;
  using S = LieGroupSamples<G>;
  using E = typename G::template rebind<Extended>;
  for (const auto& q : S::elements()) {
    const auto extended = G::template cast<Extended>(q);
    EXPECT_EQ(S::distance(E::template cast<typename G::Scalar>(extended), q), 0.0);
    const auto rounded = G::template cast<double>(q);
    EXPECT_EQ((S::Doubles::stacked(rounded) - G::stacked(q).template cast<double>()).norm(), 0.0);
  }
}

REGISTER_TYPED_TEST_SUITE_P(LieGroupProperties, IdentityIsNeutral, CompositionIsAssociative,
                            InverseUndoesComposition, CompositionDoesNotCommuteUnlessTheGroupSaysSo,
                            ExpOfZeroIsTheIdentity, ExpOfTheNegativeIsTheInverse,
                            ExpIsAdditiveAlongADirection, LogUndoesExp, LogUndoesExpOfTinyVectors,
                            LogUndoesExpUpToPi, LogAtPiTurnsByPiAndGivesTheElement, ExpUndoesLog,
                            LogTurnsByAtMostPi, RotationAngleIsHomogeneous, CommutatorIsAntisymmetric,
                            CommutatorObeysTheJacobiIdentity, AdIsTheMatrixOfTheCommutator,
                            CommutatorVanishesExactlyWhereTheGroupCommutes, ConjugationIsTheExponentialOfAd,
                            AdIsTheDerivativeOfConjugation, TangentIsTheDerivativeOfExpByJets,
                            TangentIsTheDerivativeOfExpByDifferences, TangentIsItsSeries,
                            TangentInverseIsTheInverse, TangentLeavesItsOwnArgument,
                            TangentAtTinyVectorsHasTheLinearTermOnly, TimesTangentIsTheProductWithTheMatrix,
                            DerivativesAtZeroAreFiniteAndRight, RepresentedIsAGroupThatRepresentsItself,
                            RepresentedKeepsProductsAndInverses, RepresentedOfExpIsKnown,
                            RepresentativeRepresentsWhatItIsOf, AllRepresentationsAreOneElement,
                            SeparationIsTheLogarithmOfTheQuotient, SeparationOfTinyDistancesIsRelativelyExact,
                            SeparationOfAnElementFromItselfIsZero, DefectOfExponentialsIsRoundOff,
                            RenormalizedSquaresTheDefect, CastKeepsTheElement);

}  // namespace liebench
