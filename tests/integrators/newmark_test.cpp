#include "integrators/newmark.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "groups/extended.h"
#include "problems/heavy_top.h"
#include "tests/support/dense_algebra.h"
#include "tests/support/observed_order.h"
#include "tests/support/small_systems.h"
#include "tests/support/steppers.h"
#include "tests/support/time_reversal.h"

namespace liebench::newmark_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

TEST(Newmark, HasOrderTwo) {
  for (const bool safeguard : {false, true}) {
    const Errors order = observed_orders<Newmark, ExtendedSO3>({safeguard});
    EXPECT_NEAR(order.q, 2, order_tolerance);
    EXPECT_NEAR(order.v, 2, order_tolerance);
  }
}

TEST(Newmark, ComesBackInReversedTimeOnQuaternionsToo) {
  expect_time_reversal<Newmark, HeavyTopS3<double>>();
}

// From the states alone, with v' from the equations of motion at each of them.
TEST(Newmark, SatisfiesItsEquations) {
  using S = HeavyTopSO3<double>;
  using G = S::Group;
  const HeavyTopParameters p = unsymmetric_top(1);
  const S system(p);
  const HeavyTopMotion motion(p, 0.1);
  constexpr double h = 1.0 / 32;
  const std::vector<SolutionPoint<S>> points{motion.point(system, Extended(0.0))};
  const auto stepper = make_stepper<Newmark, S>({}, system);
  ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
  const auto acceleration = [&](const Eigen::Matrix3d& q, const Eigen::Vector3d& v) {
    return Eigen::Vector3d(-dense_solution(system.mass_matrix(q), system.force(0.0, q, v)));
  };
  const double speed = points[0].v.norm();
  for (int n = 1; n <= 32; ++n) {
    const Eigen::Matrix3d q = stepper->configuration();
    const Eigen::Vector3d v = stepper->velocity();
    ASSERT_EQ(stepper->step().outcome, Outcome::ok);
    const Eigen::Vector3d sum =
        acceleration(q, v) + acceleration(stepper->configuration(), stepper->velocity());
    EXPECT_LE((stepper->velocity() - v - h / 2 * sum).norm(), 64 * eps * n * speed) << n;
    EXPECT_LE((G::log(q.transpose() * stepper->configuration()) / h - v - h / 4 * sum).norm(),
              64 * eps * (n * speed + 1 / h))
        << n;
  }
}

// Newmark 1959, written in accelerations and solved by Newton's method with the exact matrix.
TEST(Newmark, IsNewmarksMethodInALinearSpace) {
  using S = Oscillators<double, 3>;
  using Vector = S::Vector;
  const S system;
  constexpr double h = 0.05;
  Vector q = system.initial_configuration(), v = system.initial_velocity();
  Vector a = -dense_solution(system.mass_matrix(q), system.force(0.0, q, v));
  const std::array points{SolutionPoint<S>{0.0, q, v, a, {}}};
  const auto stepper = make_stepper<Newmark, S>({}, system);
  ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
  for (int step = 1; step <= 40; ++step) {
    Vector a1 = a, q1, v1;
    for (int i = 0; i < 20; ++i) {
      q1 = q + h * v + h * h / 4 * (a + a1);
      v1 = v + h / 2 * (a + a1);
      const Vector r = system.mass_matrix(q1) * a1 + system.force(step * h, q1, v1);
      const S::Matrix J = system.mass_matrix(q1) + h / 2 * system.damping(step * h, q1, v1) +
                          h * h / 4 * system.stiffness(step * h, q1, v1, a1, {});
      a1 -= dense_solution(J, r);
    }
    q = q1;
    v = v1;
    a = a1;
    ASSERT_EQ(stepper->step().outcome, Outcome::ok);
    // Round-off of 40 steps, in values of order 1, through a matrix of condition below 10.
    EXPECT_LE((stepper->configuration() - q).norm(), 1e-13) << step;
    EXPECT_LE((stepper->velocity() - v).norm(), 1e-12) << step;
  }
}

TEST(Newmark, StartsFromTheAccelerationWithoutAnySolution) {
  using S = HeavyTopSO3<double>;
  const HeavyTopParameters p = slow_top();
  const S system(p);
  const HeavyTopMotion motion(p, 0.1);
  const std::vector<SolutionPoint<S>> points{motion.point(system, Extended(0.0))};
  GeneralizedAlpha::Stepper<S, Form::index3, KernelAudit> stepper(
      system, GeneralizedAlphaParameters<double>::average_acceleration(), false);
  ASSERT_EQ(stepper.start(0x1p-6, points).outcome, Outcome::ok);
  EXPECT_EQ(stepper.audit().solves, 0u);
}

TEST(Newmark, DoesNotFitAConstrainedProblem) {
  EXPECT_FALSE((may_fit<Newmark, HeavyTopR3xSO3<double>>()));
}

}  // namespace
}  // namespace liebench::newmark_test
