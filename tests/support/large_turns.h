#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/spinning_up.h"
#include "tests/support/steppers.h"

// How far a multistep method may turn, where its logarithms span several steps.

namespace liebench {

// What ends `steps` steps of a body that spins freely by `turn` in each of them.
template <class Method>
Outcome outcome_of_spin(const typename Method::Options& options, double turn, int steps) {
  using S = HeavyTopSO3<double>;
  HeavyTopParameters p;
  p.gravity = {0, 0, 0};
  p.angular_velocity = {0, 8, 0};
  const S system(p);
  const double h = turn / 8;
  const auto stepper = make_stepper<Method, S>(options, system);
  std::vector<SolutionPoint<S>> points;
  for (int j = 0; j < stepper->starting_points(); ++j)
    points.push_back({j * h,
                      SO3<double>::exp(j * h * system.initial_velocity()),
                      system.initial_velocity(),
                      Eigen::Vector3d::Zero(),
                      {}});
  Outcome outcome = stepper->start(h, points).outcome;
  for (int n = 0; n < steps && outcome == Outcome::ok; ++n) {
    outcome = stepper->step().outcome;
    if (outcome != Outcome::ok) break;
    // The right branch: a wrong one is off by 2 pi / h.
    EXPECT_LE((stepper->velocity() - system.initial_velocity()).norm(), 1e-12) << options.k << ' ' << turn;
  }
  return outcome;
}

template <class Method>
void expect_limit_of_spin(const typename Method::Options& options, double limit) {
  EXPECT_EQ(outcome_of_spin<Method>(options, 0.99 * limit, 8), Outcome::ok) << options.k;
  EXPECT_EQ(outcome_of_spin<Method>(options, 1.01 * limit, 8), Outcome::rotation_too_large) << options.k;
}

// omega = omega_0 + a t about one axis, where every increment is the mean of omega over its step up to O(h^2): ends
// with rotation_too_large at the first step for which a logarithm spans pi, of so many steps before the last point and
// `ahead` behind it.
template <class Method>
void expect_stop_where_logarithms_span_pi(const typename Method::Options& options, int before, int ahead) {
  using S = SpinningUp<double>;
  const S system;
  const double h = 0.125, increase = S::acceleration * h;
  const auto stepper = make_stepper<Method, S>(options, system);
  std::vector<SolutionPoint<S>> points;
  for (int j = 0; j < stepper->starting_points(); ++j) points.push_back(spinning_up_point(j * h));
  ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
  int n = stepper->steps() - 1;  // the steps so far
  Outcome outcome = Outcome::ok;
  for (; n < 200; ++n) {
    outcome = stepper->step().outcome;
    if (outcome != Outcome::ok) break;
    EXPECT_LE((stepper->velocity() - spinning_up_point((n + 1) * h).v).norm(), 1e-11) << n;
  }
  EXPECT_EQ(outcome, Outcome::rotation_too_large) << options.k;
  const int spanned = before + ahead;
  const double omega = spinning_up_point(n * h).v.norm() + 0.5 * (ahead - before) * increase;  // their mean
  EXPECT_NEAR(spanned * h * omega, std::numbers::pi, 2 * spanned * h * increase) << options.k;
  EXPECT_EQ(stepper->time(), n * h);
}

}  // namespace liebench
