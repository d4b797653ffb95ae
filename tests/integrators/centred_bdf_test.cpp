#include "integrators/centred_bdf.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <numbers>
#include <string>

#include "integrators/bliedf2nd.h"
#include "problems/heavy_top.h"
#include "tests/support/coordinate_bdf_laws.h"
#include "tests/support/heavy_top_motion.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/large_turns.h"
#include "tests/support/observed_order.h"
#include "tests/support/step_law.h"
#include "tests/support/steppers.h"

namespace liebench::centred_bdf_test {
namespace {

constexpr int most_steps = 6;

std::string text(const CentredBdf::Options& options) {
  return "k = " + std::to_string(options.k) + (options.form == Form::index3 ? "" : ", stabilized") +
         (options.modified_start ? ", modified start" : "");
}

// --- what one step is ------------------------------------------------------------------------------------

// v_{n+1} = (1/h) sum_{i=1}^k alpha_i log(p^{-1} q_{n+1-i}) from the states alone, with p = q_n exp(h (Dq_n + extra)~):
// q_{n+1} but for the auxiliary multiplier.
template <MechanicalSystem S>
class StepLaw : public BdfStepLaw<S> {
  using Base = BdfStepLaw<S>;

 public:
  using typename Base::Group;
  using typename Base::T;

  StepLaw(const S& system, const T& h, const CentredBdf::Options& options) : Base(options.k, system, h) {}

  Velocity<S> kinematics(const Velocity<S>& extra) const {
    const Velocity<S> step = Base::h() * (Base::increment(0) + extra);
    const Configuration<S> p = Group::compose(Base::q(1), Group::exp(step));
    Velocity<S> sum = Velocity<S>::Constant(T(0.0));
    for (int i = 1; i <= Base::k(); ++i)
      sum += Base::alpha(i) * Group::log(Group::compose(Group::inverse(p), Base::q(i)));
    return sum / Base::h() - Base::v(0);
  }
};

template <class S>
void expect_every_method_satisfies_its_equations() {
  const auto expect = [](const HeavyTopParameters& p, const CentredBdf::Options& options) {
    expect_steps_satisfy_the_equations<CentredBdf, StepLaw, S>(p, options, text(options));
  };
  for (const HeavyTopParameters& p : {slow_top(), unsymmetric_top(2)})
    for (int k = 1; k <= most_steps; ++k) {
      expect(p, {.k = k});
      if constexpr (S::constraints > 0) {
        expect(p, {.k = k, .modified_start = true});
        expect(p, {.k = k, .form = Form::stabilized_index2});
      }
    }
}

TEST(CentredBdf, StepsAreTheClassicalMethodInCanonicalCoordinatesAboutTheNewPoint) {
  expect_every_method_satisfies_its_equations<HeavyTopSO3<double>>();
  expect_every_method_satisfies_its_equations<ExtendedSO3>();
}

TEST(CentredBdf, ConstrainedStepsAreTheClassicalMethodInCanonicalCoordinatesAboutTheNewPoint) {
  expect_every_method_satisfies_its_equations<HeavyTopR3xSO3<double>>();
  expect_every_method_satisfies_its_equations<ExtendedR3xSO3>();
}

TEST(CentredBdf, ModifiedStartTakesTheLocalErrorOfTheMethodFromTheSolution) {
  for (int k = 1; k <= most_steps; ++k) {
    const CentredBdf::Options options{.k = k, .modified_start = true};
    expect_modified_start_takes_the_local_error<CentredBdf, StepLaw>(options, text(options));
  }
}

// --- orders ----------------------------------------------------------------------------------------------

TEST(CentredBdf, HasOrderKInConfigurationAndVelocity) {
  for (int k = 1; k <= most_steps; ++k) {
    const Errors order = observed_orders<CentredBdf, ExtendedSO3>({.k = k});
    EXPECT_NEAR(order.q, k, order_tolerance) << k;
    EXPECT_NEAR(order.v, k, order_tolerance) << k;
  }
}

// `transient` is the order of lambda over all steps. That of q is seen over all steps, too: for k = 6 its error at the
// end is next to a zero (bliedf2nd_orders_test.cpp).
void expect_constrained_orders(const CentredBdf::Options& options, int transient) {
  const Errors order = observed_orders<CentredBdf, ExtendedR3xSO3>(options);
  EXPECT_NEAR(order.largest_q, options.k, order_tolerance) << text(options);
  EXPECT_NEAR(order.v, options.k, order_tolerance) << text(options);
  EXPECT_NEAR(order.lambda, options.k, order_tolerance) << text(options);
  EXPECT_NEAR(order.largest_lambda, transient, order_tolerance) << text(options);
}

TEST(CentredBdf, HasOrderKWithConstraintsButForLambdaInTheTransientPhase) {
  for (int k = 1; k <= most_steps; ++k) expect_constrained_orders({.k = k}, k - 1);
}

TEST(CentredBdf, KeepsTheOrderOfLambdaFromModifiedStartingVelocities) {
  for (int k = 1; k <= most_steps; ++k) expect_constrained_orders({.k = k, .modified_start = true}, k);
}

TEST(CentredBdf, HasOrderKInAllComponentsFromTheFirstStepInTheStabilizedForm) {
  for (int k = 1; k <= most_steps; ++k)
    expect_constrained_orders({.k = k, .form = Form::stabilized_index2}, k);
}

// --- outcomes and options --------------------------------------------------------------------------------

TEST(CentredBdf, StopsWhereTheStepsOfALogarithmTogetherTurnByPiOrMore) {
  // The longest logarithm spans k steps, the new one among them.
  for (int k = 1; k <= most_steps; ++k) expect_limit_of_spin<CentredBdf>({.k = k}, std::numbers::pi / k);
}

TEST(CentredBdf, StopsAtTheStepForWhichALogarithmIsBeyondPi) {
  for (int k = 2; k <= most_steps; ++k) {
    expect_stop_where_logarithms_span_pi<CentredBdf>({.k = k}, k - 1, 1);
    expect_stop_where_logarithms_span_pi<CentredBdf>({.k = k, .safeguard = true}, k - 1, 1);
  }
}

TEST(CentredBdf, IsBLieDF2ndForOneStep) {
  using S = HeavyTopR3xSO3<double>;
  const HeavyTopParameters p = unsymmetric_top(1);
  const S system(p);
  const HeavyTopMotion motion(p, 0.2);
  const auto stepper = make_stepper<CentredBdf, S>({.k = 1}, system);
  const auto other = make_stepper<BLieDF2nd, S>({.k = 1}, system);
  const auto points = exact_starting_points(system, motion, 0.01, 2);
  ASSERT_EQ(stepper->start(0.01, points).outcome, Outcome::ok);
  ASSERT_EQ(other->start(0.01, points).outcome, Outcome::ok);
  ASSERT_EQ(stepper->advance(50).outcome, Outcome::ok);
  ASSERT_EQ(other->advance(50).outcome, Outcome::ok);
  EXPECT_EQ(S::Group::stacked(stepper->configuration()), S::Group::stacked(other->configuration()));
  EXPECT_EQ(stepper->velocity(), other->velocity());
}

TEST(CentredBdf, OptionsSelectTheStepper) {
  const HeavyTopSO3<double> system{HeavyTopParameters{}};
  for (int k = 1; k <= most_steps; ++k) {
    OptionValues values;
    values.set("k", k);
    const CentredBdf::Options options = CentredBdf::options(values);
    EXPECT_EQ(options.k, k);
    EXPECT_FALSE(options.modified_start);
    EXPECT_EQ(options.form, Form::index3);
    EXPECT_EQ(CentredBdf::orders(values).lambda, k);
    const auto stepper = make_stepper<CentredBdf, HeavyTopSO3<double>>(options, system);
    EXPECT_EQ(stepper->steps(), k);
    EXPECT_EQ(stepper->starting_points(), k + 1);
  }
}

}  // namespace
}  // namespace liebench::centred_bdf_test
