#include <gtest/gtest.h>

#include "groups/extended.h"
#include "integrators/bliedf2nd.h"
#include "problems/heavy_top.h"
#include "tests/support/observed_order.h"

namespace liebench {
namespace {

using Body = HeavyTopR3xSO3<Extended>;

template <int k>
using Stepper = BLieDF2nd::Stepper<k, Body, NoAudit, Form::stabilized_index2>;

template <int k>
void expect_order_k_everywhere() {
  const Errors order =
      observed_orders<Stepper<k>>(BLieDF2nd::Options{.k = k, .form = Form::stabilized_index2});
  EXPECT_NEAR(order.q, k, order_tolerance) << k;
  EXPECT_NEAR(order.v, k, order_tolerance) << k;
  EXPECT_NEAR(order.lambda, k, order_tolerance) << k;
  // No transient phase, from exact starting velocities.
  EXPECT_NEAR(order.largest_lambda, k, order_tolerance) << k;
}

TEST(StabilizedIndex2, BLieDF2ndHasOrderKInAllComponentsFromTheFirstStep) {
  expect_order_k_everywhere<2>();
  expect_order_k_everywhere<3>();
  expect_order_k_everywhere<4>();
}

TEST(StabilizedIndex2, BothConstraintsHoldInEveryStep) {
  const HeavyTopParameters p = slow_top();
  const Body system(p);
  const HeavyTopMotion motion(p, 0.6);
  const Extended h(1.0 / 256);
  Stepper<3> stepper(system, {.k = 3, .form = Form::stabilized_index2});
  ASSERT_EQ(stepper.start(h, exact_starting_points<Stepper<3>>(system, motion, h)).outcome, Outcome::ok);
  for (int n = 3; n <= 64; ++n) {
    ASSERT_EQ(stepper.step().outcome, Outcome::ok);
    const auto& q = stepper.configuration();
    // Newton ends at the round-off of 106 bits, divided by h in the position row.
    EXPECT_LE(to_double(system.constraint(q).norm()), 1e-29);
    EXPECT_LE(to_double((system.constraint_gradient(q) * stepper.velocity()).norm()), 1e-28);
  }
}

}  // namespace
}  // namespace liebench
