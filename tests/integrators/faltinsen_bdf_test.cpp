#include "integrators/faltinsen_bdf.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "integrators/bliedf2nd.h"
#include "problems/heavy_top.h"
#include "tests/support/coordinate_bdf_laws.h"
#include "tests/support/heavy_top_motion.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/large_turns.h"
#include "tests/support/observed_order.h"
#include "tests/support/step_law.h"
#include "tests/support/steppers.h"

namespace liebench::faltinsen_bdf_test {

namespace {

using Variant = FaltinsenBdf::Variant;
constexpr int most_steps = 4;
constexpr std::array variants{Variant::exact, Variant::bch};

template <MechanicalSystem S>
std::unique_ptr<AnyStepper<S>> make(const S& system, const FaltinsenBdf::Options& options) {
  return make_stepper<FaltinsenBdf, S>(options, system);
}

std::string text(const FaltinsenBdf::Options& options) {
  return "k = " + std::to_string(options.k) + (options.variant == Variant::exact ? ", exact" : ", bch") +
         (options.form == Form::index3 ? "" : ", stabilized") +
         (options.modified_start ? ", modified start" : "");
}

// --- what one step is ------------------------------------------------------------------------------------

// v_{n+1} = T(u) w, w = (1/h) sum alpha_i s_{n+1-i}, from the states alone. Exact: s_j = log(q_n^{-1} q_j). Truncated
// ("FMM-BCH"), with a = h Dq_{n-1}, b = h Dq_{n-2}, c = h Dq_{n-3}, u = h Dq_n:
//   s_{n-1} = -a,  s_{n-2} = -(a + b) + [a, b] / 2,  s_{n-3} = s - c - z / 2 - [s + c, z] / 12,  s = s_{n-2}, z = [s, c]
//   k <= 2: v = w;  k = 3: v = w - [u, w] / 2;  k = 4: v = w - [u, w] / 2 + [u, [u, w]] / 6
template <MechanicalSystem S>
class StepLaw : public BdfStepLaw<S> {
  using Base = BdfStepLaw<S>;

 public:
  using typename Base::Group;
  using typename Base::T;

  StepLaw(const S& system, const T& h, const FaltinsenBdf::Options& options)
      : Base(options.k, system, h), variant_(options.variant) {}

  // T(u) w - v_{n+1} with u = h (Dq_n + extra); in the stabilized form extra = B(q_n)^T eta.
  Velocity<S> kinematics(const Velocity<S>& extra) const {
    const int k = Base::k();
    Velocity<S> w = Velocity<S>::Constant(T(0.0));
    const Velocity<S> u = coordinates(0) + Base::h() * extra;
    w += Base::alpha(0) * u;
    for (int i = 2; i <= k; ++i) w += Base::alpha(i) * coordinates(i);
    w /= Base::h();
    if (variant_ == Variant::exact) return Group::tangent(u) * w - Base::v(0);
    Velocity<S> v = w;
    if (k >= 3) v -= bracket(u, w) / T(2.0);
    if (k >= 4) v += bracket(u, bracket(u, w)) / T(6.0);
    return v - Base::v(0);
  }

 private:
  static Velocity<S> bracket(const Velocity<S>& x, const Velocity<S>& y) { return Group::commutator(x, y); }

  // s_{n+1-i}
  Velocity<S> coordinates(int i) const {
    if (variant_ == Variant::exact || i == 0)
      return Group::log(Group::compose(Group::inverse(Base::q(1)), Base::q(i)));
    const Velocity<S> a = Base::h() * Base::increment(1);
    if (i == 2) return -a;
    const Velocity<S> b = Base::h() * Base::increment(2);
    const Velocity<S> s = bracket(a, b) / T(2.0) - a - b;
    if (i == 3) return s;
    const Velocity<S> c = Base::h() * Base::increment(3);
    const Velocity<S> z = bracket(s, c);
    return s - c - z / T(2.0) - bracket(s + c, z) / T(12.0);
  }

  Variant variant_;
};

template <class S>
void expect_every_method_satisfies_its_equations() {
  const auto expect = [](const HeavyTopParameters& p, const FaltinsenBdf::Options& options) {
    expect_steps_satisfy_the_equations<FaltinsenBdf, StepLaw, S>(p, options, text(options));
  };
  for (const HeavyTopParameters& p : {slow_top(), unsymmetric_top(2)})
    for (const Variant variant : variants)
      for (int k = 1; k <= most_steps; ++k) {
        expect(p, {.k = k, .variant = variant});
        if constexpr (S::constraints > 0) {
          expect(p, {.k = k, .variant = variant, .modified_start = true});
          expect(p, {.k = k, .variant = variant, .form = Form::stabilized_index2});
        }
      }
}

TEST(FaltinsenBdf, StepsAreTheClassicalMethodInCanonicalCoordinatesAboutTheLastPoint) {
  expect_every_method_satisfies_its_equations<HeavyTopSO3<double>>();
  expect_every_method_satisfies_its_equations<ExtendedSO3>();
}

TEST(FaltinsenBdf, ConstrainedStepsAreTheClassicalMethodInCanonicalCoordinatesAboutTheLastPoint) {
  expect_every_method_satisfies_its_equations<HeavyTopR3xSO3<double>>();
  expect_every_method_satisfies_its_equations<ExtendedR3xSO3>();
}

TEST(FaltinsenBdf, ModifiedStartTakesTheLocalErrorOfTheMethodFromTheSolution) {
  for (const Variant variant : variants)
    for (int k = 1; k <= most_steps; ++k) {
      const FaltinsenBdf::Options options{.k = k, .variant = variant, .modified_start = true};
      expect_modified_start_takes_the_local_error<FaltinsenBdf, StepLaw>(options, text(options));
    }
}

// --- orders ----------------------------------------------------------------------------------------------

template <class S>
Errors orders(const FaltinsenBdf::Options& options) {
  return observed_orders<FaltinsenBdf, S>(options);
}

TEST(FaltinsenBdf, HasOrderKInConfigurationAndVelocity) {
  for (const Variant variant : variants)
    for (int k = 1; k <= most_steps; ++k) {
      const Errors order = orders<ExtendedSO3>({.k = k, .variant = variant});
      EXPECT_NEAR(order.q, k, order_tolerance) << k;
      EXPECT_NEAR(order.v, k, order_tolerance) << k;
    }
}

TEST(FaltinsenBdf, HasOrderKWithConstraintsButForLambdaInTheTransientPhase) {
  for (const Variant variant : variants)
    for (int k = 1; k <= most_steps; ++k) {
      const Errors order = orders<ExtendedR3xSO3>({.k = k, .variant = variant});
      EXPECT_NEAR(order.q, k, order_tolerance) << k;
      EXPECT_NEAR(order.v, k, order_tolerance) << k;
      EXPECT_NEAR(order.lambda, k, order_tolerance) << k;
      EXPECT_NEAR(order.largest_lambda, k - 1, order_tolerance) << k;
    }
}

TEST(FaltinsenBdf, KeepsTheOrderOfLambdaFromModifiedStartingVelocities) {
  for (const Variant variant : variants)
    for (int k = 2; k <= most_steps; ++k) {
      const Errors order = orders<ExtendedR3xSO3>({.k = k, .variant = variant, .modified_start = true});
      EXPECT_NEAR(order.q, k, order_tolerance) << k;
      EXPECT_NEAR(order.v, k, order_tolerance) << k;
      EXPECT_NEAR(order.lambda, k, order_tolerance) << k;
      EXPECT_NEAR(order.largest_lambda, k, order_tolerance) << k;
    }
}

TEST(FaltinsenBdf, HasOrderKInAllComponentsFromTheFirstStepInTheStabilizedForm) {
  for (const Variant variant : variants)
    for (int k = 2; k <= most_steps; ++k) {
      const Errors order =
          orders<ExtendedR3xSO3>({.k = k, .variant = variant, .form = Form::stabilized_index2});
      EXPECT_NEAR(order.q, k, order_tolerance) << k;
      EXPECT_NEAR(order.v, k, order_tolerance) << k;
      EXPECT_NEAR(order.lambda, k, order_tolerance) << k;
      EXPECT_NEAR(order.largest_lambda, k, order_tolerance) << k;
    }
}

// --- BLieDF2nd and others --------------------------------------------------------------------------------

template <class S>
void expect_bits_of_bliedf2nd(const FaltinsenBdf::Options& options) {
  const HeavyTopParameters p = unsymmetric_top(1);
  const S system(p);
  const HeavyTopMotion motion(p, 0.2);
  const auto stepper = make(system, options);
  const auto other = make_stepper<BLieDF2nd, S>(
      {.k = options.k, .modified_start = options.modified_start, .form = options.form}, system);
  const auto points = exact_starting_points(system, motion, 0.01, options.k + 1);
  ASSERT_EQ(stepper->start(0.01, points).outcome, Outcome::ok);
  ASSERT_EQ(other->start(0.01, points).outcome, Outcome::ok);
  for (int n = 0; n < 50; ++n) {
    ASSERT_EQ(stepper->step().outcome, Outcome::ok);
    ASSERT_EQ(other->step().outcome, Outcome::ok);
    EXPECT_EQ(S::Group::stacked(stepper->configuration()), S::Group::stacked(other->configuration()));
    EXPECT_EQ(stepper->velocity(), other->velocity());
    EXPECT_EQ(stepper->multipliers(), other->multipliers());
  }
}

TEST(FaltinsenBdf, IsBLieDF2ndWhereNoCommutatorEnters) {
  for (const FaltinsenBdf::Options& options :
       {FaltinsenBdf::Options{.k = 1, .variant = Variant::exact},
        FaltinsenBdf::Options{.k = 1, .variant = Variant::bch},
        FaltinsenBdf::Options{.k = 2, .variant = Variant::bch},
        FaltinsenBdf::Options{.k = 2, .variant = Variant::bch, .modified_start = true},
        FaltinsenBdf::Options{.k = 2, .variant = Variant::bch, .form = Form::stabilized_index2}}) {
    if (!options.modified_start && options.form == Form::index3)
      expect_bits_of_bliedf2nd<HeavyTopSO3<double>>(options);
    expect_bits_of_bliedf2nd<HeavyTopR3xSO3<double>>(options);
  }
}

TEST(FaltinsenBdf, VariantsDifferByOneOrderMoreThanTheirOwn) {
  // What the series leave out is of the size of the local error: the two solutions are next to each other in order k.
  const HeavyTopParameters p = slow_top();
  const ExtendedSO3 system(p);
  const HeavyTopMotion motion(p, 0.6);
  for (int k = 2; k <= most_steps; ++k) {
    std::vector<double> distance;
    for (const int steps : {256, 512}) {
      const Extended h = Extended(0.5) / double(steps);
      std::vector<std::unique_ptr<AnyStepper<ExtendedSO3>>> pair;
      for (const Variant variant : variants) {
        pair.push_back(make(system, {.k = k, .variant = variant}));
        ASSERT_EQ(pair.back()->start(h, exact_starting_points(system, motion, h, k + 1)).outcome,
                  Outcome::ok);
        for (int n = k; n <= steps; ++n) ASSERT_EQ(pair.back()->step().outcome, Outcome::ok);
      }
      distance.push_back(
          ExtendedSO3::Group::separation(pair[0]->configuration(), pair[1]->configuration()).norm());
    }
    EXPECT_GT(std::log2(distance[0] / distance[1]), k - 0.2) << k;
    EXPECT_GT(distance[1], 0.0) << k;
  }
}

// --- outcomes --------------------------------------------------------------------------------------------

TEST(FaltinsenBdf, StopsWhereTheStepsOfALogarithmTogetherTurnByPiOrMore) {
  // The exact variant takes logarithms over k - 1 steps.
  for (int k = 3; k <= most_steps; ++k)
    expect_limit_of_spin<FaltinsenBdf>({.k = k, .variant = Variant::exact}, std::numbers::pi / (k - 1));
}

TEST(FaltinsenBdf, StopsOtherwiseWhereAStepTurnsByPiOrMore) {
  const auto check = [](int k, Variant variant) {
    expect_limit_of_spin<FaltinsenBdf>({.k = k, .variant = variant}, std::numbers::pi);
  };
  for (int k = 1; k <= 2; ++k) check(k, Variant::exact);
  for (int k = 1; k <= most_steps; ++k) check(k, Variant::bch);
}

TEST(FaltinsenBdf, StopsAtTheStepFromWhichALogarithmIsBeyondPi) {
  for (int k = 3; k <= most_steps; ++k)
    expect_stop_where_logarithms_span_pi<FaltinsenBdf>({.k = k, .variant = Variant::exact}, k - 1, 0);
}

TEST(FaltinsenBdf, OptionsSelectTheStepper) {
  const HeavyTopSO3<double> system{HeavyTopParameters{}};
  for (int k = 1; k <= most_steps; ++k)
    for (const std::string word : {"exact", "bch"}) {
      OptionValues values;
      values.set("k", k);
      values.set("variant", word);
      const FaltinsenBdf::Options options = FaltinsenBdf::options(values);
      EXPECT_EQ(options.k, k);
      EXPECT_EQ(options.variant, word == "bch" ? Variant::bch : Variant::exact);
      EXPECT_FALSE(options.modified_start);
      EXPECT_EQ(options.form, Form::index3);
      EXPECT_EQ(make(system, options)->steps(), k);
    }
}

}  // namespace
}  // namespace liebench::faltinsen_bdf_test
