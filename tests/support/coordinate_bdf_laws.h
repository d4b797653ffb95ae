#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/support/heavy_top_motion.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/observed_order.h"
#include "tests/support/steppers.h"

// Laws of the BDF methods in canonical coordinates. A Law<S> says what a step is, from the states alone: a BdfStepLaw
// (tests/support/step_law.h) with Law(system, h, options) and
//
//   kinematics(extra)   v_{n+1} of the kinematic equation for Dq_n + extra, minus v_{n+1}

namespace liebench {

template <class T>
double unit_of() {
  return to_double(Eigen::NumTraits<T>::epsilon());
}

template <class Method, template <class> class Law, class S>
void expect_steps_satisfy_the_equations(const HeavyTopParameters& p, const typename Method::Options& options,
                                        const std::string& text) {
  using T = typename S::Scalar;
  const double unit = unit_of<T>();
  const S system(p);
  const T h(1.0 / 64);
  constexpr int steps = 40;
  const HeavyTopMotion motion(p, 0.8);
  const auto stepper = make_stepper<Method, S>(options, system);
  const int k = options.k;
  const auto points = exact_starting_points(system, motion, h, stepper->starting_points());
  ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
  Law<S> law(system, h, options);
  // Eq. (56) moves every starting velocity by the same vector, which the last of them shows.
  const Velocity<S> moved = stepper->velocity() - points[std::size_t(k - 1)].v;
  for (int j = 0; j < k; ++j) law.push(points[std::size_t(j)].q, points[std::size_t(j)].v + moved);

  // As for BLieDF2nd: logarithms are known to eps, increments to eps / h, differences accumulate them over the steps.
  const double speed = 1 + to_double(stepper->velocity().norm());
  const double mass = to_double(VelocityMatrix<S>(system.mass_matrix(points[0].q)).norm());
  const double kinematic = 64 * steps * unit * (speed + 2 / to_double(h));
  const double dynamic = 64 * steps * unit * mass * (speed + 2 / to_double(h));
  for (int n = k; n < k + steps; ++n) {
    ASSERT_EQ(stepper->step().outcome, Outcome::ok) << text << ", step " << n;
    law.push(stepper->configuration(), stepper->velocity());
    Velocity<S> defect = law.kinematics(Velocity<S>::Constant(T(0.0)));
    if constexpr (S::constraints > 0) {
      const auto& q = stepper->configuration();
      EXPECT_LE(to_double(system.constraint(q).norm()), 64 * unit) << text << ", step " << n;
      if (options.form == Form::stabilized_index2) {
        // The velocity is known to what the increments are.
        const Multipliers<S> hidden = system.constraint_gradient(q) * stepper->velocity();
        EXPECT_LE(to_double(hidden.norm()), 64 * unit * (speed + 1 / to_double(h))) << text << ", step " << n;
        // eta by fixed-point sweeps, each of which gains h |v| = 0.1 at least; six equations, three unknowns.
        Velocity<S> extra = Velocity<S>::Constant(T(0.0));
        for (int sweep = 0; sweep < 40; ++sweep) {
          extra -= (defect - law.without_auxiliary_multiplier(defect)) / law.gamma(1);
          defect = law.kinematics(extra);
        }
      }
    }
    EXPECT_LE(to_double(defect.norm()), kinematic) << text << ", step " << n;
    EXPECT_LE(to_double(law.dynamics(stepper->time(), stepper->multipliers()).norm()), dynamic)
        << text << ", step " << n;
  }
}

// Eq. (56) with the local error of the method: B Dv = B l / h, M Dv in the range of B^T.
template <class Method, template <class> class Law>
void expect_modified_start_takes_the_local_error(const typename Method::Options& options,
                                                 const std::string& text) {
  using S = ExtendedR3xSO3;
  const HeavyTopParameters p = unsymmetric_top(1);
  const S system(p);
  const Extended h(1.0 / 64);
  const HeavyTopMotion motion(p, 0.2);
  const auto stepper = make_stepper<Method, S>(options, system);
  const auto points = exact_starting_points(system, motion, h, options.k + 1);
  ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
  const SolutionPoint<S>& last = points[std::size_t(options.k - 1)];
  const Velocity<S> moved = stepper->velocity() - last.v;
  Law<S> law(system, h, options);
  for (const SolutionPoint<S>& point : points) law.push(point.q, point.v);
  const Velocity<S> local_error = law.kinematics(Velocity<S>::Constant(Extended(0.0)));
  const auto B = system.constraint_gradient(last.q);
  const double scale = unit_of<Extended>() * 1e4 / to_double(h);
  EXPECT_LE(to_double((B * (moved - local_error)).norm()), scale) << text;
  EXPECT_LE(std::abs(to_double(Extended(system.momentum(last.q, moved).dot(last.v)))), 100 * scale) << text;
  EXPECT_GT(to_double(moved.norm()), 1e-12) << text;
}

}  // namespace liebench
