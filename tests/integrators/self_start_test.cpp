#include "integrators/self_start.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "groups/extended.h"
#include "integrators/list.h"
#include "problems/audited_system.h"
#include "problems/heavy_top.h"
#include "problems/linear_oscillator.h"
#include "tests/support/heavy_top_motion.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/observed_order.h"
#include "tests/support/small_systems.h"

namespace liebench::self_start_test {
namespace {

// --- the Runge-Kutta-Munthe-Kaas step --------------------------------------------------------------------

// Errors at t = 1/2 in q and v.
template <class S>
std::array<double, 2> runge_kutta_errors(const HeavyTopMotion& motion, const S& system, int steps) {
  using T = typename S::Scalar;
  const T h = T(0.5) / T(double(steps));
  auto start = motion.point(system, Extended(0.0));
  NoAudit audit;
  for (int n = 0; n < steps; ++n)
    EXPECT_EQ(index1_step(system, T(h * T(double(n))), h, start.q, start.v, audit).result.outcome,
              Outcome::ok);
  const auto exact = motion.point(system, Extended(0.5));
  return {S::Group::separation(exact.q, start.q).norm(), to_double((start.v - exact.v).norm())};
}

template <class S>
void expect_order_six() {
  // h |Omega| = 0.033 and 0.017; the order seen is within 0.1 of 6 where the next term is below 8 |Omega| h.
  const HeavyTopParameters p = slow_top();
  const S system(p);
  const HeavyTopMotion motion(p, 0.6);
  const auto coarse = runge_kutta_errors(motion, system, 64), fine = runge_kutta_errors(motion, system, 128);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(std::log2(coarse[i] / fine[i]), 6, 0.1) << i;
}

TEST(RungeKuttaMuntheKaas, HasOrderSix) {
  expect_order_six<ExtendedSO3>();
  expect_order_six<ExtendedR3xSO3>();
}

TEST(RungeKuttaMuntheKaas, CountsSevenEvaluationsOfTheDynamicsAStep) {
  const auto check = [](const auto& unaudited) {
    const Audited system(unaudited);
    const SystemCalls before = SystemCalls::counts();
    const GroupCalls calls_before = GroupCalls::counts();
    KernelAudit audit;
    auto q = system.initial_configuration();
    auto v = system.initial_velocity();
    EXPECT_EQ(index1_step(system, 0.0, 0.01, q, v, audit).result.outcome, Outcome::ok);
    const SystemCalls evaluations = SystemCalls::counts() - before;
    const GroupCalls calls = GroupCalls::counts() - calls_before;
    EXPECT_EQ(evaluations.forces, 7u);
    EXPECT_EQ(evaluations.stiffnesses, 0u);
    // The first stage is at q_n.
    EXPECT_EQ(calls.exp, 7u);
    EXPECT_EQ(calls.tangent_inverse, 6u);
    EXPECT_EQ(calls.log + calls.tangent + calls.commutators, 0u);
    EXPECT_EQ(audit.factorizations, 7u);
    EXPECT_EQ(audit.factorizations_start, 7u);
    EXPECT_EQ(audit.solves, std::uint64_t(7 * refinement_passes<double>));
  };
  check(HeavyTopSO3<double>(slow_top()));
  check(HeavyTopR3xSO3<double>(slow_top()));
}

// --- starting points -------------------------------------------------------------------------------------

template <class S, class Audit>
std::vector<SolutionPoint<S>> starting_points(const S& system, const typename S::Scalar& h, int count,
                                              Audit& audit) {
  std::vector<SolutionPoint<S>> points(static_cast<std::size_t>(count));
  EXPECT_EQ(self_start<S>(system, typename S::Scalar(0.0), h, points, audit).outcome, Outcome::ok);
  return points;
}

template <class S>
void expect_points_on_the_motion() {
  using T = typename S::Scalar;
  const HeavyTopParameters p = slow_top();
  const S system(p);
  const HeavyTopMotion motion(p, 0.2);
  const T h(1.0 / 64);
  NoAudit audit;
  const auto points = starting_points(system, h, 7, audit);
  for (std::size_t j = 0; j < points.size(); ++j) {
    const auto exact = motion.point(system, Extended(h) * double(j));
    EXPECT_EQ(to_double(T(points[j].t - exact.t)), 0.0);
    // (h |Omega|)^7 = 6e-9, over the factorial of 7 and more, for each step; lambda and v' see v through forces of up to
    // 15 kg times 10 rad/s.
    const double step = 1e-10 * double(j) + 64 * to_double(Eigen::NumTraits<T>::epsilon());
    EXPECT_LE(S::Group::separation(exact.q, points[j].q).norm(), step) << j;
    EXPECT_LE(to_double((points[j].v - exact.v).norm()), 10 * step) << j;
    EXPECT_LE(to_double((points[j].acceleration - exact.acceleration).norm()), 1e3 * step) << j;
    EXPECT_LE(to_double((points[j].lambda - exact.lambda).norm()), 1e4 * step) << j;
  }
}

TEST(SelfStart, PointsAreThoseOfTheMotionAndConsistent) {
  expect_points_on_the_motion<HeavyTopSO3<double>>();
  expect_points_on_the_motion<HeavyTopR3xSO3<double>>();
  expect_points_on_the_motion<ExtendedR3xSO3>();
}

template <class S>
void expect_points_on_the_constraints(const S& system) {
  using T = typename S::Scalar;
  const double eps = to_double(Eigen::NumTraits<T>::epsilon());
  NoAudit audit;
  for (const SolutionPoint<S>& point : starting_points(system, T(1.0 / 64), 7, audit)) {
    EXPECT_LE(to_double(system.constraint(point.q).norm()), 16 * eps);
    const Multipliers<S> hidden = system.constraint_gradient(point.q) * point.v;
    EXPECT_LE(to_double(hidden.norm()), 32 * eps * (1 + to_double(point.v.norm())));
    const Multipliers<S> second = system.constraint_gradient(point.q) * point.acceleration +
                                  system.constraint_curvature(point.q, point.v);
    EXPECT_LE(to_double(second.norm()),
              64 * eps * (1 + to_double(point.acceleration.norm()) + to_double(point.v.squaredNorm())));
  }
}

TEST(SelfStart, PointsSatisfyTheConstraintAndItsDerivativesToRoundOff) {
  for (const HeavyTopParameters& p : {slow_top(), unsymmetric_top(1), unsymmetric_top(2)}) {
    expect_points_on_the_constraints(HeavyTopR3xSO3<double>(p));
    expect_points_on_the_constraints(ExtendedR3xSO3(p));
  }
}

// The top with initial values off both constraints.
struct DisplacedTop : HeavyTopR3xSO3<double> {
  DisplacedTop() : HeavyTopR3xSO3<double>(slow_top()) {}
  Element initial_configuration() const {
    Element q = HeavyTopR3xSO3<double>::initial_configuration();
    q.first += Vector(0.01, -0.02, 0.015);
    return q;
  }
  Vector6 initial_velocity() const {
    Vector6 v = HeavyTopR3xSO3<double>::initial_velocity();
    v(0) += 0.1;
    return v;
  }
};

TEST(SelfStart, ProjectsInitialValuesThatAreOffTheConstraint) {
  const DisplacedTop system;
  EXPECT_GT(system.constraint(system.initial_configuration()).norm(), 0.01);
  expect_points_on_the_constraints(system);
  // By the projection of integrators/consistent_projection.h.
  auto q = system.initial_configuration();
  auto v = system.initial_velocity();
  NoAudit audit;
  ASSERT_EQ(project_on_constraints(system, 0.0, q, v, audit).outcome, Outcome::ok);
  const auto first = starting_points(system, 0.01, 1, audit)[0];
  EXPECT_EQ(first.q.first, q.first);
  EXPECT_EQ(first.q.second, q.second);
  EXPECT_EQ(first.v, v);
}

TEST(SelfStart, CountsItsForcesAndFactorizationsApartFromThoseOfTheSteps) {
  KernelAudit free, constrained;
  constexpr int count = 5;
  SystemCalls before = SystemCalls::counts();
  starting_points(Audited(HeavyTopSO3<double>(slow_top())), 0.01, count, free);
  // Seven stages a step, and the acceleration of each point.
  constexpr std::uint64_t evaluations = 7 * (count - 1) + count;
  EXPECT_EQ((SystemCalls::counts() - before).forces, evaluations);
  EXPECT_EQ(free.factorizations, evaluations);
  EXPECT_EQ(free.factorizations_start, evaluations);
  EXPECT_EQ(free.solves, evaluations * std::uint64_t(refinement_passes<double>));
  before = SystemCalls::counts();
  starting_points(Audited(HeavyTopR3xSO3<double>(slow_top())), 0.01, count, constrained);
  EXPECT_EQ((SystemCalls::counts() - before).forces, evaluations);
  // The projection of each velocity, and at least one attempt on each configuration but the first.
  EXPECT_GE(constrained.factorizations, evaluations + count + (count - 1));
  EXPECT_EQ(constrained.factorizations_start, constrained.factorizations);
  EXPECT_EQ(constrained.factorizations_slow, 0u);
  EXPECT_EQ(constrained.solves, constrained.factorizations * std::uint64_t(refinement_passes<double>));
}

TEST(SelfStart, SaysThatTheMatrixIsSingularWhereAConstraintIsRedundant) {
  using S = Particle<double, RedundantConstraint>;
  std::vector<SolutionPoint<S>> points(3);
  NoAudit audit;
  EXPECT_EQ(self_start<S>(S(), 0.0, 0.1, points, audit).outcome, Outcome::singular_matrix);
}

TEST(RungeKuttaMuntheKaas, SeesHowStiffADamperIs) {
  for (const double z : {0.1, 1.0, 10.0, 1e3}) {
    const double h = 0.01;
    const LinearOscillator<double> system(z / h, 0.0);
    LinearOscillator<double>::Vector q(1.0), v(1.0);
    NoAudit audit;
    const auto step = index1_step(system, 0.0, h, q, v, audit);
    EXPECT_EQ(step.result.outcome, Outcome::ok);
    // The velocities of two stages are -z / h times as far apart as their positions.
    EXPECT_NEAR(step.stiffness, z * z / (1.0 + z), 1e-6 * z) << z;
  }
}

// Largest error at the points, in units of the solution at t = 0.
double starting_error(const LinearOscillator<double>& system, std::complex<double> a, std::complex<double> b,
                      double h) {
  using S = LinearOscillator<double>;
  std::vector<SolutionPoint<S>> points(6);
  NoAudit audit;
  EXPECT_EQ(self_start<S>(system, 0.0, h, points, audit).outcome, Outcome::ok);
  double error = 0.0;
  for (const SolutionPoint<S>& p : points) {
    // x(0) = 1, x'(0) = 0
    const std::complex<double> x = (b * std::exp(a * p.t) - a * std::exp(b * p.t)) / (b - a);
    error = std::max(error, std::abs(p.q(0) - x.real()));
  }
  return error;
}

TEST(SelfStart, TakesSmallerStepsWhereSomethingIsStiff) {
  // Eigenvalues -10,000 and -1 times 1/s: in one step of 10 ms the fast one would grow by (100)^6 / 6!.
  const double root = std::sqrt(1e8 / 4.0 - 1e4);
  EXPECT_LE(starting_error(LinearOscillator<double>(1e4, 1e4), -5e3 - root, -5e3 + root, 1e-2), 1e-12);
  // A spring that turns by 100 rad in a step: in 128 pieces of 0.8 rad each loses up to (0.8)^7 / 7! of the radius, and there
  // are 640 of them.
  const std::complex<double> omega(0.0, 1e4);
  EXPECT_LE(starting_error(LinearOscillator<double>(0.0, 1e8), omega, -omega, 1e-2), 0.1);
}

TEST(SelfStart, APieceOfAStepIsNoReasonToTurnByMoreThanPiInAStep) {
  // A rotation by 4 rad between two points: what lies between them would be lost.
  HeavyTopParameters p = slow_top();
  p.angular_velocity = {0.0, 400.0, 0.0};
  using S = HeavyTopSO3<double>;
  std::vector<SolutionPoint<S>> points(3);
  NoAudit audit;
  EXPECT_EQ(self_start<S>(S(p), 0.0, 0.01, points, audit).outcome, Outcome::rotation_too_large);
}

TEST(SelfStart, SaysThatForcesAreNoNumbers) {
  HeavyTopParameters p = slow_top();
  p.gravity[1] = std::numeric_limits<double>::quiet_NaN();
  const auto check = [](const auto& system) {
    using S = std::decay_t<decltype(system)>;
    std::vector<SolutionPoint<S>> points(3);
    NoAudit audit;
    EXPECT_EQ(name(self_start<S>(system, 0.0, 0.01, points, audit).outcome), name(Outcome::non_finite));
  };
  check(HeavyTopSO3<double>(p));
  check(HeavyTopR3xSO3<double>(p));
  check(Particle<double, Unconstrained>(1.0, ParticleForce::no_number));
  check(Particle<double, Unconstrained>(1.0, ParticleForce::infinite));
}

// --- methods from their own start ------------------------------------------------------------------------

// The starting errors are of order 7 in q and v, of order 6 and more in lambda: no method of k <= 6 steps sees them.
template <class Method, class S>
void expect_order(int order, const typename Method::Options& options, const std::string& text) {
  const Errors seen = observed_orders<Method, S>(options, Start::self);
  // The error of q at the end is next to a zero for k = 6 (bliedf2nd_orders_test.cpp).
  EXPECT_NEAR(S::constraints > 0 ? seen.largest_q : seen.q, order, order_tolerance) << text;
  EXPECT_NEAR(seen.v, order, order_tolerance) << text;
  if constexpr (S::constraints > 0) {
    EXPECT_NEAR(seen.lambda, order, order_tolerance) << text;
    EXPECT_NEAR(seen.largest_lambda, order, order_tolerance) << text;
  }
}

template <class Method>
void expect_orders(int order, typename Method::Options options, const std::string& text) {
  expect_order<Method, ExtendedSO3>(order, options, text);
  options.modified_start = true;
  expect_order<Method, ExtendedR3xSO3>(order, options, text + ", modified start");
  options.modified_start = false;
  options.form = Form::stabilized_index2;
  expect_order<Method, ExtendedR3xSO3>(order, options, text + ", stabilized");
}

TEST(SelfStart, KeepsTheOrderOfBLieDF2nd) {
  for (int k = 2; k <= 6; ++k) expect_orders<BLieDF2nd>(k, {.k = k}, "k = " + std::to_string(k));
  for (int k = 5; k <= 6; ++k)
    expect_orders<BLieDF2nd>(k, {.k = k, .correction = Correction::implicit_term},
                             "implicit, k = " + std::to_string(k));
}

TEST(SelfStart, KeepsTheOrderOfFaltinsenBdf) {
  for (int k = 2; k <= 4; ++k) expect_orders<FaltinsenBdf>(k, {.k = k}, "k = " + std::to_string(k));
}

TEST(SelfStart, KeepsTheOrderOfGeneralizedAlpha) {
  expect_orders<GeneralizedAlpha>(2, {}, "");
}

}  // namespace
}  // namespace liebench::self_start_test
