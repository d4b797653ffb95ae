#include "integrators/shakelie.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "groups/extended.h"
#include "integrators/rattlie.h"
#include "problems/heavy_top.h"
#include "tests/support/dense_algebra.h"
#include "tests/support/observed_order.h"
#include "tests/support/steppers.h"

namespace liebench::shakelie_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

TEST(Shakelie, HasOrderTwoFromTheFirstStepOn) {
  const Errors order = observed_orders<Shakelie, ExtendedR3xSO3>({});
  for (const double p :
       {order.q, order.v, order.lambda, order.largest_q, order.largest_v, order.largest_lambda})
    EXPECT_NEAR(p, 2, order_tolerance);
}

// q_n and lambda_n are those of RATTLie; the velocity is the one that p_{n+1} = T^{-T} M Dq - h/2 (f + B^T lambda)
// gives, and fulfils the hidden constraint to O(h^2) only.
template <class S>
void expect_rattlie_but_for_the_velocity() {
  using G = typename S::Group;
  const HeavyTopParameters p = unsymmetric_top(1);
  const S system(p);
  const HeavyTopMotion motion(p, 0.1);
  const std::vector<SolutionPoint<S>> points{motion.point(system, Extended(0.0))};
  std::vector<double> violations;
  for (const double h : {1.0 / 64, 1.0 / 128}) {
    const auto shakelie = make_stepper<Shakelie, S>({}, system);
    const auto rattlie = make_stepper<Rattlie, S>({}, system);
    ASSERT_EQ(shakelie->start(h, points).outcome, Outcome::ok);
    ASSERT_EQ(rattlie->start(h, points).outcome, Outcome::ok);
    const int steps = int(0.25 / h);
    const double mass = system.mass_matrix(points[0].q).norm();
    double violation = 0.0;
    for (int n = 1; n <= steps; ++n) {
      const Configuration<S> before = shakelie->configuration();
      ASSERT_EQ(shakelie->step().outcome, Outcome::ok);
      ASSERT_EQ(rattlie->step().outcome, Outcome::ok);
      // Phi is known to eps, Dq to eps / h, h lambda to M eps / h.
      const double tolerance = 16 * n * eps;
      const Configuration<S>& q = shakelie->configuration();
      ASSERT_LE(G::separation(rattlie->configuration(), q).norm(), tolerance) << n;
      ASSERT_LE((rattlie->multipliers() - shakelie->multipliers()).norm(), mass * tolerance / (h * h)) << n;
      EXPECT_LE(system.constraint(q).norm(), 32 * eps) << n;
      const Velocity<S> u = G::log(G::compose(G::inverse(before), q));
      const Velocity<S> kick =
          system.force(0.0, q, zero_velocity(system)) + system.constraint_force(q, shakelie->multipliers());
      const Eigen::VectorXd momentum =
          dense_solution(G::tangent(u).transpose(), system.mass_matrix(q) * u / h) - h / 2 * kick;
      EXPECT_LE((system.momentum(q, shakelie->velocity()) - momentum).norm(), mass * 100 * eps / h) << n;
      violation = std::max(violation, (system.constraint_gradient(q) * shakelie->velocity()).norm());
    }
    violations.push_back(violation);
  }
  EXPECT_NEAR(violations[0] / violations[1], 4, 0.4);
}

TEST(Shakelie, IsRattlieButForTheVelocity) {
  expect_rattlie_but_for_the_velocity<HeavyTopR3xSO3<double>>();
  expect_rattlie_but_for_the_velocity<HeavyTopSE3<double>>();
}

TEST(Shakelie, DoesNotFitAProblemWithoutConstraints) {
  EXPECT_FALSE((may_fit<Shakelie, HeavyTopSO3<double>>()));
  EXPECT_TRUE((may_fit<Shakelie, HeavyTopR3xSO3<double>>()));
}

}  // namespace
}  // namespace liebench::shakelie_test
