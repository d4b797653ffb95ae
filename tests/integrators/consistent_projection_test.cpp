#include "integrators/consistent_projection.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "groups/extended.h"
#include "integrators/audit.h"
#include "problems/audited_system.h"
#include "problems/heavy_top.h"
#include "tests/support/dense_algebra.h"
#include "tests/support/heavy_top_motion.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/small_systems.h"

namespace liebench::consistent_projection_test {
namespace {

// The residuals of both rows, in the scalar of the system.
template <class S>
double residual(const S& system, const Configuration<S>& q, const Velocity<S>& a, const Multipliers<S>& b,
                const SaddlePointSolution<S>& s) {
  const auto B = system.constraint_gradient(q);
  const Velocity<S> first = system.mass_matrix(q) * s.x + B.transpose() * s.y - a;
  const Multipliers<S> second = B * s.x - b;
  return to_double(first.norm()) + to_double(second.norm());
}

// Loads of all sizes at once: the constraint row in m/s^2, forces in N.
template <class T>
void expect_round_off_residual(double eps) {
  using S = HeavyTopR3xSO3<T>;
  for (const HeavyTopParameters& p : sample_tops()) {
    const S system(p);
    RandomNumbers random(11);
    for (const TopState& state : sample_states()) {
      const Configuration<S> q = system.configuration(state.R.cast<T>());
      const Velocity<S> a = (1000 * random.vector<6>()).cast<T>();
      const Multipliers<S> b = (100 * random.vector<3>()).cast<T>();
      NoAudit audit;
      const auto s = solve_saddle_point<S>(system, q, a, b, audit);
      ASSERT_TRUE(s.has_value());
      // The last pass leaves a residual of the rounding of M x + B^T y - a.
      const double scale = to_double(system.mass_matrix(q).norm()) * to_double(s->x.norm()) +
                           2 * to_double(s->y.norm()) + 1000;
      EXPECT_LE(residual<S>(system, q, a, b, *s), 64 * eps * scale);
    }
  }
}

TEST(ConsistentProjection, SolvesTheSaddlePointSystemToRoundOff) {
  expect_round_off_residual<double>(2.3e-16);
}

TEST(ConsistentProjection, IsRefinedToExtendedPrecision) {
  expect_round_off_residual<Extended>(to_double(Eigen::NumTraits<Extended>::epsilon()));
}

TEST(ConsistentProjection, AgreesWithADenseSolve) {
  using S = HeavyTopR3xSO3<double>;
  const S system(unsymmetric_top(2));
  const auto q = system.initial_configuration();
  Eigen::Matrix<double, 9, 9> A = Eigen::Matrix<double, 9, 9>::Zero();
  A.topLeftCorner<6, 6>() = system.mass_matrix(q);
  A.topRightCorner<6, 3>() = system.constraint_gradient(q).transpose();
  A.bottomLeftCorner<3, 6>() = system.constraint_gradient(q);
  Eigen::Matrix<double, 9, 1> rhs;
  rhs << 1, -2, 3, -4, 5, -6, 0.7, -0.8, 0.9;
  const Eigen::Matrix<double, 9, 1> expected = dense_solution(A, rhs);
  NoAudit audit;
  const auto s = solve_saddle_point<S>(system, q, rhs.head<6>(), rhs.tail<3>(), audit);
  ASSERT_TRUE(s.has_value());
  const double condition = dense_condition(A);
  EXPECT_LE((s->x - expected.head<6>()).norm(), 64 * 2.3e-16 * condition * expected.norm());
  EXPECT_LE((s->y - expected.tail<3>()).norm(), 64 * 2.3e-16 * condition * expected.norm());
}

TEST(ConsistentProjection, ProjectsVelocitiesOntoTheHiddenConstraint) {
  // a = M w, b = 0: the vector next to w, in the norm of M, with B x = 0.
  using S = HeavyTopR3xSO3<double>;
  const S system(unsymmetric_top(1));
  const auto q = system.initial_configuration();
  RandomNumbers random(4);
  const Velocity<S> w = random.vector<6>();
  NoAudit audit;
  const auto s = solve_saddle_point<S>(system, q, system.mass_matrix(q) * w, Multipliers<S>::Zero(), audit);
  ASSERT_TRUE(s.has_value());
  EXPECT_LE((system.constraint_gradient(q) * s->x).norm(), 1e-14);
  // The rest is M-orthogonal to every admissible velocity, s->x itself among them.
  EXPECT_LE(std::abs(s->x.dot(system.mass_matrix(q) * (w - s->x))), 1e-12);
}

TEST(ConsistentProjection, IsEmptyWhereTheGradientLosesRank) {
  using S = Particle<double, RedundantConstraint>;
  NoAudit audit;
  for (const double mass : {1.0, 3.0, 7.0, 49.0}) {
    const S system(mass);
    EXPECT_FALSE(solve_saddle_point<S>(system, system.initial_configuration(), Eigen::Vector2d(1, 2),
                                       Eigen::Vector2d(0, 0), audit)
                     .has_value())
        << mass;
  }
}

// --- accelerations and multipliers -----------------------------------------------------------------------

template <class S>
void expect_dynamics_of_the_motion() {
  using T = typename S::Scalar;
  const double eps = to_double(Eigen::NumTraits<T>::epsilon());
  for (const HeavyTopParameters& p : {slow_top(), unsymmetric_top(1), unsymmetric_top(2)}) {
    const S system(p);
    const HeavyTopMotion motion(p, 0.5);
    for (const double t : {0.0, 0.2, 0.45}) {
      const auto point = motion.point(system, Extended(t));
      NoAudit audit;
      const auto dynamics = consistent_dynamics(system, point.t, point.q, point.v, audit);
      ASSERT_TRUE(dynamics.has_value());
      // The state is rounded, and its roundings reach v' and lambda through J^{-1} and derivatives of the forces, 1e3 at
      // most; where the motion is known in Extended itself, to 1e-28 (tests/support/heavy_top_motion.h).
      const double tolerance = std::max(1e4 * eps, 1e-24);
      EXPECT_LE(to_double((dynamics->acceleration - point.acceleration).norm()),
                tolerance * (1 + to_double(point.acceleration.norm())))
          << S::formulation;
      EXPECT_LE(to_double((dynamics->lambda - point.lambda).norm()),
                tolerance * (1 + to_double(point.lambda.norm())))
          << S::formulation;
    }
  }
}

TEST(ConsistentDynamics, AreTheAccelerationAndTheMultipliersOfTheMotion) {
  expect_dynamics_of_the_motion<HeavyTopSO3<double>>();
  expect_dynamics_of_the_motion<HeavyTopSO3<Extended>>();
  expect_dynamics_of_the_motion<HeavyTopR3xSO3<double>>();
  expect_dynamics_of_the_motion<HeavyTopR3xSO3<Extended>>();
}

TEST(ConsistentDynamics, CountOneMatrixOneForceAndEachPassOfTheRefinement) {
  const auto check = [](const auto& unaudited, auto passes) {
    const Audited system(unaudited);
    const SystemCalls before = SystemCalls::counts();
    KernelAudit audit;
    ASSERT_TRUE(
        consistent_dynamics(system, {}, system.initial_configuration(), system.initial_velocity(), audit)
            .has_value());
    EXPECT_EQ((SystemCalls::counts() - before).forces, 1u);
    EXPECT_EQ(audit.factorizations, 1u);
    EXPECT_EQ(audit.factorizations_start, 1u);
    EXPECT_EQ(audit.factorizations_slow, 0u);
    EXPECT_EQ(audit.solves, std::uint64_t(passes));
  };
  check(HeavyTopSO3<double>(slow_top()), refinement_passes<double>);
  check(HeavyTopR3xSO3<double>(slow_top()), refinement_passes<double>);
  check(HeavyTopR3xSO3<Extended>(slow_top()), refinement_passes<Extended>);
}

// --- projection ------------------------------------------------------------------------------------------

template <class S>
struct Projected {
  Configuration<S> q;
  Velocity<S> v;
};

template <class S>
Projected<S> projected(const S& system, Configuration<S> q, Velocity<S> v) {
  NoAudit audit;
  EXPECT_EQ(project_on_constraints(system, 0.0, q, v, audit).outcome, Outcome::ok);
  return {q, v};
}

// An inconsistent state, `size` off.
template <class S>
Projected<S> disturbed(const S& system, double size) {
  using T = typename S::Scalar;
  RandomNumbers random(5);
  const Velocity<S> dq = (size * random.vector<6>()).template cast<T>();
  const Velocity<S> dv = (size * random.vector<6>()).template cast<T>();
  return {S::Group::compose(system.initial_configuration(), S::Group::exp(dq)),
          system.initial_velocity() + dv};
}

template <class S>
void expect_both_constraints_to_round_off() {
  using T = typename S::Scalar;
  const double eps = to_double(Eigen::NumTraits<T>::epsilon());
  for (const HeavyTopParameters& p : sample_tops()) {
    const S system(p);
    for (const double size : {0.0, 1e-12, 1e-3, 0.3}) {
      const auto before = disturbed(system, size);
      const auto after = projected(system, before.q, before.v);
      EXPECT_LE(to_double(system.constraint(after.q).norm()), 16 * eps) << size;
      const Multipliers<S> hidden = system.constraint_gradient(after.q) * after.v;
      EXPECT_LE(to_double(hidden.norm()), 32 * eps * (1 + to_double(after.v.norm()))) << size;
    }
  }
}

TEST(ProjectOnConstraints, LeavesBothConstraintsAtRoundOff) {
  expect_both_constraints_to_round_off<HeavyTopR3xSO3<double>>();
  expect_both_constraints_to_round_off<HeavyTopR3xSO3<Extended>>();
}

// A tangent vector of the constraint at q: what B maps to zero.
template <class S>
Velocity<S> admissible(const S& system, const Configuration<S>& q, RandomNumbers& random) {
  using T = typename S::Scalar;
  NoAudit audit;
  const Velocity<S> w = random.vector<6>().template cast<T>();
  return solve_saddle_point<S>(system, q, system.momentum(q, w), Multipliers<S>::Constant(T(0.0)), audit)->x;
}

TEST(ProjectOnConstraints, MovesTheVelocityByTheLeastChangeInTheNormOfTheMass) {
  using S = HeavyTopR3xSO3<Extended>;
  for (const HeavyTopParameters& p : sample_tops()) {
    const S system(p);
    const auto before = disturbed(system, 0.3);
    const auto after = projected(system, before.q, before.v);
    const Velocity<S> moved = after.v - before.v;
    EXPECT_GT(to_double(moved.norm()), 1e-3);
    // M-orthogonal to all that it could have been changed by.
    RandomNumbers random(6);
    for (int i = 0; i < 4; ++i) {
      const Velocity<S> w = admissible(system, after.q, random);
      const double scale = to_double(system.momentum(after.q, moved).norm()) * to_double(w.norm());
      EXPECT_LE(std::abs(to_double(Extended(system.momentum(after.q, moved).dot(w)))), 1e-27 * scale);
    }
  }
}

TEST(ProjectOnConstraints, MovesTheConfigurationByTheLeastChangeUpToItsSquare) {
  // The steps are along M^{-1} B(q_i)^T at q_0, q_1, ..., which differ by the change itself: what is left of
  // M-orthogonality falls with the square of the distance.
  using S = HeavyTopR3xSO3<Extended>;
  const S system(unsymmetric_top(1));
  std::vector<double> defects;
  for (const double size : {1e-3, 1e-4}) {
    const auto before = disturbed(system, size);
    const auto after = projected(system, before.q, before.v);
    const Velocity<S> moved = S::Group::log(S::Group::compose(S::Group::inverse(before.q), after.q));
    EXPECT_GT(to_double(moved.norm()), 0.01 * size);
    RandomNumbers random(6);
    defects.push_back(std::abs(
        to_double(Extended(system.momentum(after.q, moved).dot(admissible(system, after.q, random))))));
  }
  EXPECT_NEAR(std::log10(defects[0] / defects[1]), 2.0, 0.05);
}

TEST(ProjectOnConstraints, ChangesConsistentValuesByRoundOffOnly) {
  using S = HeavyTopR3xSO3<double>;
  for (const HeavyTopParameters& p : sample_tops()) {
    const S system(p);
    const auto q = system.initial_configuration();
    const Velocity<S> v = system.initial_velocity();
    const auto after = projected(system, q, v);
    EXPECT_LE(S::Group::separation(q, after.q).norm(), 16 * 2.3e-16);
    // B v of the given values is eps |v|; M^{-1} B^T takes it to v with a factor of at most 64 = m |X|^2 / J.
    EXPECT_LE((after.v - v).norm(), 64 * 16 * 2.3e-16 * v.norm());
  }
}

TEST(ProjectOnConstraints, TouchesNothingWithoutConstraints) {
  using S = HeavyTopSO3<double>;
  const S system(unsymmetric_top(1));
  const auto after = projected(system, system.initial_configuration(), system.initial_velocity());
  EXPECT_EQ(after.q, system.initial_configuration());
  EXPECT_EQ(after.v, system.initial_velocity());
}

TEST(ProjectOnConstraints, SaysThatTheMatrixIsSingularWhereAConstraintIsRedundant) {
  using S = Particle<double, RedundantConstraint>;
  const S system;
  NoAudit audit;
  for (const double x : {1.0, 1.25}) {
    Configuration<S> q(x, 0.0);
    Velocity<S> v(0.0, 1.0);
    EXPECT_EQ(project_on_constraints(system, 0.0, q, v, audit).outcome, Outcome::singular_matrix) << x;
  }
}

}  // namespace
}  // namespace liebench::consistent_projection_test
