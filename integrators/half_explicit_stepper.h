#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <type_traits>

#include "groups/entrywise.h"
#include "integrators/inlining.h"
#include "integrators/outcome.h"
#include "integrators/runge_kutta_munthe_kaas.h"
#include "integrators/runge_kutta_tableau.h"
#include "integrators/stage_solver.h"
#include "integrators/starting_values.h"
#include "problems/system.h"

namespace liebench {

// The stepper of a half-explicit Runge-Kutta method with an explicit first stage for the index-2 form
//
//   q' = DL_q(e) v~,   M(q) v' = -g(t, q, v) - B(q)^T lambda,   0 = B(q) v + Phi_t(t, q)
//
// in canonical coordinates about q_n; Theta_1 = 0, Theta'_1 = v_n, and v'_1 is that of lambda_n. For i = 2, ..., s
//
//   Theta_i = h sum_{j<i} a_ij Theta'_j,   Q_i = q_n o exp(Theta_i~),   V_i = v_n + h sum_{j<i} a_ij v'_j
//   Theta'_i = T^{-1}(Theta_i) V_i
//   M(Q_i) v'_i = -g(t_i, Q_i, V_i) - B(Q_i)^T Lambda_i,   B(Q_{i+1}) V_{i+1} + Phi_t(t_{i+1}, Q_{i+1}) = 0
//
// where the last line is linear in (v'_i, Lambda_i), for Q_{i+1} is known by then. The tableau says which row is
// (q_{n+1}, v_{n+1}), and lambda_{n+1} = sum_i d_i Lambda_i. Where the last stage is at (q_{n+1}, v_{n+1}), v'_s is
// v'_1 of the next step.
//
// With `projection` a step ends with q_{n+1} <- q_{n+1} o exp(delta~), Phi(t_{n+1}, q_{n+1}) = 0, and v_{n+1} <-
// v_{n+1} + Dv on the hidden constraint there, of the least |delta|_M and |Dv|_M. delta is of the size of the local
// error, so that M delta = B^T mu with B before the change differs from the least one by O(|delta|^2).
template <MechanicalSystem S, class Audit, const auto& tableau>
class HalfExplicitStepper {
 public:
  using System = S;
  using T = typename S::Scalar;

  HalfExplicitStepper(const S& system, bool projection)
      : system_(system),
        solver_(system),
        projection_(projection),
        q_(group_of(system).identity()),
        velocity_(zero_velocity(system)),
        lambda_(zero_multipliers(system)),
        acceleration_(velocity_) {}

  int steps() const { return 1; }
  int starting_points() const { return 1; }
  const T& time() const { return t_; }
  const Configuration<S>& configuration() const { return q_; }
  const Velocity<S>& velocity() const { return velocity_; }
  const Multipliers<S>& multipliers() const { return lambda_; }
  const S& system() const { return system_; }
  const Audit& audit() const { return audit_; }
  Audit& audit() { return audit_; }

  // From q_0, v_0 and lambda_0.
  StepResult start(const T& h, std::span<const SolutionPoint<S>> points) {
    h_ = h;
    t_ = points[0].t;
    q_ = points[0].q;
    velocity_ = points[0].v;
    lambda_ = points[0].lambda;
    has_acceleration_ = false;
    solver_.prepare(system_, audit_);
    return {};
  }

  StepResult step() {
    return inlined_step<S>([this] { return take_step(); });
  }

 private:
  static constexpr std::size_t s = tableau.stages;
  template <std::size_t i>
  using Index = std::integral_constant<std::size_t, i>;

  // What the stages leave behind.
  struct Stages {
    std::array<Velocity<S>, s> K, F;  // Theta'_i and v'_i
    std::array<Multipliers<S>, s> lambda;
    Configuration<S> q;  // the new values
    Velocity<S> v;
  };

  StepResult take_step() {
    Stages stages;
    if (!first_acceleration(stages.F[0])) return {Outcome::singular_matrix};
    stages.K[0] = velocity_;
    const Velocity<S> theta = weighted_sum<tableau, 1>(h_, stages.K);
    if (const Outcome outcome = outcome_of_turn(system_, theta); outcome != Outcome::ok) return {outcome};
    const Velocity<S> V = velocity_ + weighted_sum<tableau, 1>(h_, stages.F);
    const Configuration<S> Q = moved(theta);
    solver_.take(system_, Q);
    if (const Outcome outcome = go_on(Index<1>{}, theta, Q, V, stages); outcome != Outcome::ok)
      return {outcome};
    const T t = t_ + h_;
    if (projection_)
      if (const Outcome outcome = project(t, stages.q, stages.v); outcome != Outcome::ok) return {outcome};
    const Multipliers<S> lambda = combination<tableau, s + 1, s>(stages.lambda);
    if (!std::isfinite(to_double(T(stages.v.squaredNorm() + lambda.squaredNorm()))))
      return {Outcome::non_finite};
    t_ = t;
    q_ = stages.q;
    velocity_ = stages.v;
    lambda_ = lambda;
    if constexpr (tableau.first_same_as_last()) {
      acceleration_ = stages.F[s - 1];
      has_acceleration_ = !projection_;
    }
    return {};
  }

  bool first_acceleration(Velocity<S>& F) {
    if (has_acceleration_) {
      F = acceleration_;
      return true;
    }
    const Velocity<S> a = -system_.force(t_, q_, velocity_) - system_.constraint_force(q_, lambda_);
    return solver_.mass_solve(system_, q_, a, F, audit_);
  }

  Configuration<S> moved(const Velocity<S>& theta) const {
    const auto group = group_of(system_);
    return group.compose(q_, group.exp(theta));
  }

  // The stages from i on (here the first one is 0).
  template <std::size_t i>
  Outcome go_on(Index<i>, const Velocity<S>& theta, const Configuration<S>& Q, const Velocity<S>& V,
                Stages& stages) {
    if constexpr (i == tableau.end) {
      stages.q = Q;
      stages.v = V;
    }
    if constexpr (i == s) {
      return Outcome::ok;
    } else {
      stages.K[i] = group_of(system_).tangent_inverse_times(theta, V);
      const Velocity<S> next_theta = weighted_sum<tableau, i + 1>(h_, stages.K);
      if (const Outcome outcome = outcome_of_turn(system_, next_theta); outcome != Outcome::ok)
        return outcome;
      const Configuration<S> next = moved(next_theta);
      solver_.shift(system_, Q);
      solver_.take(system_, next);
      if (const Outcome outcome = solver_.factorize(system_, Q, next, audit_); outcome != Outcome::ok)
        return outcome;
      // V_{i+1} without v'_i.
      const Velocity<S> known = velocity_ + h_ * combination<tableau, i + 1, i>(stages.F);
      const T weight = h_ * value_of<T>(tableau.row(i + 1)[i]);
      const Multipliers<S> rate = solver_.rate(system_, stage_time<i + 1>(), next, known);
      const Velocity<S> force = -system_.force(stage_time<i>(), Q, V);
      solver_.solve(system_, Q, next, force, Multipliers<S>(rate / -weight), stages.F[i], stages.lambda[i],
                    audit_);
      const Velocity<S> next_V = known + weight * stages.F[i];
      return go_on(Index<i + 1>{}, next_theta, next, next_V, stages);
    }
  }
  template <std::size_t i>
  T stage_time() const {
    return t_ + value_of<T>(tableau.c[i]) * h_;
  }

  // The correction is repeated until what is left of Phi no longer shrinks, which is its round-off.
  [[gnu::noinline]] Outcome project(const T& t, Configuration<S>& q, Velocity<S>& v) {
    const auto group = group_of(system_);
    const Velocity<S> zero = zero_velocity(system_);
    Velocity<S> change;
    Multipliers<S> unused;
    if (const Outcome outcome = factorize_at(q); outcome != Outcome::ok) return outcome;
    const Configuration<S> from = q;
    Velocity<S> delta = zero;
    Multipliers<S> phi = constraint_at(system_, t, q);
    double left = to_double(T(largest_entry(phi)));
    constexpr int most = 30;
    for (int i = 0; i < most && 0.0 < left; ++i) {
      solver_.solve(system_, from, from, zero, Multipliers<S>(-phi), change, unused, audit_);
      delta += change;
      const Configuration<S> nearer = group.compose(from, group.exp(delta));
      phi = constraint_at(system_, t, nearer);
      const double now = to_double(T(largest_entry(phi)));
      if (!std::isfinite(now)) return Outcome::non_finite;
      if (!(now < left)) break;
      q = nearer;
      left = now;
    }
    if (const Outcome outcome = factorize_at(q); outcome != Outcome::ok) return outcome;
    solver_.solve(system_, q, q, zero, Multipliers<S>(-solver_.rate(system_, t, q, v)), change, unused,
                  audit_);
    v += change;
    return Outcome::ok;
  }
  Outcome factorize_at(const Configuration<S>& q) {
    solver_.take(system_, q);
    solver_.shift(system_, q);
    return solver_.factorize(system_, q, q, audit_);
  }

  S system_;
  [[no_unique_address]] Audit audit_;
  StageSolver<S> solver_;
  bool projection_;
  bool has_acceleration_ = false;
  T h_ = T(0.0);
  T t_ = T(0.0);
  Configuration<S> q_;
  Velocity<S> velocity_;
  Multipliers<S> lambda_;
  Velocity<S> acceleration_;  // v'_1 of the next step, where it has one
};

}  // namespace liebench
