#include <gtest/gtest.h>

#include <array>

#include "integrators/bliedf2nd.h"
#include "tests/support/observed_order.h"

namespace liebench::bliedf2nd_orders_test {

namespace {

constexpr int most_steps = 6;

template <class S>
Errors orders(const BLieDF2nd::Options& options) {
  return observed_orders<BLieDF2nd, S>(options);
}

// Order k of q, v and lambda at the end. From k = 5 on q is taken over all steps: its error is next to a zero at the end
// (k = 6: a hundredth of the largest), which says nothing of its order.
void expect_orders_at_the_end(const Errors& order, int k) {
  EXPECT_NEAR(order.largest_q, k, order_tolerance) << k;
  if (k <= 4) {
    EXPECT_NEAR(order.q, k, order_tolerance) << k;
  }
  EXPECT_NEAR(order.v, k, order_tolerance) << k;
  EXPECT_NEAR(order.lambda, k, order_tolerance) << k;
}

// Calls f(options) with both kinds of L_k; for k <= 2 there is none.
template <class F>
void for_every_corrected(int least, const BLieDF2nd::Options& others, const F& f) {
  for (int k = least; k <= most_steps; ++k)
    for (const Correction correction : {Correction::explicit_term, Correction::implicit_term}) {
      if (k < 3 && correction == Correction::implicit_term) continue;
      BLieDF2nd::Options options = others;
      options.k = k;
      options.correction = correction;
      f(options);
    }
}

TEST(BLieDF2nd, HasOrderKInConfigurationAndVelocity) {
  for_every_corrected(1, {}, [](const BLieDF2nd::Options& options) {
    const Errors order = orders<ExtendedSO3>(options);
    EXPECT_NEAR(order.q, options.k, order_tolerance);
    EXPECT_NEAR(order.v, options.k, order_tolerance);
  });
}

TEST(BLieDF2nd, HasOrderTwoOnlyWithoutItsCorrection) {
  // A correction of the wrong sign has this order too: with L_k the orders here are above two.
  for (int k = 3; k <= most_steps; ++k) {
    const Errors rotation = orders<ExtendedSO3>({.k = k, .correction = Correction::none});
    EXPECT_NEAR(rotation.q, 2, order_tolerance) << k;
    EXPECT_NEAR(rotation.v, 2, order_tolerance) << k;
    const Errors body = orders<ExtendedR3xSO3>({.k = k, .correction = Correction::none});
    EXPECT_NEAR(body.q, 2, order_tolerance) << k;
    EXPECT_NEAR(body.v, 2, order_tolerance) << k;
    EXPECT_NEAR(body.lambda, 2, order_tolerance) << k;
  }
}

TEST(BLieDF2nd, HasOrderKWithConstraintsButForLambdaInTheTransientPhase) {
  for_every_corrected(1, {}, [](const BLieDF2nd::Options& options) {
    const int k = options.k;
    const Errors order = orders<ExtendedR3xSO3>(options);
    expect_orders_at_the_end(order, k);
    // With one step the error of lambda is O(1) there.
    EXPECT_NEAR(order.largest_lambda, k - 1, order_tolerance) << k;
  });
}

TEST(BLieDF2nd, KeepsTheOrderOfLambdaFromModifiedStartingVelocities) {
  for_every_corrected(2, {.modified_start = true}, [](const BLieDF2nd::Options& options) {
    const int k = options.k;
    const Errors order = orders<ExtendedR3xSO3>(options);
    expect_orders_at_the_end(order, k);
    EXPECT_NEAR(order.largest_lambda, k, order_tolerance) << k;
  });
}

TEST(BLieDF2nd, HasOrderKInAllComponentsFromTheFirstStepInTheStabilizedForm) {
  for_every_corrected(2, {.form = Form::stabilized_index2}, [](const BLieDF2nd::Options& options) {
    const int k = options.k;
    const Errors order = orders<ExtendedR3xSO3>(options);
    expect_orders_at_the_end(order, k);
    // No transient phase, from exact starting velocities.
    EXPECT_NEAR(order.largest_lambda, k, order_tolerance) << k;
  });
}

}  // namespace
}  // namespace liebench::bliedf2nd_orders_test
