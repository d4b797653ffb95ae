#include "tests/support/lie_group_properties.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace liebench {

template <class T>
std::vector<Property<T>> exponential_properties() {
  return {
      {"ExpOfZeroIsTheIdentity",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         const auto zero = GroupSamples<T>::Vector::Constant(G.dimension(), T(0.0)).eval();
         EXPECT_EQ(S.distance(G.exp(zero), G.identity()), 0.0);
         EXPECT_EQ(S.length(G.log(G.identity())), 0.0);
       }},

      {"ExpOfTheNegativeIsTheInverse",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         for (const double angle : S.angles())
           for (const auto& v : S.tangents(angle)) {
             const auto q = G.exp(v);
             EXPECT_LE(S.distance(G.exp(-v), G.inverse(q)), S.few * S.eps() * S.scale(q)) << angle;
           }
       }},

      {"ExpIsAdditiveAlongADirection",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         // exp is valid for every finite v: far beyond pi too. The arguments s v, t v and (s + t) v carry their own
         // roundings, of relative size eps.
         for (const double angle : {1e-300, 1e-160, 1e-9, 0.3, 0.7, 2.0, 3.1, 7.0, 40.0})
           for (const auto& v : S.tangents(T(angle)))
             for (const double s : {0.25, 1.0, -0.6})
               for (const double t : {0.5, 1.3}) {
                 const auto sum = G.exp(v * T(T(s) + T(t)));
                 const auto product = G.compose(G.exp(v * T(s)), G.exp(v * T(t)));
                 EXPECT_LE(S.distance(product, sum), 2 * S.few * S.eps() * (S.scale(sum) + 3 * S.length(v)))
                     << angle << ' ' << s << ' ' << t;
               }
       }},

      {"LogUndoesExp",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         for (const double angle : S.angles())
           for (const auto& v : S.tangents(angle))
             EXPECT_LE(S.length(G.log(G.exp(v)) - v), S.few * S.eps() * S.length(v)) << angle;
       }},

      {"LogUndoesExpOfTinyVectors",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         // Relative to the vector as long as the scalar has its digits there: a product next to the smallest normal
         // number is known to a few denorm_min (the low part of a double-double underflows first).
         const double underflow = 16 * std::numeric_limits<double>::denorm_min();
         for (const double angle : {1e-300, 1e-160, 1e-150, 1e-100, 1e-20, 1e-9})
           for (const auto& v : S.tangents(T(angle)))
             EXPECT_LE(S.length(G.log(G.exp(v)) - v), S.few * S.eps() * S.length(v) + underflow) << angle;
       }},

      {"LogUndoesExpUpToPi",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         // No digit is lost near pi: the quaternion's real part is known to eps there, and so is the angle.
         for (const double gap : {1e-3, 1e-6, 1e-10, 1e-14})
           for (const auto& v : S.tangents(T(S.pi() - gap)))
             EXPECT_LE(S.length(G.log(G.exp(v)) - v), S.few * S.eps() * S.length(v)) << gap;
       }},

      {"LogAtPiTurnsByPiAndGivesTheElement",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         // The sign of the axis is free at pi, so that the vector is not that of before.
         for (const auto& v : S.tangents(S.pi())) {
           const auto q = G.exp(v), again = G.exp(G.log(q));
           const double tolerance = 2 * S.few * S.eps() * (1 + S.length(v));
           EXPECT_LE(S.distance(S.representation(again, q), q), tolerance);
           if (G.rotation_angle(v) > 0.0) {
             EXPECT_LE(std::abs(to_double(T(G.rotation_angle(G.log(q)) - S.pi()))), tolerance);
           }
         }
       }},

      {"ExpUndoesLog",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         for (const auto& q : S.elements()) {
           // log sees the departure of q from the group, at most 50 products.
           EXPECT_LE(S.distance(S.representation(G.exp(G.log(q)), q), q), 50 * S.few * S.eps() * S.scale(q));
         }
       }},

      {"LogTurnsByAtMostPi",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         const T bound = S.pi() * T(1.0 + S.few * S.eps());
         for (const double angle : {3.0, 3.2, 4.0, 6.0, 6.3, 9.0, 100.0})
           for (const auto& v : S.tangents(T(angle)))
             EXPECT_TRUE(G.rotation_angle(G.log(G.exp(v))) <= bound) << angle;
       }},

      {"RotationAngleIsHomogeneous",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         for (const auto& v : S.tangents(T(1.0)))
           for (const double s : {-2.0, 1e-3, 0.7}) {
             const T expected = G.rotation_angle(v) * T(std::abs(s));
             EXPECT_LE(std::abs(to_double(T(G.rotation_angle(v * T(s)) - expected))),
                       S.few * S.eps() * std::abs(s));
           }
       }},
      {"SeparationIsTheLogarithmOfTheQuotient",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         for (const double angle : {1e-3, 0.02, 0.05, 0.0706, 0.0708, 0.1, 0.5, 2.0, 3.1})
           for (const auto& v : S.tangents(T(angle)))
             for (const auto& q : S.elements()) {
               const auto error =
                   (G.separation(q, G.compose(q, G.exp(v))) - v.template cast<double>()).eval();
               // A result in double, from elements that carry the round-off of up to 50 products.
               EXPECT_LE(error.norm(), S.few * (2.3e-16 * S.length(v) + 50 * S.eps() * S.scale(q))) << angle;
             }
       }},

      {"SeparationOfTinyDistancesIsRelativelyExact",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         // Next to the identity, whose entries are exact, at every size.
         for (const double angle : {1e-300, 1e-160, 1e-20, 1e-9, 1e-4}) {
           for (const auto& v : S.tangents(T(angle))) {
             const auto error = (G.separation(G.identity(), G.exp(v)) - v.template cast<double>()).eval();
             const double underflow = 16 * std::numeric_limits<double>::denorm_min();
             EXPECT_LE(S.length(error), S.few * 2.3e-16 * S.length(v) + underflow) << angle;
           }
         }
         // Anywhere else as far as the elements themselves are known: in extended precision to all digits of a
         // double down to distances of 1e-15.
         for (const double angle : {1e-15, 1e-12, 1e-9, 1e-5})
           for (const auto& v : S.tangents(T(angle)))
             for (const auto& q : S.elements()) {
               const auto error =
                   (G.separation(q, G.compose(q, G.exp(v))) - v.template cast<double>()).eval();
               EXPECT_LE(error.norm(), S.few * (2.3e-16 * S.length(v) + 4 * S.eps() * S.scale(q))) << angle;
             }
       }},

      {"SeparationOfAnElementFromItselfIsZero",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         for (const auto& q : S.elements()) EXPECT_EQ(G.separation(q, q).norm(), 0.0);
       }},

      {"DefectOfExponentialsIsRoundOff",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         EXPECT_TRUE(G.defect(G.identity()) == 0.0);
         for (const double angle : S.angles())
           for (const auto& v : S.tangents(T(angle)))
             EXPECT_LE(to_double(G.defect(G.exp(v))), S.few * S.eps());
         for (const auto& q : S.elements()) EXPECT_LE(to_double(G.defect(q)), 50 * S.few * S.eps());
       }},

      {"RenormalizedSquaresTheDefect",
       [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         double largest = 0;
         for (const auto& q : S.elements()) {
           const auto rounded = G.through_half_precision(q);
           const double defect = to_double(G.defect(rounded));
           const auto repaired = G.renormalized(rounded);
           EXPECT_LE(to_double(G.defect(repaired)), defect * defect + S.few * S.eps());
           // The dual part of a dual quaternion moves in proportion to its size.
           EXPECT_LE(S.distance(repaired, rounded), (defect + S.few * S.eps()) * S.scale(q));
           largest = std::max(largest, defect);
         }
         if (largest > 0) {  // the sample was off the group, where one can be off it
           EXPECT_GT(largest, 1e4 * S.eps());
         }
       }},

      {"CastKeepsTheElement", [](const GroupSamples<T>& S) {
         const AnyGroup<T>& G = S.group();
         for (const auto& q : S.elements()) {
           EXPECT_EQ(S.distance(G.through_extended(q), q), 0.0);
           EXPECT_EQ((G.in_double(q) - q.template cast<double>()).norm(), 0.0);
         }
       }}};
}
template std::vector<Property<double>> exponential_properties();
template std::vector<Property<Extended>> exponential_properties();

}  // namespace liebench
