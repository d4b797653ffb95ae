#include "integrators/rattlie.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "groups/extended.h"
#include "integrators/generalized_alpha.h"
#include "problems/heavy_top.h"
#include "tests/support/dense_algebra.h"
#include "tests/support/observed_order.h"
#include "tests/support/small_systems.h"
#include "tests/support/steppers.h"
#include "tests/support/time_reversal.h"
#include "tests/support/verlet.h"

namespace liebench::rattlie_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

// --- orders ------------------------------------------------------------------------------------------------

TEST(Rattlie, HasOrderTwoWithoutConstraints) {
  const Errors order = observed_orders<Rattlie, ExtendedSO3>({});
  EXPECT_NEAR(order.q, 2, order_tolerance);
  EXPECT_NEAR(order.v, 2, order_tolerance);
}

TEST(Rattlie, HasOrderTwoWithConstraintsFromTheFirstStepOn) {
  const Errors order = observed_orders<Rattlie, ExtendedR3xSO3>({});
  EXPECT_NEAR(order.q, 2, order_tolerance);
  EXPECT_NEAR(order.v, 2, order_tolerance);
  EXPECT_NEAR(order.lambda, 2, order_tolerance);
  EXPECT_NEAR(order.largest_q, 2, order_tolerance);
  EXPECT_NEAR(order.largest_v, 2, order_tolerance);
  EXPECT_NEAR(order.largest_lambda, 2, order_tolerance);
}

TEST(Rattlie, HasOrderTwoOnRigidMotions) {
  const Errors order = observed_orders<Rattlie, ExtendedSE3>({});
  EXPECT_NEAR(order.largest_q, 2, order_tolerance);
  EXPECT_NEAR(order.largest_v, 2, order_tolerance);
  EXPECT_NEAR(order.largest_lambda, 2, order_tolerance);
}

// --- the equations, from the states alone ------------------------------------------------------------------

template <MechanicalSystem S>
struct State {
  Configuration<S> q;
  Velocity<S> v;
  Multipliers<S> lambda;
};

template <MechanicalSystem S>
std::vector<State<S>> states_of_steps(const S& system, const HeavyTopParameters& p, double h, int steps) {
  const HeavyTopMotion motion(p, 0.1);
  const std::vector<SolutionPoint<S>> points{motion.point(system, Extended(0.0))};
  const auto stepper = make_stepper<Rattlie, S>({}, system);
  EXPECT_EQ(stepper->start(h, points).outcome, Outcome::ok);
  std::vector<State<S>> states{{points[0].q, points[0].v, points[0].lambda}};
  for (int n = 0; n < steps; ++n) {
    EXPECT_EQ(stepper->step().outcome, Outcome::ok);
    states.push_back({stepper->configuration(), stepper->velocity(), stepper->multipliers()});
  }
  return states;
}

// T(u)^{-T} M log(q_n^{-1} q_{n+1}) / h at the end of a step, and the same of -u at its beginning, by matrices.
template <MechanicalSystem S>
struct Momenta {
  Eigen::VectorXd before, behind;
  Momenta(const S& system, const Configuration<S>& q, const Configuration<S>& next, double h) {
    using G = typename S::Group;
    const Velocity<S> u = G::log(G::compose(G::inverse(q), next));
    const Eigen::VectorXd p = system.mass_matrix(q) * u / h;
    before = dense_solution(G::tangent(-u).transpose(), p);
    behind = dense_solution(G::tangent(u).transpose(), p);
  }
};

// f: the applied force, the gyroscopic term vanishes at v = 0.
template <MechanicalSystem S>
Eigen::VectorXd applied(const S& system, const Configuration<S>& q) {
  return system.force(0.0, q, zero_velocity(system));
}

template <class S>
void expect_the_free_equations() {
  const HeavyTopParameters p = unsymmetric_top(1);
  const S system(p);
  constexpr double h = 1.0 / 32;
  const auto states = states_of_steps(system, p, h, 16);
  const double momentum = system.momentum(states[0].q, states[0].v).norm();
  // log is known to eps; the condition of J is below ten.
  const double tolerance = 100 * eps * momentum * (1 + 1 / (h * states[0].v.norm()));
  for (std::size_t n = 0; n + 1 < states.size(); ++n) {
    const Momenta<S> middle(system, states[n].q, states[n + 1].q, h);
    const Eigen::VectorXd p_n = system.momentum(states[n].q, states[n].v);
    const Eigen::VectorXd p_next = system.momentum(states[n + 1].q, states[n + 1].v);
    EXPECT_LE((middle.before + h / 2 * applied(system, states[n].q) - p_n).norm(), tolerance) << n;
    EXPECT_LE((middle.behind - h / 2 * applied(system, states[n + 1].q) - p_next).norm(), tolerance) << n;
  }
}

TEST(Rattlie, SatisfiesItsEquationsWithoutConstraints) {
  expect_the_free_equations<HeavyTopSO3<double>>();
  expect_the_free_equations<HeavyTopS3<double>>();
}

// Both impulses at q_n together are h lambda_n: the balance of two steps has no v_n. Of the projection what B^T does
// not make.
template <class S>
void expect_the_constrained_equations() {
  const HeavyTopParameters p = unsymmetric_top(1);
  const S system(p);
  constexpr double h = 1.0 / 32;
  const auto states = states_of_steps(system, p, h, 16);
  const double momentum = system.momentum(states[0].q, states[0].v).norm();
  const double tolerance = 1000 * eps * momentum * (1 + 1 / h);
  for (std::size_t n = 1; n < states.size(); ++n) {
    const State<S>& s = states[n];
    const Momenta<S> before(system, states[n - 1].q, s.q, h);
    EXPECT_LE(system.constraint(s.q).norm(), 32 * eps) << n;
    const Eigen::MatrixXd B = system.constraint_gradient(s.q);
    EXPECT_LE((B * s.v).norm(), 100 * eps * (1 + s.v.norm())) << n;
    const Eigen::VectorXd rest =
        Eigen::VectorXd(system.momentum(s.q, s.v)) - before.behind + h / 2 * applied(system, s.q);
    const Eigen::VectorXd inside = B.transpose() * dense_solution(B * B.transpose(), B * rest);
    EXPECT_LE((rest - inside).norm(), tolerance) << n;
    if (n + 1 == states.size()) break;
    const Momenta<S> behind(system, s.q, states[n + 1].q, h);
    const Eigen::VectorXd balance =
        behind.before - before.behind + h * (applied(system, s.q) + B.transpose() * s.lambda);
    EXPECT_LE(balance.norm(), tolerance) << n;
  }
}

TEST(Rattlie, SatisfiesItsEquationsWithConstraints) {
  expect_the_constrained_equations<HeavyTopR3xSO3<double>>();
  expect_the_constrained_equations<HeavyTopSE3<double>>();
  expect_the_constrained_equations<HeavyTopUDQ<double>>();
}

// --- symmetry ----------------------------------------------------------------------------------------------

TEST(Rattlie, ComesBackInReversedTimeOnSE3Too) {
  expect_time_reversal<Rattlie, HeavyTopSE3<double>>();
}

// --- linear spaces -----------------------------------------------------------------------------------------

TEST(Rattlie, IsVerletsMethodInALinearSpace) {
  expect_verlets_method<Rattlie>({});
}

// The forces of damping leave the order at two.
TEST(Rattlie, HasOrderTwoWithForcesThatDependOnTheVelocity) {
  using S = Oscillators<double, 2>;
  const S system;
  const auto end = [&](int steps) {
    const std::array points{SolutionPoint<S>{
        0.0, system.initial_configuration(), system.initial_velocity(), Eigen::Vector2d::Zero(), {}}};
    const auto stepper = make_stepper<Rattlie, S>({}, system);
    EXPECT_EQ(stepper->start(2.0 / steps, points).outcome, Outcome::ok);
    EXPECT_EQ(stepper->advance(std::uint64_t(steps)).outcome, Outcome::ok);
    Eigen::Vector4d state;
    state << stepper->configuration(), stepper->velocity();
    return state;
  };
  const Eigen::Vector4d coarse = end(256), middle = end(512), fine = end(1024);
  EXPECT_NEAR(std::log2((coarse - middle).norm() / (middle - fine).norm()), 2, order_tolerance);
}

// RATTLE [Andersen 1983] for a pendulum: the impulse is the root of a quadratic equation.
TEST(Rattlie, IsRattleInALinearSpace) {
  using S = Particle<double, Circle>;
  const double mass = 1.5;
  const S system(mass, ParticleForce::spring_behind_a_wall);
  constexpr double h = 1.0 / 32;
  Eigen::Vector2d q = system.initial_configuration(), v = system.initial_velocity();
  const std::array points{SolutionPoint<S>{0.0, q, v, Eigen::Vector2d::Zero(), Multipliers<S>(mass)}};
  const auto stepper = make_stepper<Rattlie, S>({}, system);
  ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
  double behind = 0.0;  // lambda^-_n
  for (int step = 0; step <= 64; ++step) {
    // |q + h (v - h / (2 m) f) - s q| = 1, s = h^2 lambda^+ / (2 m)
    const Eigen::Vector2d free = q + h * (v - h / (2 * mass) * system.force(0.0, q, v));
    const double b = free.dot(q);
    const double s = b - std::sqrt(b * b - free.squaredNorm() + 1.0);
    const double ahead = 2 * mass * s / (h * h);
    // h lambda is known to m eps / h, and to what v is off by.
    if (step > 0) {
      ASSERT_NEAR(stepper->multipliers()(0), (behind + ahead) / 2, 64 * 16 * eps * 2 * mass / (h * h))
          << step;
    }
    const Eigen::Vector2d next = free - s * q;
    const Eigen::Vector2d kicked = (next - q) / h - h / (2 * mass) * system.force(0.0, next, v);
    behind = 2 * mass / h * kicked.dot(next);
    v = kicked - kicked.dot(next) * next;
    q = next;
    ASSERT_EQ(stepper->step().outcome, Outcome::ok);
    // Round-off of Phi, eps, is one of eps / h in v, and adds up over the steps.
    ASSERT_LE((stepper->configuration() - q).norm(), 64 * 16 * eps) << step;
    ASSERT_LE((stepper->velocity() - v).norm(), 64 * 16 * eps / h) << step;
  }
}

// --- errors ------------------------------------------------------------------------------------------------

// Of the fast top at t = 1/2 s with h = 2^-12: the rotation vector between the solution and the exact one.
template <class Method, class S>
double rotation_error(const typename Method::Options& options) {
  const HeavyTopParameters p;
  static const HeavyTopMotion motion(p, 0.5);
  const S system(p);
  const auto stepper = make_stepper<Method, S>(options, system);
  const std::vector<SolutionPoint<S>> points{motion.point(system, Extended(0.0))};
  EXPECT_EQ(stepper->start(0x1p-12, points).outcome, Outcome::ok);
  EXPECT_EQ(stepper->advance(2048).outcome, Outcome::ok);
  const auto exact = motion.point(system, Extended(0.5));
  return S::Group::separation(exact.q, stepper->configuration()).template tail<3>().norm();
}

TEST(Rattlie, HasAFewPercentOfTheErrorOfGeneralizedAlpha) {
  const double free = rotation_error<Rattlie, HeavyTopSO3<double>>({});
  const double constrained = rotation_error<Rattlie, HeavyTopR3xSO3<double>>({});
  const double other = rotation_error<GeneralizedAlpha, HeavyTopR3xSO3<double>>({});
  // As found by another implementation, to the digits that were kept of it.
  EXPECT_NEAR(free, 4.6e-4, 0.06e-4);
  EXPECT_NEAR(constrained, 2.2e-5, 0.06e-5);
  EXPECT_NEAR(other / constrained, 20, 2);
}

}  // namespace
}  // namespace liebench::rattlie_test
