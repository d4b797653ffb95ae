#pragma once

#include <cmath>
#include <optional>

#include "integrators/audit.h"
#include "integrators/dense_lu.h"
#include "integrators/outcome.h"
#include "integrators/starting_values.h"
#include "problems/system.h"

// Consistent values: what the equations of motion and the constraints say at one instant. `audit` counts a
// factorization for each solved system and a back-substitution for each pass of its refinement.

namespace liebench {

// Each pass of iterative refinement gains at least ten digits (condition 3.6e3 for the top): four serve 106 bits.
template <class T>
inline constexpr int refinement_passes = ScalarTraits<T>::extended ? 4 : 2;

// The saddle point system of a constrained system at q,
//
//   [ M(q)  B(q)^T ] [ x ]   [ a ]
//   [ B(q)  0      ] [ y ] = [ b ]
//
// which gives consistent accelerations and multipliers (a = -g, b = -Z(v, v)), projections on the hidden
// constraint, and the velocity modification of eq. (56). Solved in the scalar of the linear algebra, refined in that
// of the system to its round-off. Empty where M and B make the matrix singular.
template <ConstrainedSystem S>
struct SaddlePointSolution {
  Velocity<S> x;
  Multipliers<S> y;
};

template <ConstrainedSystem S, class Audit>
[[gnu::noinline]] std::optional<SaddlePointSolution<S>> solve_saddle_point(
    const S& system, const Configuration<S>& q, const Velocity<S>& a, const Multipliers<S>& b,
    Audit& audit) requires DenseSystem<S> {
  using T = typename S::Scalar;
  using Linear = LinearScalar<T>;
  constexpr int m = S::Group::dimension, l = S::constraints;
  const VelocityMatrix<S> M = system.mass_matrix(q);
  const ConstraintGradient<S> B = system.constraint_gradient(q);
  typename DenseLu<Linear, m + l>::Matrix A;
  A.setConstant(Linear(0.0));
  A.template topLeftCorner<m, m>() = M.template cast<Linear>();
  A.template topRightCorner<m, l>() = B.transpose().template cast<Linear>();
  A.template bottomLeftCorner<l, m>() = B.template cast<Linear>();
  DenseLu<Linear, m + l> lu;
  audit.factorization(FactorizationCause::start);
  if (!lu.factorize(A)) return std::nullopt;
  SaddlePointSolution<S> s{Velocity<S>::Constant(T(0.0)), Multipliers<S>::Constant(T(0.0))};
  for (int pass = 0; pass < refinement_passes<T>; ++pass) {
    Eigen::Matrix<T, m + l, 1> r;
    r.template head<m>() = a - M * s.x - B.transpose() * s.y;
    r.template tail<l>() = b - B * s.x;
    const Eigen::Matrix<T, m + l, 1> d = lu.solve(r.template cast<Linear>()).template cast<T>();
    audit.solve();
    s.x += d.template head<m>();
    s.y += d.template tail<l>();
  }
  return s;
}

// A system with a solver of its own: system.saddle_point(q, a, b, audit).
template <ConstrainedSystem S, class Audit>
std::optional<SaddlePointSolution<S>> solve_saddle_point(const S& system, const Configuration<S>& q,
                                                         const Velocity<S>& a, const Multipliers<S>& b,
                                                         Audit& audit) requires
    requires(Velocity<S>& x, Multipliers<S>& y) {
  system.saddle_point(q, a, b, x, y, audit);
}
{
  SaddlePointSolution<S> s{zero_velocity(system), zero_multipliers(system)};
  if (!system.saddle_point(q, a, b, s.x, s.y, audit)) return std::nullopt;
  return s;
}

// M(q) x = a, refined as above.
template <DenseSystem S, class Audit>
[[gnu::noinline]] std::optional<Velocity<S>> solve_mass_matrix(const S& system, const Configuration<S>& q,
                                                               const Velocity<S>& a, Audit& audit) {
  using T = typename S::Scalar;
  using Linear = LinearScalar<T>;
  DenseLu<Linear, S::Group::dimension> lu;
  const VelocityMatrix<S> M = system.mass_matrix(q);
  audit.factorization(FactorizationCause::start);
  if (!lu.factorize(M.template cast<Linear>())) return std::nullopt;
  Velocity<S> x = Velocity<S>::Constant(T(0.0));
  for (int pass = 0; pass < refinement_passes<T>; ++pass) {
    const Velocity<S> r = a - system.momentum(q, x);
    x += lu.solve(r.template cast<Linear>()).template cast<T>();
    audit.solve();
  }
  return x;
}

// The acceleration and the multipliers that the equations of motion give at (t, q, v): M v' = -g without constraints; with
// them such that the second derivative of the constraint vanishes, B v' = -Z(v, v).
template <MechanicalSystem S>
struct ConsistentDynamics {
  Velocity<S> acceleration;
  Multipliers<S> lambda;
};

template <MechanicalSystem S, class Audit>
[[gnu::noinline]] std::optional<ConsistentDynamics<S>> consistent_dynamics(const S& system,
                                                                           const typename S::Scalar& t,
                                                                           const Configuration<S>& q,
                                                                           const Velocity<S>& v,
                                                                           Audit& audit) {
  const Velocity<S> force = -system.force(t, q, v);
  if constexpr (S::constraints != 0) {
    const auto solution = solve_saddle_point(
        system, q, force, Multipliers<S>(-constraint_curvature_at(system, t, q, v)), audit);
    if (!solution) return std::nullopt;
    return ConsistentDynamics<S>{solution->x, solution->y};
  } else {
    const auto acceleration = solve_mass_matrix(system, q, force, audit);
    if (!acceleration) return std::nullopt;
    return ConsistentDynamics<S>{*acceleration, {}};
  }
}

// Moves q on the constraint and v on its hidden counterpart, by the least change in the norm of M:
//   q <- q o exp(delta~), Phi(q) = 0;   v <- v + Dv, B(q) v = 0
// The correction of q is repeated until it no longer shrinks, which is its round-off.
template <MechanicalSystem S, class Audit>
StepResult project_on_constraints(const S& system, const typename S::Scalar& t, Configuration<S>& q,
                                  Velocity<S>& v, Audit& audit) {
  if constexpr (S::constraints != 0) {
    using T = typename S::Scalar;
    if (multiplier_size(system) == 0) return {};
    const auto group = group_of(system);
    const Velocity<S> zero = zero_velocity(system);
    const auto size = [&] { return to_double(T(constraint_at(system, t, q).norm())); };
    constexpr int most = 30;
    double previous = size();
    for (int i = 0; i < most && previous > 0.0; ++i) {
      const auto solution =
          solve_saddle_point(system, q, zero, Multipliers<S>(-constraint_at(system, t, q)), audit);
      if (!solution) return {Outcome::singular_matrix};
      const Configuration<S> before = q;
      q = group.compose(q, group.exp(solution->x));
      const double now = size();
      if (!std::isfinite(now)) return {Outcome::non_finite};
      if (now >= previous) {
        q = before;
        break;
      }
      previous = now;
    }
    const auto solution =
        solve_saddle_point(system, q, zero, Multipliers<S>(-constraint_rate(system, t, q, v)), audit);
    if (!solution) return {Outcome::singular_matrix};
    v += solution->x;
  }
  return {};
}

}  // namespace liebench
