#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "integrators/outcome.h"
#include "integrators/starting_values.h"
#include "tests/support/heavy_top_motion.h"
#include "tests/support/heavy_top_samples.h"

// Observed orders of an integrator on the slow top, in extended precision.

namespace liebench {

// Errors against the motion, or the orders in which they fall.
struct Errors {
  double q = 0, v = 0, lambda = 0;                          // at the end
  double largest_q = 0, largest_v = 0, largest_lambda = 0;  // over all steps
};

template <class Stepper>
std::array<SolutionPoint<typename Stepper::System>, Stepper::starting_points> exact_starting_points(
    const typename Stepper::System& system, const HeavyTopMotion& motion, const typename Stepper::T& h) {
  std::array<SolutionPoint<typename Stepper::System>, Stepper::starting_points> points;
  for (std::size_t j = 0; j < points.size(); ++j) points[j] = motion.point(system, Extended(h) * double(j));
  return points;
}

template <class Stepper, class Options>
Errors errors_at(double end, int steps, const HeavyTopMotion& motion, const HeavyTopParameters& p,
                 const Options& options) {
  using S = typename Stepper::System;
  using T = typename Stepper::T;
  const S system(p);
  const T h = T(end) / T(double(steps));
  Stepper stepper(system, options);
  EXPECT_EQ(stepper.start(h, exact_starting_points<Stepper>(system, motion, h)).outcome, Outcome::ok);
  Errors e;
  for (int n = Stepper::steps; n <= steps; ++n) {
    EXPECT_EQ(stepper.step().outcome, Outcome::ok) << n;
    if (S::constraints == 0 && n < steps) continue;
    const auto exact = motion.point(system, Extended(h) * double(n));
    e.q = S::Group::separation(exact.q, stepper.configuration()).norm();
    e.v = to_double((stepper.velocity() - exact.v).norm());
    e.lambda = to_double((stepper.multipliers() - exact.lambda).norm());
    e.largest_q = std::max(e.largest_q, e.q);
    e.largest_v = std::max(e.largest_v, e.v);
    e.largest_lambda = std::max(e.largest_lambda, e.lambda);
  }
  return e;
}

// The slow top (|Omega| = 4.3 rad/s) over 1/2 s with 1024 and 2048 steps, the same for all methods: log2 of the ratio
// of the errors at h and h / 2. Where the error is C h^p (1 + c h + ...), the order seen is p + c h log2(e) / 2: within
// 0.1 of p for c up to 285 /s = 65 |Omega|. (The largest seen, in lambda of BLieDF2nd without L_k, is 40 |Omega|.)
inline constexpr double order_tolerance = 0.1;

template <class Stepper, class Options>
Errors observed_orders(const Options& options) {
  constexpr double end = 0.5;
  constexpr int steps = 1024;
  const HeavyTopParameters p = slow_top();
  static const HeavyTopMotion motion(p, 0.6);
  const Errors coarse = errors_at<Stepper>(end, steps, motion, p, options);
  const Errors fine = errors_at<Stepper>(end, 2 * steps, motion, p, options);
  const auto order = [&](double Errors::*error) { return std::log2(coarse.*error / fine.*error); };
  return {order(&Errors::q),         order(&Errors::v),         order(&Errors::lambda),
          order(&Errors::largest_q), order(&Errors::largest_v), order(&Errors::largest_lambda)};
}

}  // namespace liebench
