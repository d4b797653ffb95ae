#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "integrators/outcome.h"
#include "integrators/starting_values.h"
#include "tests/support/heavy_top_motion.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/steppers.h"

// Observed orders of an integrator on the slow top, in extended precision.

namespace liebench {

// Errors against the motion, or the orders in which they fall.
struct Errors {
  double q = 0, v = 0, lambda = 0;                          // at the end
  double largest_q = 0, largest_v = 0, largest_lambda = 0;  // over all steps
};

// Points of the motion at 0, h, 2 h, ..., as many as the stepper starts from.
template <MechanicalSystem S>
std::vector<SolutionPoint<S>> exact_starting_points(const S& system, const HeavyTopMotion& motion,
                                                    const typename S::Scalar& h, int count) {
  std::vector<SolutionPoint<S>> points;
  for (int j = 0; j < count; ++j) points.push_back(motion.point(system, Extended(h) * double(j)));
  return points;
}

// From exact points, or from the method's own starting procedure.
enum class Start { reference, self };

template <MechanicalSystem S>
Errors errors_at(double end, int steps, const HeavyTopMotion& motion, const S& system, AnyStepper<S>& stepper,
                 Start start) {
  using T = typename S::Scalar;
  const T h = T(end) / T(double(steps));
  auto points = exact_starting_points(system, motion, h, stepper.starting_points());
  const StepResult started =
      start == Start::self ? stepper.start_itself(h, points) : stepper.start(h, points);
  EXPECT_EQ(started.outcome, Outcome::ok);
  Errors e;
  for (int n = stepper.steps(); n <= steps; ++n) {
    const Outcome outcome = stepper.step().outcome;
    EXPECT_EQ(outcome, Outcome::ok) << n;
    if (outcome != Outcome::ok) break;
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

template <class Method, MechanicalSystem S>
Errors observed_orders(const typename Method::Options& options, Start start = Start::reference) {
  constexpr double end = 0.5;
  constexpr int steps = 1024;
  const HeavyTopParameters p = slow_top();
  const S system(p);
  static const HeavyTopMotion motion(p, 0.6);
  const auto errors = [&](int n) {
    return errors_at<S>(end, n, motion, system, *make_stepper<Method, S>(options, system), start);
  };
  const Errors coarse = errors(steps), fine = errors(2 * steps);
  const auto order = [&](double Errors::*error) { return std::log2(coarse.*error / fine.*error); };
  return {order(&Errors::q),         order(&Errors::v),         order(&Errors::lambda),
          order(&Errors::largest_q), order(&Errors::largest_v), order(&Errors::largest_lambda)};
}

}  // namespace liebench
