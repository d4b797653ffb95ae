#include "integrators/implicit_midpoint.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "groups/extended.h"
#include "problems/heavy_top.h"
#include "problems/linear_oscillator.h"
#include "tests/support/dense_algebra.h"
#include "tests/support/observed_order.h"
#include "tests/support/small_systems.h"
#include "tests/support/steppers.h"
#include "tests/support/time_reversal.h"

namespace liebench::implicit_midpoint_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

TEST(ImplicitMidpoint, HasOrderTwo) {
  for (const bool safeguard : {false, true}) {
    const Errors order = observed_orders<ImplicitMidpoint, ExtendedSO3>({safeguard});
    EXPECT_NEAR(order.q, 2, order_tolerance);
    EXPECT_NEAR(order.v, 2, order_tolerance);
  }
}

TEST(ImplicitMidpoint, ComesBackInReversedTimeOnQuaternionsToo) {
  expect_time_reversal<ImplicitMidpoint, HeavyTopS3<double>>();
}

// From the states alone: w = log(q_n^{-1} q_{n+1}) / h is the mean velocity, and the balance holds at the middle.
TEST(ImplicitMidpoint, SatisfiesItsEquations) {
  using S = HeavyTopSO3<double>;
  using G = S::Group;
  const HeavyTopParameters p = unsymmetric_top(1);
  const S system(p);
  constexpr double h = 1.0 / 32;
  const std::vector<SolutionPoint<S>> points{
      {0.0, system.initial_configuration(), system.initial_velocity(), Eigen::Vector3d::Zero(), {}}};
  const auto stepper = make_stepper<ImplicitMidpoint, S>({}, system);
  ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
  const double speed = points[0].v.norm();
  for (int n = 1; n <= 32; ++n) {
    const Eigen::Matrix3d q = stepper->configuration();
    const Eigen::Vector3d v = stepper->velocity();
    ASSERT_EQ(stepper->step().outcome, Outcome::ok);
    EXPECT_EQ(stepper->time(), n * h);
    const Eigen::Vector3d w = (v + stepper->velocity()) / 2;
    EXPECT_LE((G::log(q.transpose() * stepper->configuration()) / h - w).norm(), 32 * eps * (speed + 1 / h))
        << n;
    const Eigen::Vector3d balance =
        system.momentum(q, stepper->velocity() - v) + h * system.force(0.0, q * G::exp(h / 2 * w), w);
    EXPECT_LE(balance.norm(), 32 * eps * system.momentum(q, v).norm()) << n;
  }
}

// The rule on R^n, written as such and solved by Newton's method with the exact matrix.
TEST(ImplicitMidpoint, IsTheClassicalRuleInALinearSpace) {
  using S = Oscillators<double, 3>;
  using Vector = S::Vector;
  const S system;
  constexpr double h = 0.05;
  Vector q = system.initial_configuration(), v = system.initial_velocity();
  const std::array points{SolutionPoint<S>{0.0, q, v, Vector::Zero(), {}}};
  const auto stepper = make_stepper<ImplicitMidpoint, S>({}, system);
  ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
  for (int step = 0; step < 40; ++step) {
    Vector v1 = v;
    for (int i = 0; i < 20; ++i) {
      const Vector w = (v + v1) / 2, middle = q + h / 2 * w;
      const double t = (step + 0.5) * h;
      const Vector r = system.mass_matrix(q) * (v1 - v) + h * system.force(t, middle, w);
      const S::Matrix J = system.mass_matrix(q) + h / 2 * system.damping(t, middle, w) +
                          h * h / 4 * system.stiffness(t, middle, w, w, {});
      v1 -= dense_solution(J, r);
    }
    q += h * (v + v1) / 2;
    v = v1;
    ASSERT_EQ(stepper->step().outcome, Outcome::ok);
    // Round-off of 40 steps, in values of order 1, through a matrix of condition below 10.
    EXPECT_LE((stepper->configuration() - q).norm(), 1e-13) << step;
    EXPECT_LE((stepper->velocity() - v).norm(), 1e-13) << step;
  }
}

TEST(ImplicitMidpoint, KeepsTheEnergyOfALinearOscillator) {
  using S = LinearOscillator<double>;
  const S system(0.0, 9.0);
  const std::array points{
      SolutionPoint<S>{0.0, system.initial_configuration(), system.initial_velocity(), S::Vector(-9.0), {}}};
  const auto stepper = make_stepper<ImplicitMidpoint, S>({}, system);
  ASSERT_EQ(stepper->start(0.5, points).outcome, Outcome::ok);  // h omega = 1.5
  for (int n = 1; n <= 200; ++n) {
    ASSERT_EQ(stepper->step().outcome, Outcome::ok);
    ASSERT_NEAR(system.energy(stepper->configuration(), stepper->velocity()), 4.5, 32 * eps * n) << n;
  }
}

TEST(ImplicitMidpoint, HasTheErrorOfABdfMethodOnTheFastTop) {
  using S = HeavyTopSO3<double>;
  const HeavyTopParameters p;
  const HeavyTopMotion motion(p, 0.5);
  const S system(p);
  const auto stepper = make_stepper<ImplicitMidpoint, S>({}, system);
  const std::vector<SolutionPoint<S>> points{motion.point(system, Extended(0.0))};
  ASSERT_EQ(stepper->start(0x1p-12, points).outcome, Outcome::ok);
  ASSERT_EQ(stepper->advance(2048).outcome, Outcome::ok);
  const auto exact = motion.point(system, Extended(0.5));
  // As found by another implementation, to the digits that were kept of it.
  EXPECT_NEAR(S::Group::separation(exact.q, stepper->configuration()).norm(), 6.0e-3, 0.06e-3);
}

TEST(ImplicitMidpoint, LeavesTheStateWhereAWholeStepTurnsTooFar) {
  // 4 rad a step, 2 rad in half of it.
  HeavyTopParameters p;
  p.gravity = {0, 0, 0};
  p.angular_velocity = {0, 4, 0};
  using S = HeavyTopSO3<double>;
  const S system(p);
  for (const bool safeguard : {false, true}) {
    const auto stepper = make_stepper<ImplicitMidpoint, S>({safeguard}, system);
    const std::vector<SolutionPoint<S>> points{
        {0.0, system.initial_configuration(), system.initial_velocity(), Eigen::Vector3d::Zero(), {}}};
    ASSERT_EQ(stepper->start(1.0, points).outcome, Outcome::ok);
    EXPECT_EQ(name(stepper->step().outcome), name(Outcome::rotation_too_large));
    EXPECT_EQ(stepper->time(), 0.0);
    EXPECT_EQ(stepper->configuration(), points[0].q);
    EXPECT_EQ(stepper->velocity(), points[0].v);
  }
}

TEST(ImplicitMidpoint, DoesNotFitAConstrainedProblem) {
  EXPECT_FALSE((may_fit<ImplicitMidpoint, HeavyTopR3xSO3<double>>()));
}

}  // namespace
}  // namespace liebench::implicit_midpoint_test
