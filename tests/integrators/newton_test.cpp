#include "integrators/newton.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "groups/extended.h"
#include "integrators/affine_closure.h"
#include "integrators/bliedf2nd.h"
#include "problems/heavy_top.h"
#include "tests/support/dense_algebra.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/small_systems.h"

namespace liebench::newton_test {
namespace {

// A step from q_n with increments near `base`, as a BDF method with gamma_1 = 3/2 makes it.
template <class S>
AffineClosure<S> closure_about(const Velocity<S>& v) {
  using T = typename S::Scalar;
  const Velocity<S> zero = Velocity<S>::Constant(T(0.0));
  return {.base_increment = v,
          .velocity = v,
          .velocity_slope = T(1.5),
          .velocity_change = zero,
          .acceleration_slope = T(2.25),
          .scaled_acceleration = zero};
}

// How far the largest increment that another, exact Newton step would make is from zero, in units of round-off
// of the unknowns: the same measure as the kernel's own stopping rule, but from Eigen's factorization of the
// matrix at the solution.
template <class S, class Closure>
double distance_from_solution(const S& system, double h, const Configuration<S>& q_n, const Closure& closure,
                              const typename StepEquation<S>::Unknowns& z) {
  using T = typename S::Scalar;
  using E = StepEquation<S>;
  constexpr int n = E::m + E::l;
  typename E::Point point;
  E::evaluate(system, T(h), q_n, closure, z, point);
  typename E::Unknowns r;
  E::residual(system, T(0.0), T(h), point, z, r);
  using D = typename S::template rebind<double>;
  using ED = StepEquation<D>;
  const D linear = system.template cast<double>();
  typename ED::Point linear_point;
  linear_point.step = point.step.template cast<double>();
  linear_point.q = S::Group::template cast<double>(point.q);
  linear_point.values.velocity = point.values.velocity.template cast<double>();
  linear_point.values.scaled_acceleration = point.values.scaled_acceleration.template cast<double>();
  Eigen::Matrix<double, n, n> J;
  ED::jacobian(linear, 0.0, h, S::Group::template cast<double>(q_n), linear_point, z.template cast<double>(),
               closure.linearization(point.change), J);
  const Eigen::VectorXd d = dense_solution(J, r.template cast<double>());
  const double eps = to_double(Eigen::NumTraits<T>::epsilon());
  const double q_scale = S::Group::stacked(q_n).template cast<double>().norm();
  const double scale = to_double(closure.base().norm()) + (E::l > 0 ? q_scale / h : 0.0);
  return d.head(E::m).norm() / (eps * scale);
}

template <class S>
void expect_step_solved(const HeavyTopParameters& p, double h) {
  using T = typename S::Scalar;
  const S system(p);
  const Configuration<S> q = system.initial_configuration();
  const auto closure = closure_about<S>(system.initial_velocity());
  NewtonKernel<S, Form::index3, KernelAudit> newton(system);
  typename StepEquation<S>::Unknowns z = StepEquation<S>::Unknowns::Constant(T(0.0));
  typename StepEquation<S>::Point point;
  const StepResult result = newton.solve(T(0.0), T(h), q, closure, z, point);
  ASSERT_EQ(result.outcome, Outcome::ok) << S::formulation << ' ' << h;
  // The residual's own round-off reaches the increment through the inverse matrix: condition 3.6e3 at most, a
  // few eps each.
  EXPECT_LE(distance_from_solution(system, h, q, closure, z), 1e4) << S::formulation << ' ' << h;
  // The point handed back is that of the unknowns handed back.
  typename StepEquation<S>::Point expected;
  StepEquation<S>::evaluate(system, T(h), q, closure, z, expected);
  EXPECT_EQ(to_double((S::Group::stacked(point.q) - S::Group::stacked(expected.q)).norm()), 0.0);
  EXPECT_EQ(to_double((point.values.velocity - expected.values.velocity).norm()), 0.0);
}

TEST(NewtonKernel, SolvesTheStepEquationToRoundOff) {
  for (const HeavyTopParameters& p : sample_tops())
    for (const double h : {1e-2, 1e-3, 1e-5, 1e-7}) {
      if (p == HeavyTopParameters{} && h > 5e-3) continue;  // the fast top turns by more than pi / 2 there
      expect_step_solved<HeavyTopSO3<double>>(p, h);
      expect_step_solved<HeavyTopSO3<Extended>>(p, h);
      expect_step_solved<HeavyTopR3xSO3<double>>(p, h);
      expect_step_solved<HeavyTopR3xSO3<Extended>>(p, h);
    }
}

TEST(NewtonKernel, CountsEveryIterationSolveAndFactorization) {
  using S = HeavyTopR3xSO3<double>;
  const S system(slow_top());
  const auto closure = closure_about<S>(system.initial_velocity());
  NewtonKernel<S, Form::index3, KernelAudit> newton(system);
  StepEquation<S>::Point point;
  for (int step = 1; step <= 20; ++step) {
    StepEquation<S>::Unknowns z = StepEquation<S>::Unknowns::Zero();
    ASSERT_EQ(newton.solve(0.0, 0.01, system.initial_configuration(), closure, z, point).outcome,
              Outcome::ok);
    const KernelAudit& audit = newton.audit();
    EXPECT_EQ(audit.iterations, audit.solves);
    EXPECT_LE(audit.factorizations_slow, audit.factorizations);
    EXPECT_GE(audit.iterations, std::uint64_t(step));
    EXPECT_GE(audit.factorizations, 1u);
  }
  // The same equation twenty times: one factorization serves several steps.
  EXPECT_LT(newton.audit().factorizations, 20u);
}

TEST(NewtonKernel, SolvesALinearEquationWithOneFactorization) {
  // Without forces and constraints the residual is M (2.25 d + offset): linear, with the same matrix always.
  HeavyTopParameters p;
  p.center_of_mass = {0, 0, 0};
  p.inertia = {{{2, 0, 0}, {0, 2, 0}, {0, 0, 2}}};
  using S = HeavyTopSO3<double>;
  const S system(p);
  auto closure = closure_about<S>(Eigen::Vector3d(1, 2, 3));
  closure.scaled_acceleration = Eigen::Vector3d(0.9, -1.8, 0.45);
  NewtonKernel<S, Form::index3, KernelAudit> newton(system);
  StepEquation<S>::Point point;
  for (int step = 0; step < 5; ++step) {
    StepEquation<S>::Unknowns z = StepEquation<S>::Unknowns::Zero();
    ASSERT_EQ(newton.solve(0.0, 0.01, system.initial_configuration(), closure, z, point).outcome,
              Outcome::ok);
    EXPECT_LE((z - Eigen::Vector3d(-0.4, 0.8, -0.2)).norm(), 4 * 2.3e-16);
  }
  EXPECT_EQ(newton.audit().factorizations_slow, 0u);
}

// --- failures --------------------------------------------------------------------------------------------

template <class S>
StepResult solve_from_rest(const S& system, double h) {
  Velocity<S> v = system.initial_velocity();
  const auto closure = closure_about<S>(v);
  NewtonKernel<S, Form::index3, KernelAudit> newton(system);
  typename StepEquation<S>::Unknowns z = StepEquation<S>::Unknowns::Zero();
  typename StepEquation<S>::Point point;
  return newton.solve(0.0, h, system.initial_configuration(), closure, z, point);
}

TEST(NewtonKernel, SaysThatTheMatrixIsSingularWhereAConstraintIsRedundant) {
  for (const double mass : {1.0, 2.0, 3.0, 7.0, 49.0, 0.1})
    for (const double h : {0.1, 1e-3})
      EXPECT_EQ(solve_from_rest(Particle<double, RedundantConstraint>(mass), h).outcome,
                Outcome::singular_matrix)
          << mass << ' ' << h;
}

TEST(NewtonKernel, SaysThatItDivergesWhereThereIsNoSolution) {
  const double h = 0.1;
  const StepResult result = solve_from_rest(Particle<double, ImpossibleConstraint>(), h);
  EXPECT_EQ(result.outcome, Outcome::newton_diverged);
  // What is left is reported: (1 + x^2) / h at least.
  EXPECT_GE(result.residual, 1 / h);
  EXPECT_TRUE(std::isfinite(result.residual));
}

TEST(NewtonKernel, SaysThatANumberIsNotFinite) {
  for (const double h : {0.1, 1e-6}) {
    EXPECT_EQ(solve_from_rest(Particle<double, Unconstrained>(1.0, ParticleForce::no_number), h).outcome,
              Outcome::non_finite)
        << h;
    EXPECT_EQ(solve_from_rest(Particle<double, Unconstrained>(1.0, ParticleForce::infinite), h).outcome,
              Outcome::non_finite)
        << h;
  }
}

TEST(NewtonKernel, RecoversAfterAFailure) {
  // A failed step leaves no factorization behind that the next one would take.
  using S = Particle<double, ImpossibleConstraint>;
  const S system;
  NewtonKernel<S, Form::index3, KernelAudit> newton(system);
  const auto closure = closure_about<S>(system.initial_velocity());
  StepEquation<S>::Point point;
  for (int attempt = 1; attempt <= 3; ++attempt) {
    StepEquation<S>::Unknowns z = StepEquation<S>::Unknowns::Zero();
    const auto before = newton.audit().factorizations;
    EXPECT_NE(newton.solve(0.0, 0.1, system.initial_configuration(), closure, z, point).outcome, Outcome::ok);
    EXPECT_GT(newton.audit().factorizations, before);
  }
}

TEST(NewtonKernel, ARateOfZeroIsNotBelievedForEver) {
  // While the pull is constant the second correction of a step is exactly zero, and the steps after it need none. At the
  // wall the matrix, which knows no spring, contracts by h^2 * 1000 = 0.06 only: a kernel that still believed in the rate
  // of before would stop after its first correction. k = 1: v_{n+1} - v_n = -h g(q_{n+1}).
  using S = Particle<double, Unconstrained>;
  const S system(1.0, ParticleForce::spring_behind_a_wall);
  const double h = 0x1p-7;
  std::array<SolutionPoint<S>, 2> points;
  for (auto& p : points) p = {0.0, system.initial_configuration(), system.initial_velocity(), {0.0, 1.0}, {}};
  BLieDF2nd::Stepper<S, Form::index3, KernelAudit> stepper(system, BLieDF2nd::Options{.k = 1});
  ASSERT_EQ(stepper.start(h, points).outcome, Outcome::ok);
  double largest = 0.0, reach = 0.0;
  for (int n = 0; n < 400; ++n) {
    const S::Vector before = stepper.velocity();
    ASSERT_EQ(stepper.step().outcome, Outcome::ok);
    const S::Vector g = system.force(0.0, stepper.configuration(), stepper.velocity());
    largest = std::max(largest, (stepper.velocity() - before + h * g).norm());
    reach = std::max(reach, stepper.configuration()(1) - 1.5);
  }
  EXPECT_GT(reach, 0.01);  // the spring was reached
  EXPECT_LE(largest, 64 * std::numeric_limits<double>::epsilon());
}

}  // namespace
}  // namespace liebench::newton_test
