#pragma once

#include <array>
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
//
// It is explicit. What is stiff is seen by two stages at the middle of the step, whose F differ because their Theta and V do
// [Hairer & Wanner 1996, IV.2]:
//
//   stiffness = |h| |F_6 - F_5| / (|V_6 - V_5| + |Theta_6 - Theta_5| / |h|)
//
// which is z^2 / (1 + z) of a damper that takes the time h / z, and at most (h omega)^2 of a spring. Above 1, where a step has lost its
// digits (z^7 / 7!), the one between two points is halved, and halved again.

namespace liebench {

// Of one step of it.
template <MechanicalSystem S>
struct Index1Step {
  StepResult result;
  Velocity<S> turn;        // q_{n+1} = q_n o exp(turn~)
  double stiffness = 0.0;  // 0 where the stages differ by round-off
};

// One step from (t, q, v), without the projection. One that fails leaves q and v.
template <MechanicalSystem S, class Audit>
Index1Step<S> index1_step(const S& system, const typename S::Scalar& t, const typename S::Scalar& h,
                          Configuration<S>& q, Velocity<S>& v, Audit& audit) {
  using T = typename S::Scalar;
  constexpr const auto& tableau = butcher_six;
  constexpr std::size_t stages = tableau.stages, one = 4, other = 5;
  static_assert(tableau.c[one] == tableau.c[other]);
  const auto acceleration = [&](const T& time, const Configuration<S>& Q, const Velocity<S>& V,
                                Velocity<S>& F) {
    const auto dynamics = consistent_dynamics(system, time, Q, V, audit);
    if (!dynamics) return Outcome::singular_matrix;
    F = dynamics->acceleration;
    return std::isfinite(to_double(T(dynamics->acceleration.norm()))) ? Outcome::ok : Outcome::non_finite;
  };
  Index1Step<S> step{{}, zero_velocity(system)};
  std::array<Velocity<S>, stages> K, F;
  K[0] = v;
  if (step.result.outcome = acceleration(t, q, v, F[0]); step.result.outcome != Outcome::ok) return step;
  step.result.outcome = munthe_kaas_stages<tableau>(system, t, h, q, v, acceleration, K, F, [&] {
    const auto group = group_of(system);
    step.turn = weighted_sum<tableau, stages>(h, K);
    if (const Outcome outcome = outcome_of_turn(system, step.turn); outcome != Outcome::ok) return outcome;
    const auto apart = [&](const auto& x) {
      return to_double(T((weighted_sum<tableau, other>(h, x) - weighted_sum<tableau, one>(h, x)).norm()));
    };
    const double size = std::abs(to_double(h)), distance = apart(F) + apart(K) / size;
    const double round_off = 1e3 * to_double(Eigen::NumTraits<T>::epsilon()) *
                             (to_double(T(v.norm())) + size * to_double(T(F[one].norm())));
    if (distance > round_off) step.stiffness = size * to_double(T((F[other] - F[one]).norm())) / distance;
    q = group.compose(q, group.exp(step.turn));
    v += weighted_sum<tableau, stages>(h, F);
    return Outcome::ok;
  });
  return step;
}

// From the point at t to that at t + h, in `pieces` equal steps, or in more of them where what is stiff asks for it.
template <MechanicalSystem S, class Audit>
StepResult index1_steps(const S& system, const typename S::Scalar& t, const typename S::Scalar& h,
                        Configuration<S>& q, Velocity<S>& v, int& pieces, Audit& audit) {
  using T = typename S::Scalar;
  constexpr double accurate = 1.0;
  constexpr int most_pieces = 1024;
  for (;; pieces *= 2) {
    Configuration<S> Q = q;
    Velocity<S> V = v, turn = zero_velocity(system);
    const T piece = h / T(double(pieces));
    StepResult result;
    bool stiff = false;
    for (int n = 0; n < pieces && result.outcome == Outcome::ok && !stiff; ++n) {
      const Index1Step<S> step = index1_step(system, T(t + piece * T(double(n))), piece, Q, V, audit);
      result = step.result;
      stiff = pieces < most_pieces && !(step.stiffness <= accurate);
      turn += step.turn;
    }
    // What grows without bound in large steps ends them in one of these.
    const bool too_large =
        result.outcome == Outcome::rotation_too_large || result.outcome == Outcome::non_finite;
    if (stiff || (too_large && pieces < most_pieces)) continue;
    if (result.outcome == Outcome::ok) {
      // The points, not the pieces, are what the methods take increments of.
      result.outcome = outcome_of_turn(system, turn);
      q = Q;
      v = V;
    }
    return result;
  }
}

// Solution points at t_0, t_0 + h, ... from the initial values of the system, consistent ones.
template <MechanicalSystem S, class Audit>
[[gnu::noinline]] StepResult self_start(const S& system, const typename S::Scalar& t_0,
                                        const typename S::Scalar& h, std::span<SolutionPoint<S>> points,
                                        Audit& audit) {
  using T = typename S::Scalar;
  Configuration<S> q = system.initial_configuration();
  Velocity<S> v = system.initial_velocity();
  int pieces = 1;
  for (std::size_t j = 0; j < points.size(); ++j) {
    const T t = t_0 + h * T(double(j));
    if (j > 0) {
      const StepResult step = index1_steps(system, T(t - h), h, q, v, pieces, audit);
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
