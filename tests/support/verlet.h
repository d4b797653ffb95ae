#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>

#include "integrators/outcome.h"
#include "integrators/starting_values.h"
#include "tests/support/small_systems.h"
#include "tests/support/steppers.h"

namespace liebench {

// In a linear space nothing transports a momentum: the method of Stoermer & Verlet in its velocity form, with a force that depends on
// v at v = 2 Dq - v_n.
template <class Method>
void expect_verlets_method(const typename Method::Options& options) {
  using S = Oscillators<double, 2>;
  const S system;
  constexpr double h = 1.0 / 16;
  Eigen::Vector2d q = system.initial_configuration(), v = system.initial_velocity();
  const std::array points{SolutionPoint<S>{0.0, q, v, Eigen::Vector2d::Zero(), {}}};
  const auto stepper = make_stepper<Method, S>(options, system);
  ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
  const Eigen::Matrix2d W = system.mass_matrix(q).inverse();
  Eigen::Vector2d f = system.force(0.0, q, v);
  for (int step = 1; step <= 64; ++step) {
    const Eigen::Vector2d middle = v - h / 2 * W * f;
    q += h * middle;
    f = system.force(step * h, q, 2 * middle - v);
    v = middle - h / 2 * W * f;
    ASSERT_EQ(stepper->step().outcome, Outcome::ok);
    // A few roundings a step, of values of order one.
    ASSERT_LE((stepper->configuration() - q).norm(), 1e-14) << step;
    ASSERT_LE((stepper->velocity() - v).norm(), 1e-14) << step;
  }
}

}  // namespace liebench
