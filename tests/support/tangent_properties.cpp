#include "tests/support/lie_group_properties.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace liebench {

template <class T>
std::vector<Property<T>> tangent_properties() {
  return {{"TangentIsTheDerivativeOfExpByJets",
           [](const GroupSamples<T>& S) {
             const AnyGroup<T>& G = S.group();
             // exp(v)^{-1} exp(v + delta) = exp(T(v) delta + O(delta^2)), in double for every scalar of G.
             std::vector<double> angles = S.angles();
             for (const double beyond_pi : {3.3, 5.0, 6.2}) angles.push_back(beyond_pi);
             for (const double angle : angles)
               for (const auto& v : GroupSamples<double>(G.doubles()).tangents(angle)) {
                 const Eigen::MatrixXd tangent = G.tangent(v.template cast<T>()).template cast<double>();
                 // The derivative of the rotation matrix is known to eps |v|.
                 EXPECT_LE((G.exp_by_jets(v) - tangent).norm(),
                           4 * S.few * 2.3e-16 * (1 + angle) * (1 + v.norm()))
                     << angle;
               }
           }},

          {"TangentIsTheDerivativeOfExpByDifferences",
           [](const GroupSamples<T>& S) {
             const AnyGroup<T>& G = S.group();
             // Central differences of order 4: error d^4 |f^(5)| / 30 + (3/2) noise / d, noise of a few eps; both are of
             // size eps^(4/5) at d = eps^(1/5).
             const double d = std::pow(S.eps(), 0.2);
             const double tolerance = 8 * S.few * std::pow(S.eps(), 0.8);
             for (const double angle : {1e-9, 0.3, 0.4999, 0.5001, 1.0, 1.9999, 2.0001, 3.0})
               for (const auto& v : S.tangents(T(angle))) {
                 const auto back = G.inverse(G.exp(v));
                 const auto matrix = G.tangent(v);
                 for (int i = 0; i < G.dimension(); ++i) {
                   const auto at = [&](double s) {
                     auto w = v;
                     w(i) += T(s);
                     return G.log(G.compose(back, G.exp(w)));
                   };
                   const typename GroupSamples<T>::Vector difference =
                       (T(8.0) * (at(d) - at(-d)) - (at(2 * d) - at(-2 * d))) / T(12.0 * d);
                   EXPECT_LE(S.length(difference - matrix.col(i)), tolerance * (1 + S.length(v))) << angle;
                 }
               }
           }},

          {"TangentIsItsSeries",
           [](const GroupSamples<T>& S) {
             const AnyGroup<T>& G = S.group();
             // The series cancels by the factor e^|v|.
             for (const double angle : S.angles())
               for (const auto& v : S.tangents(T(angle)))
                 EXPECT_LE(S.length(G.tangent(v) - S.tangent_series(v)),
                           S.few * S.eps() * std::exp(angle) * (1 + S.length(v)))
                     << angle;
           }},

          {"TangentInverseIsTheInverse",
           [](const GroupSamples<T>& S) {
             const AnyGroup<T>& G = S.group();
             std::vector<double> angles = S.angles();
             for (const double beyond_pi : {3.2, 4.0, 5.0, 6.0, 6.2}) angles.push_back(beyond_pi);
             const double two_pi = 2 * to_double(S.pi());
             for (const double angle : angles)
               for (const auto& v : S.tangents(T(angle))) {
                 const auto product = (G.tangent(v) * G.tangent_inverse(v)).eval();
                 // T^{-1} has a pole at 2 pi: its entries grow as the inverse of the distance, and their error, from
                 // the rounding of the angle, as the square.
                 const double pole = 1 + angle / (two_pi - angle);
                 EXPECT_LE(S.length(product - S.unit_matrix(G.dimension())),
                           2 * S.few * S.eps() * pole * pole * (1 + S.length(v)))
                     << angle;
               }
           }},

          {"TangentLeavesItsOwnArgument",
           [](const GroupSamples<T>& S) {
             const AnyGroup<T>& G = S.group();
             const double underflow = 64 * std::numeric_limits<double>::denorm_min();
             for (const double angle : {1e-300, 1e-160, 1e-9, 0.4, 1.1, 2.6, 3.1, 5.0}) {
               for (const auto& v : S.tangents(T(angle))) {
                 const double tolerance = S.few * S.eps() * S.length(v) * (1 + angle) + underflow;
                 EXPECT_LE(S.length(G.tangent(v) * v - v), tolerance) << angle;
                 EXPECT_LE(S.length(G.tangent_inverse(v) * v - v), 8 * tolerance) << angle;
               }
             }
           }},

          {"TangentAtTinyVectorsHasTheLinearTermOnly",
           [](const GroupSamples<T>& S) {
             const AnyGroup<T>& G = S.group();
             for (const double angle : {1e-300, 1e-160, 1e-40})
               for (const auto& v : S.tangents(T(angle))) {
                 // What is beyond the linear term is 1e-80 and less.
                 EXPECT_LE(S.length(G.tangent(v) - (S.unit_matrix(G.dimension()) - G.ad(v) * T(0.5))), 1e-79);
                 EXPECT_LE(S.length(G.tangent_inverse(v) - (S.unit_matrix(G.dimension()) + G.ad(v) * T(0.5))),
                           1e-79);
               }
           }},

          {"TimesTangentIsTheProductWithTheMatrix",
           [](const GroupSamples<T>& S) {
             const AnyGroup<T>& G = S.group();
             typename GroupSamples<T>::Matrix A(4, G.dimension());
             for (int i = 0; i < A.rows(); ++i)
               for (int j = 0; j < A.cols(); ++j) A(i, j) = T(std::cos(3.0 * i + 7.0 * j + 0.1));
             for (const double angle : S.angles())
               for (const auto& v : S.tangents(T(angle)))
                 EXPECT_LE(S.length(G.times_tangent(A, v) - A * G.tangent(v)), S.few * S.eps() * S.length(A));
           }},

          {"TangentTimesIsTheProductWithTheMatrix",
           [](const GroupSamples<T>& S) {
             const AnyGroup<T>& G = S.group();
             const auto others = S.tangents(T(1.5));
             for (const double angle : S.angles())
               for (const auto& v : S.tangents(T(angle)))
                 for (const auto& w : others)
                   EXPECT_LE(S.length(G.tangent_times(v, w) - G.tangent(v) * w),
                             S.few * S.eps() * (1 + S.length(v)) * S.length(w))
                       << angle;
           }},

          {"TangentInverseTimesIsTheProductWithTheMatrix",
           [](const GroupSamples<T>& S) {
             const AnyGroup<T>& G = S.group();
             const auto others = S.tangents(T(1.5));
             for (const double angle : S.angles())
               for (const auto& v : S.tangents(T(angle)))
                 for (const auto& w : others)
                   EXPECT_LE(S.length(G.tangent_inverse_times(v, w) - G.tangent_inverse(v) * w),
                             S.few * S.eps() * (1 + S.length(v)) * S.length(w))
                       << angle;
           }},

          {"OperatorsOfMomentaAreTransposedMatrices",
           [](const GroupSamples<T>& S) {
             const AnyGroup<T>& G = S.group();
             const auto others = S.tangents(T(1.5));
             for (const double angle : S.angles())
               for (const auto& v : S.tangents(T(angle))) {
                 const auto ad = G.ad(v), inverse = G.tangent_inverse(v);
                 // Ad(exp(v~)) = exp(ad(v)) = I + ad(v) T(-v)
                 const auto beyond_unit = (ad * G.tangent(-v)).eval();
                 const double tolerance = S.few * S.eps() * (1 + S.length(v)) * (1 + angle);
                 for (const auto& w : others) {
                   const double size = tolerance * S.length(w);
                   EXPECT_LE(S.length(G.coadjoint(v, w) - ad.transpose() * w), size) << angle;
                   EXPECT_LE(
                       S.length(G.tangent_inverse_transposed_change(v, w) - (inverse.transpose() * w - w)),
                       size)
                       << angle;
                   EXPECT_LE(S.length(G.adjoint_transposed_change(v, w) - beyond_unit.transpose() * w), size)
                       << angle;
                   // A change is known to its own round-off.
                   if (angle < 1e-3) {
                     EXPECT_LE(S.length(G.tangent_inverse_transposed_change(v, w) +
                                        G.tangent_inverse_transposed_change(-v, w)),
                               S.length(v) * S.length(v) * S.length(w))
                         << angle;
                   }
                 }
               }
           }},

          {"DerivativesAtZeroAreFiniteAndRight",
           [](const GroupSamples<T>& S) {
             const AnyGroup<double>& D = S.group().doubles();
             // A norm or a division by the angle would make them NaN.
             const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(D.dimension(), D.dimension());
             EXPECT_EQ((D.log_exp_by_jets() - identity).norm(), 0.0);
             const Eigen::MatrixXd tangent = D.tangent_by_jets(), inverse = D.tangent_inverse_by_jets();
             for (int i = 0; i < D.dimension(); ++i) {
               const Eigen::MatrixXd half = D.ad(identity.col(i)) * 0.5;
               const Eigen::Map<const Eigen::VectorXd> entries(half.data(), half.size());
               EXPECT_EQ((tangent.col(i) + entries).norm(), 0.0);
               EXPECT_EQ((inverse.col(i) - entries).norm(), 0.0);
             }
           }},
          {"RepresentedKeepsTheIdentity",
           [](const GroupSamples<T>& S) {
             const AnyGroup<T>& G = S.group();
             EXPECT_EQ(S.distance(G.represented(G.identity()), G.represented_identity()), 0.0);
           }},

          {"RepresentedKeepsProductsAndInverses",
           [](const GroupSamples<T>& S) {
             const AnyGroup<T>& G = S.group();
             // A quaternion that is off the group by the roundings of 50 products, too, represents what is off by as much.
             const auto all = S.elements();
             for (std::size_t i = 0; i + 5 < all.size(); ++i) {
               const auto &a = all[i], &b = all[i + 5];
               const double tolerance =
                   50 * S.few * S.eps() * (S.scale(G.represented(a)) + S.scale(G.represented(b)));
               const auto product = G.represented_product(G.represented(a), G.represented(b));
               EXPECT_LE(S.distance(G.represented(G.compose(a, b)), product), tolerance);
               const auto unit = G.represented_product(G.represented(a), G.represented(G.inverse(a)));
               EXPECT_LE(S.distance(unit, G.represented_identity()), tolerance);
             }
           }},

          {"RepresentedOfExpIsKnown",
           [](const GroupSamples<T>& S) {
             const AnyGroup<T>& G = S.group();
             for (const double angle : S.angles())
               for (const auto& v : S.tangents(T(angle))) {
                 // Series cancel by the factor e^angle.
                 const double tolerance = S.few * S.eps() * std::exp(angle) * (1 + S.length(v));
                 EXPECT_LE(S.distance(G.represented(G.exp(v)), G.represented_exp(v)), tolerance) << angle;
               }
           }},

          {"RepresentativeRepresentsWhatItIsOf",
           [](const GroupSamples<T>& S) {
             const AnyGroup<T>& G = S.group();
             for (const auto& q : S.elements()) {
               const double tolerance = 50 * S.few * S.eps() * S.scale(q);
               const auto r = G.represented(q);
               EXPECT_LE(S.distance(G.represented(G.representative(r)), r), tolerance);
               EXPECT_LE(S.distance(S.representation(G.representative(r), q), q), tolerance);
             }
           }},

          {"AllRepresentationsAreOneElement", [](const GroupSamples<T>& S) {
             const AnyGroup<T>& G = S.group();
             for (const auto& q : S.elements())
               for (const auto& p : G.representations(q)) {
                 EXPECT_EQ(S.distance(G.represented(p), G.represented(q)), 0.0);
                 EXPECT_EQ(S.length(G.log(p) - G.log(q)), 0.0);
                 EXPECT_EQ(G.separation(q, p).norm(), 0.0);
                 // And one element beside it is as far from the one as from the other.
                 const auto beside = G.compose(q, G.exp(S.tangents(T(0.01))[1]));
                 EXPECT_EQ((G.separation(p, beside) - G.separation(q, beside)).norm(), 0.0);
               }
           }}};
}
template std::vector<Property<double>> tangent_properties();
template std::vector<Property<Extended>> tangent_properties();

}  // namespace liebench
