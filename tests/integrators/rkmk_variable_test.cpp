#include "integrators/rkmk_variable.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "tests/support/hanging_top.h"
#include "tests/support/heavy_top_motion.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/spinning_up.h"
#include "tests/support/steppers.h"

namespace liebench::rkmk_variable_test {
namespace {

using S = HeavyTopSO3<double>;

TEST(DormandPrincePair, IsTheStepAndTheDifferenceToTheEmbeddedSolution) {
  // b^ of Hairer, Norsett & Wanner, Table II.5.2.
  constexpr std::array<Fraction, 7> embedded{
      {{5179, 57600}, {}, {7571, 16695}, {393, 640}, {-92097, 339200}, {187, 2100}, {1, 40}}};
  for (std::size_t i = 0; i < 7; ++i) {
    const Extended b = i < 6 ? value_of<Extended>(dormand_prince_five.b[i]) : Extended(0.0);
    const Extended difference = b - value_of<Extended>(embedded[i]);
    EXPECT_LE(std::abs(to_double(difference - value_of<Extended>(dormand_prince_pair.b[i]))), 1e-31) << i;
    if (i < 6) {
      EXPECT_EQ(dormand_prince_pair.a[6][i].numerator, dormand_prince_five.b[i].numerator) << i;
    }
  }
}

struct Course {
  Outcome outcome = Outcome::ok;
  int steps = 0;
  std::uint64_t rejections = 0;
  double error_of_q = 0.0, error_of_v = 0.0, time = 0.0;
};

template <class System>
Course run(const System& system, double tolerance, double end, const HeavyTopMotion& motion) {
  using T = typename System::Scalar;
  const auto stepper = make_stepper<RkmkVariable, System>({.tolerance = tolerance}, system);
  const std::array points{motion.point(system, Extended(0.0))};
  Course course{.outcome = stepper->start(T(end), points).outcome};
  while (course.outcome == Outcome::ok && !stepper->finished()) {
    course.outcome = stepper->step().outcome;
    ++course.steps;
  }
  const auto exact = motion.point(system, Extended(end));
  course.rejections = stepper->audit().rejections;
  course.time = to_double(stepper->time());
  course.error_of_q = System::Group::separation(exact.q, stepper->configuration()).norm();
  course.error_of_v = to_double((stepper->velocity() - exact.v).norm());
  return course;
}

TEST(RkmkVariable, EndsAtTheEndWithAnErrorInProportionToItsTolerance) {
  const HeavyTopParameters p = slow_top();
  const HeavyTopMotion motion(p, 1.0);
  double before = 0.0;
  int steps_before = 0;
  for (const double tolerance : {1e-5, 1e-7, 1e-9, 1e-11}) {
    const Course course = run(S(p), tolerance, 1.0, motion);
    ASSERT_EQ(course.outcome, Outcome::ok);
    EXPECT_EQ(course.time, 1.0);
    // A local error below the tolerance in each step, which a second of this motion does not multiply by ten.
    EXPECT_LE(course.error_of_q, 10.0 * tolerance * course.steps) << tolerance;
    EXPECT_LE(course.error_of_v, 10.0 * tolerance * (1.0 + 4.3) * course.steps) << tolerance;
    if (before > 0.0) {
      // A hundredth of the tolerance: a hundredth of the error, and 100^(1/5) = 2.5 times the steps.
      EXPECT_NEAR(std::log10(before / course.error_of_q), 2.0, 1.0) << tolerance;
      EXPECT_NEAR(double(course.steps) / steps_before, 2.51, 0.5) << tolerance;
    }
    before = course.error_of_q;
    steps_before = course.steps;
  }
}

TEST(RkmkVariable, TakesTheSameStepsInAnAudit) {
  const HeavyTopParameters p = slow_top();
  const HeavyTopMotion motion(p, 1.0);
  using C = CountedSO3;
  const auto stepper = make_stepper<RkmkVariable, S>({.tolerance = 1e-8}, S(p));
  const auto audited = make_stepper<RkmkVariable, C>({.tolerance = 1e-8}, C(p));
  const SolutionPoint<S> start = motion.point(S(p), Extended(0.0));
  const std::array points{start};
  const std::array counted{SolutionPoint<C>{start.t,
                                            S::Group::cast<Counted>(start.q),
                                            start.v.cast<Counted>(),
                                            start.acceleration.cast<Counted>(),
                                            {}}};
  ASSERT_EQ(stepper->start(1.0, points).outcome, Outcome::ok);
  ASSERT_EQ(audited->start(Counted(1.0), counted).outcome, Outcome::ok);
  int steps = 0;
  while (!stepper->finished()) {
    ASSERT_EQ(stepper->step().outcome, Outcome::ok);
    ASSERT_EQ(audited->step().outcome, Outcome::ok);
    ++steps;
    ASSERT_EQ(state_of(*stepper), state_of(*audited)) << steps;
  }
  EXPECT_TRUE(audited->finished());
  // One evaluation at the start, six in each step, accepted or not.
  const KernelAudit audit = audited->audit();
  EXPECT_EQ((audit.solves - 1) % 6, 0u);
  EXPECT_EQ((audit.solves - 1) / 6, std::uint64_t(steps) + audit.rejections);
}

TEST(RkmkVariable, GoesBackwardsToo) {
  const HeavyTopParameters p = slow_top();
  const S system(p);
  const HeavyTopMotion motion(p, 1.0);
  const auto stepper = make_stepper<RkmkVariable, S>({.tolerance = 1e-10}, system);
  const std::array points{motion.point(system, Extended(0.5))};
  ASSERT_EQ(stepper->start(-0.5, points).outcome, Outcome::ok);
  while (!stepper->finished()) ASSERT_EQ(stepper->step().outcome, Outcome::ok);
  EXPECT_EQ(stepper->time(), 0.0);
  EXPECT_LE(S::Group::separation(system.initial_configuration(), stepper->configuration()).norm(), 1e-8);
}

TEST(RkmkVariable, FollowsARotationThatGrowsFasterInShorterSteps) {
  // Omega = 2 + t / 2 about one axis: v has no error, and what limits the step is the turn, less than pi.
  using System = SpinningUp<double>;
  const System system;
  const auto stepper = make_stepper<RkmkVariable, System>({.tolerance = 1e-3}, system);
  const std::array points{spinning_up_point(0.0)};
  ASSERT_EQ(stepper->start(40.0, points).outcome, Outcome::ok);
  double before = 0.0, longest_turn = 0.0;
  while (!stepper->finished()) {
    ASSERT_EQ(stepper->step().outcome, Outcome::ok);
    longest_turn =
        std::max(longest_turn, (stepper->time() - before) * (2.0 + 0.25 * (stepper->time() + before)));
    before = stepper->time();
  }
  EXPECT_LT(longest_turn, std::numbers::pi);
  EXPECT_GT(longest_turn, 1.0);
  EXPECT_LE((stepper->velocity() - spinning_up_point(40.0).v).norm(), 1e-11);
}

TEST(RkmkVariable, ReportsForcesThatAreNoNumbers) {
  HeavyTopParameters p = slow_top();
  const std::array points{HeavyTopMotion(p, 0.2).point(S(p), Extended(0.0))};
  p.gravity[1] = std::numeric_limits<double>::quiet_NaN();
  const auto stepper = make_stepper<RkmkVariable, S>({.tolerance = 1e-6}, S(p));
  EXPECT_EQ(stepper->start(0.1, points).outcome, Outcome::non_finite);
}

TEST(RkmkVariable, EndsAtOnceAfterAnIntervalOfNoLength) {
  const HeavyTopParameters p = slow_top();
  const SolutionPoint<S> first = HeavyTopMotion(p, 0.2).point(S(p), Extended(0.1));
  const auto stepper = make_stepper<RkmkVariable, S>({}, S(p));
  EXPECT_EQ(stepper->start(0.0, std::array{first}).outcome, Outcome::ok);
  EXPECT_TRUE(stepper->finished());
  EXPECT_EQ(stepper->time(), 0.1);
  EXPECT_EQ(stepper->configuration(), first.q);
  EXPECT_EQ(stepper->velocity(), first.v);
}

}  // namespace
}  // namespace liebench::rkmk_variable_test
