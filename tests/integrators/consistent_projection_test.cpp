#include "integrators/consistent_projection.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/LU>

#include "groups/extended.h"
#include "problems/heavy_top.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/small_systems.h"

namespace liebench {
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
    for (const RigidState& state : sample_states()) {
      const Configuration<S> q = system.configuration(state.R.cast<T>());
      const Velocity<S> a = (1000 * random.vector<6>()).cast<T>();
      const Multipliers<S> b = (100 * random.vector<3>()).cast<T>();
      const auto s = solve_saddle_point<S>(system, q, a, b);
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
  const Eigen::Matrix<double, 9, 1> expected = A.fullPivLu().solve(rhs);
  const auto s = solve_saddle_point<S>(system, q, rhs.head<6>(), rhs.tail<3>());
  ASSERT_TRUE(s.has_value());
  const double condition = A.norm() * A.inverse().norm();
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
  const auto s = solve_saddle_point<S>(system, q, system.mass_matrix(q) * w, Multipliers<S>::Zero());
  ASSERT_TRUE(s.has_value());
  EXPECT_LE((system.constraint_gradient(q) * s->x).norm(), 1e-14);
  // The rest is M-orthogonal to every admissible velocity, s->x itself among them.
  EXPECT_LE(std::abs(s->x.dot(system.mass_matrix(q) * (w - s->x))), 1e-12);
}

TEST(ConsistentProjection, IsEmptyWhereTheGradientLosesRank) {
  using S = Particle<double, RedundantConstraint>;
  for (const double mass : {1.0, 3.0, 7.0, 49.0}) {
    const S system(mass);
    EXPECT_FALSE(solve_saddle_point<S>(system, system.initial_configuration(), Eigen::Vector2d(1, 2),
                                       Eigen::Vector2d(0, 0))
                     .has_value())
        << mass;
  }
}

}  // namespace
}  // namespace liebench
