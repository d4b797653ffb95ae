#include "tests/support/lie_group_properties.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace liebench {

template <class T>
std::vector<Property<T>> group_properties() {
  return {
      {"IdentityIsNeutral",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         for (const auto& q : S.elements()) {
           EXPECT_EQ(S.distance(G.compose(q, G.identity()), q), 0.0);
           EXPECT_EQ(S.distance(G.compose(G.identity(), q), q), 0.0);
         }
       }},

      {"CompositionIsAssociative",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         const auto all = S.elements();
         for (std::size_t i = 0; i + 8 < all.size(); ++i) {
           const auto &a = all[i], &b = all[i + 5], &c = all[i + 8];
           const auto left = G.compose(G.compose(a, b), c), right = G.compose(a, G.compose(b, c));
           EXPECT_LE(S.distance(left, right), 4 * S.few * S.eps() * (S.scale(a) + S.scale(b) + S.scale(c)));
         }
       }},

      {"InverseUndoesComposition",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         // The samples themselves have left the group by the roundings of the (at most 50) products they came from.
         for (const auto& q : S.elements()) {
           const double tolerance = 50 * S.few * S.eps() * S.scale(q);
           EXPECT_LE(S.distance(G.compose(q, G.inverse(q)), G.identity()), tolerance);
           EXPECT_LE(S.distance(G.compose(G.inverse(q), q), G.identity()), tolerance);
         }
       }},

      {"CompositionDoesNotCommuteUnlessTheGroupSaysSo",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         double largest = 0;
         const auto all = S.tangents(T(1.0));
         for (const auto& v : all)
           for (const auto& w : all)
             largest =
                 std::max(largest, S.distance(G.compose(G.exp(v), G.exp(w)), G.compose(G.exp(w), G.exp(v))));
         if (G.commutative()) {
           EXPECT_EQ(largest, 0.0);
         } else {
           EXPECT_GT(largest, 0.1);
         }
       }},
      {"CommutatorIsAntisymmetric",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         const auto all = S.tangents(T(1.5));
         for (const auto& v : all)
           for (const auto& w : all) {
             const double tolerance = S.few * S.eps() * S.length(v) * S.length(w);
             EXPECT_LE(S.length(G.commutator(v, w) + G.commutator(w, v)), tolerance);
           }
       }},

      {"CommutatorObeysTheJacobiIdentity",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         const auto all = S.tangents(T(1.5));
         for (std::size_t i = 0; i + 5 < all.size(); ++i) {
           const auto &u = all[i], &v = all[i + 3], &w = all[i + 5];
           const auto sum = (G.commutator(u, G.commutator(v, w)) + G.commutator(v, G.commutator(w, u)) +
                             G.commutator(w, G.commutator(u, v)))
                                .eval();
           EXPECT_LE(S.length(sum), 4 * S.few * S.eps() * S.length(u) * S.length(v) * S.length(w));
         }
       }},

      {"AdIsTheMatrixOfTheCommutator",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         const auto all = S.tangents(T(1.5));
         for (const auto& v : all)
           for (const auto& w : all)
             EXPECT_LE(S.length(G.ad(v) * w - G.commutator(v, w)),
                       S.few * S.eps() * S.length(v) * S.length(w));
       }},

      {"CommutatorVanishesExactlyWhereTheGroupCommutes",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         double largest = 0;
         const auto all = S.tangents(T(1.0));
         for (const auto& v : all)
           for (const auto& w : all) largest = std::max(largest, S.length(G.commutator(v, w)));
         EXPECT_EQ(largest == 0.0, G.commutative());
       }},

      {"ConjugationIsTheExponentialOfAd",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         // exp(v) exp(w) exp(-v) = exp(Ad w), Ad = e^{ad(v)}; its series cancels by the factor e^|v|.
         const auto small = S.tangents(T(0.8));
         for (const double angle : {0.01, 0.6, 1.0, 2.2})
           for (const auto& v : S.tangents(T(angle)))
             for (const auto& w : small) {
               const auto q = G.compose(G.compose(G.exp(v), G.exp(w)), G.exp(-v));
               const double tolerance =
                   4 * S.few * S.eps() *
                   (S.scale(G.exp(v)) + std::exp(angle) * (1 + S.length(v)) * S.length(w));
               EXPECT_LE(S.length(G.log(q) - S.exponential_of_ad(v, w)), tolerance) << angle;
             }
       }},

      {"AdIsTheDerivativeOfConjugation", [](const GroupSamples<T>& S) {
         const AnyGroup<double>& D = S.group().doubles();
         // d/ddelta log(exp(delta) exp(w) exp(-delta)) at delta = 0 is -ad(w).
         for (const auto& w : GroupSamples<double>(D).tangents(0.9))
           EXPECT_LE((D.conjugate_by_jets(w) + D.ad(w)).norm(), 16 * S.few * 2.3e-16 * w.norm());
       }}};
}
template std::vector<Property<double>> group_properties();
template std::vector<Property<Extended>> group_properties();

}  // namespace liebench
