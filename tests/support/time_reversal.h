#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "integrators/consistent_projection.h"
#include "integrators/outcome.h"
#include "integrators/starting_values.h"
#include "tests/support/heavy_top_motion.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/steppers.h"

namespace liebench {

// A symmetric method comes back: so many steps of h, and as many of -h from where they end, are no step at all, but
// for round-off. It is that of every step, eps (|v| + |q| / h) in v (increments are known to eps |q| / h where a
// constraint gives them), through a matrix of condition below a hundred. A method that is not symmetric is off by its
// local errors, (h |v|)^3 |v| a step.
template <class Method, MechanicalSystem S>
void expect_time_reversal(const typename Method::Options& options) {
  constexpr double eps = std::numeric_limits<double>::epsilon();
  constexpr double h = 1.0 / 64;
  constexpr int steps = 32;
  const HeavyTopParameters p = unsymmetric_top(2);
  const S system(p);
  const HeavyTopMotion motion(p, 0.1);
  std::vector<SolutionPoint<S>> points{motion.point(system, Extended(0.0))};
  const auto forth = make_stepper<Method, S>(options, system);
  ASSERT_EQ(forth->start(h, points).outcome, Outcome::ok);
  ASSERT_EQ(forth->advance(steps).outcome, Outcome::ok);
  const Configuration<S> q = forth->configuration();
  const Velocity<S> v = forth->velocity();
  NoAudit unused;
  const auto consistent = consistent_dynamics(system, forth->time(), q, v, unused);
  ASSERT_TRUE(consistent);
  const std::vector<SolutionPoint<S>> end{
      {forth->time(), q, v, consistent->acceleration, forth->multipliers()}};
  const auto back = make_stepper<Method, S>(options, system);
  ASSERT_EQ(back->start(-h, end).outcome, Outcome::ok);
  ASSERT_EQ(back->advance(steps).outcome, Outcome::ok);
  const double speed = points[0].v.norm();
  const double tolerance = 100 * eps * (speed + 1 / h) * steps;
  ASSERT_LT(tolerance * 100, std::pow(h * speed, 3) * speed);
  EXPECT_NEAR(back->time(), 0.0, eps);
  EXPECT_LE(S::Group::separation(points[0].q, back->configuration()).norm(), tolerance) << Method::name;
  EXPECT_LE((back->velocity() - points[0].v).norm(), tolerance) << Method::name;
}

}  // namespace liebench
