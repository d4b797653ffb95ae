#include "integrators/generalized_alpha.h"

#include <gtest/gtest.h>

#include <cmath>

#include "groups/extended.h"
#include "problems/heavy_top.h"
#include "tests/support/dense_algebra.h"
#include "tests/support/observed_order.h"
#include "tests/support/small_systems.h"

namespace liebench::generalized_alpha_test {

namespace {

template <class S>
using Stepper = GeneralizedAlpha::Stepper<S, Form::index3>;

template <class S>
Errors orders(const GeneralizedAlpha::Options& options) {
  return observed_orders<GeneralizedAlpha, S>(options);
}

TEST(GeneralizedAlpha, ParametersAreThoseOfChungAndHulbert) {
  for (const double rho : {0.0, 0.3, 0.9, 1.0}) {
    const GeneralizedAlphaParameters<double> p(rho);
    EXPECT_NEAR(p.gamma, 0.5 + p.alpha_f - p.alpha_m, 4e-16);
    EXPECT_NEAR(p.beta, 0.25 * (p.gamma + 0.5) * (p.gamma + 0.5), 4e-16);
  }
  const GeneralizedAlphaParameters<double> p(0.9);
  EXPECT_NEAR(p.alpha_m, 8.0 / 19, 1e-15);
  EXPECT_NEAR(p.alpha_f, 9.0 / 19, 1e-15);
  EXPECT_NEAR(p.gamma, 21.0 / 38, 1e-15);
  EXPECT_NEAR(p.beta, 100.0 / 361, 1e-15);
}

TEST(GeneralizedAlpha, HasOrderTwoWithoutConstraints) {
  for (const double rho : {0.0, 0.9, 1.0}) {
    const Errors order = orders<ExtendedSO3>({.rho_inf = rho});
    EXPECT_NEAR(order.q, 2, order_tolerance) << rho;
    EXPECT_NEAR(order.v, 2, order_tolerance) << rho;
  }
}

TEST(GeneralizedAlpha, LosesOneOrderOfLambdaInTheTransientPhase) {
  const Errors order = orders<ExtendedR3xSO3>({});
  EXPECT_NEAR(order.largest_q, 2, order_tolerance);
  EXPECT_NEAR(order.largest_v, 2, order_tolerance);
  EXPECT_NEAR(order.lambda, 2, order_tolerance);
  EXPECT_NEAR(order.largest_lambda, 1, order_tolerance);
}

TEST(GeneralizedAlpha, KeepsTheOrderOfLambdaFromAPerturbedStartingVelocity) {
  const Errors order = orders<ExtendedR3xSO3>({.modified_start = true});
  EXPECT_NEAR(order.largest_q, 2, order_tolerance);
  EXPECT_NEAR(order.largest_v, 2, order_tolerance);
  EXPECT_NEAR(order.lambda, 2, order_tolerance);
  EXPECT_NEAR(order.largest_lambda, 2, order_tolerance);
}

TEST(GeneralizedAlpha, HasOrderTwoEverywhereInTheStabilizedForm) {
  const Errors order = orders<ExtendedR3xSO3>({.form = Form::stabilized_index2});
  EXPECT_NEAR(order.largest_q, 2, order_tolerance);
  EXPECT_NEAR(order.largest_v, 2, order_tolerance);
  EXPECT_NEAR(order.largest_lambda, 2, order_tolerance);
}

// Chung & Hulbert's method on R^n, written in accelerations and solved by Newton's method with the exact matrix.
TEST(GeneralizedAlpha, IsChungAndHulbertsMethodOnALinearSpace) {
  constexpr int n = 3;
  using S = Oscillators<double, n>;
  using Vector = S::Vector;
  const S system;
  const double h = 0.05;
  const auto acceleration = [&](double t, const Vector& q, const Vector& v) -> Vector {
    return -dense_solution(system.mass_matrix(q), system.force(t, q, v));
  };
  for (const double rho : {0.0, 0.5, 0.9, 1.0}) {
    const GeneralizedAlphaParameters<double> p(rho);
    Vector q = system.initial_configuration(), v = system.initial_velocity();
    Vector vdot = acceleration(0.0, q, v);
    const Vector jerk = (acceleration(h, q + h * v + h * h / 2 * vdot, v + h * vdot) -
                         acceleration(-h, q - h * v + h * h / 2 * vdot, v - h * vdot)) /
                        2;
    Vector a = vdot + (p.alpha_m - p.alpha_f) * jerk;
    std::array<SolutionPoint<S>, 1> start;
    start[0].t = 0.0;
    start[0].q = q;
    start[0].v = v;
    start[0].acceleration = vdot;
    Stepper<S> stepper(system, {.rho_inf = rho});
    ASSERT_EQ(stepper.start(h, start).outcome, Outcome::ok);
    for (int step = 1; step <= 40; ++step) {
      ASSERT_EQ(stepper.step().outcome, Outcome::ok);
      Vector next = a;
      Vector q1, v1, vdot1;
      for (int i = 0; i < 20; ++i) {
        q1 = q + h * v + h * h * ((0.5 - p.beta) * a + p.beta * next);
        v1 = v + h * ((1 - p.gamma) * a + p.gamma * next);
        vdot1 = ((1 - p.alpha_m) * next + p.alpha_m * a - p.alpha_f * vdot) / (1 - p.alpha_f);
        const Vector r = system.mass_matrix(q1) * vdot1 + system.force(step * h, q1, v1);
        const S::Matrix J = system.mass_matrix(q1) * ((1 - p.alpha_m) / (1 - p.alpha_f)) +
                            h * p.gamma * system.damping(step * h, q1, v1) +
                            h * h * p.beta * system.stiffness(step * h, q1, v1, vdot1, {});
        next -= dense_solution(J, r);
      }
      q = q1;
      v = v1;
      vdot = vdot1;
      a = next;
      // Round-off of 40 steps, in values of order 1, through a matrix of condition below 10.
      EXPECT_LE((stepper.configuration() - q).norm(), 1e-13) << rho << ' ' << step;
      EXPECT_LE((stepper.velocity() - v).norm(), 1e-12) << rho << ' ' << step;
    }
  }
}

TEST(GeneralizedAlpha, ConstantVelocityGivesTheExponentialExactly) {
  HeavyTopParameters p;
  p.gravity = {0, 0, 0};
  p.angular_velocity = {0, 3, 0};
  using S = HeavyTopSO3<double>;
  const S system(p);
  std::array<SolutionPoint<S>, 1> start{
      {{0.0, system.initial_configuration(), system.initial_velocity(), Eigen::Vector3d::Zero(), {}}}};
  Stepper<S> stepper(system, {});
  ASSERT_EQ(stepper.start(0.125, start).outcome, Outcome::ok);
  for (int n = 1; n <= 16; ++n) {
    ASSERT_EQ(stepper.step().outcome, Outcome::ok);
    EXPECT_EQ(stepper.velocity(), system.initial_velocity());
  }
  const Eigen::Matrix3d exact = SO3<double>::exp(Eigen::Vector3d(0, 6, 0));
  // One rounding of a product of rotations a step.
  EXPECT_LE((stepper.configuration() - exact).norm(), 16 * 4e-16);
}

}  // namespace
}  // namespace liebench::generalized_alpha_test
