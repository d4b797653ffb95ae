#pragma once

#include <cmath>
#include <cstddef>
#include <span>

#include "integrators/consistent_projection.h"
#include "integrators/outcome.h"
#include "integrators/runge_kutta_munthe_kaas.h"
#include "integrators/starting_values.h"

// The starting procedure of the multistep methods from initial values alone: a Runge-Kutta-Munthe-Kaas method of order 6
// (integrators/runge_kutta_munthe_kaas.h) on the index-1 form (v' and lambda from the twice differentiated constraint), whose
// points are projected on the constraint and its hidden counterpart. With k points a step h apart the errors are O(h^7) in q
// and v, so that a method of k <= 6 steps keeps its order k, in lambda and in the transient phase too, where lambda sees errors
// of v divided by h.

namespace liebench {

// One step of it from (t, q, v), without the projection.
template <MechanicalSystem S, class Audit>
StepResult index1_step(const S& system, const typename S::Scalar& t, const typename S::Scalar& h,
                       Configuration<S>& q, Velocity<S>& v, Audit& audit) {
  using T = typename S::Scalar;
  const auto acceleration = [&](const T& time, const Configuration<S>& Q, const Velocity<S>& V,
                                Velocity<S>& F) {
    const auto dynamics = consistent_dynamics(system, time, Q, V, audit);
    if (!dynamics) return Outcome::singular_matrix;
    F = dynamics->acceleration;
    return std::isfinite(to_double(T(dynamics->acceleration.norm()))) ? Outcome::ok : Outcome::non_finite;
  };
  return runge_kutta_munthe_kaas_step<butcher_six>(system, t, h, q, v, acceleration);
}

// Solution points at t_0, t_0 + h, ... from the initial values of the system, consistent ones.
template <MechanicalSystem S, class Audit>
[[gnu::noinline]] StepResult self_start(const S& system, const typename S::Scalar& t_0,
                                        const typename S::Scalar& h, std::span<SolutionPoint<S>> points,
                                        Audit& audit) {
  using T = typename S::Scalar;
  Configuration<S> q = system.initial_configuration();
  Velocity<S> v = system.initial_velocity();
  for (std::size_t j = 0; j < points.size(); ++j) {
    const T t = t_0 + h * T(double(j));
    if (j > 0) {
      const StepResult step = index1_step(system, T(t - h), h, q, v, audit);
      if (step.outcome != Outcome::ok) return step;
    }
    if (const StepResult projected = project_on_constraints(system, t, q, v, audit);
        projected.outcome != Outcome::ok)
      return projected;
    const auto dynamics = consistent_dynamics(system, t, q, v, audit);
    if (!dynamics) return {Outcome::singular_matrix};
    if (!std::isfinite(to_double(T(dynamics->acceleration.norm())))) return {Outcome::non_finite};
    points[j] = {t, q, v, dynamics->acceleration, dynamics->lambda};
  }
  return {};
}

}  // namespace liebench
