#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

#include "integrators/consistent_projection.h"
#include "integrators/outcome.h"
#include "integrators/starting_values.h"

// The starting procedure of the multistep methods from initial values alone: a Runge-Kutta-Munthe-Kaas method of order 6
// on the index-1 form (v' and lambda from the twice differentiated constraint), whose points are projected on the
// constraint and its hidden counterpart.
//
//   Theta_i = h sum_j a_ij K_j,  V_i = v_n + h sum_j a_ij F_j,  Q_i = q_n o exp(Theta_i~)
//   K_i = T^{-1}(Theta_i) V_i,   F_i = v'(Q_i, V_i)
//   q_{n+1} = q_n o exp(h sum_i b_i K_i~),  v_{n+1} = v_n + h sum_i b_i F_i
//
// [Munthe-Kaas 1999]. With k points a step h apart the errors are O(h^7) in q and v, so that a method of k <= 6 steps keeps
// its order k, in lambda and in the transient phase too, where lambda sees errors of v divided by h.

namespace liebench {

// Butcher's method of order 6 with 7 stages [Butcher 1964, On Runge-Kutta processes of high order].
struct ButcherSix {
  static constexpr std::size_t stages = 7;
  struct Fraction {
    int numerator;
    int denominator;
  };
  static constexpr std::array<Fraction, stages> c{{{0, 1}, {1, 3}, {2, 3}, {1, 3}, {1, 2}, {1, 2}, {1, 1}}};
  static constexpr std::array<std::array<Fraction, stages - 1>, stages> a{{
      {{{0, 1}, {0, 1}, {0, 1}, {0, 1}, {0, 1}, {0, 1}}},
      {{{1, 3}, {0, 1}, {0, 1}, {0, 1}, {0, 1}, {0, 1}}},
      {{{0, 1}, {2, 3}, {0, 1}, {0, 1}, {0, 1}, {0, 1}}},
      {{{1, 12}, {1, 3}, {-1, 12}, {0, 1}, {0, 1}, {0, 1}}},
      {{{-1, 16}, {9, 8}, {-3, 16}, {-3, 8}, {0, 1}, {0, 1}}},
      {{{0, 1}, {9, 8}, {-3, 8}, {-3, 4}, {1, 2}, {0, 1}}},
      {{{9, 44}, {-9, 11}, {63, 44}, {18, 11}, {0, 1}, {-16, 11}}},
  }};
  static constexpr std::array<Fraction, stages> b{
      {{11, 120}, {0, 1}, {27, 40}, {27, 40}, {-4, 15}, {-4, 15}, {11, 120}}};
};

// One step of the method above from (t, q, v), without projection.
template <MechanicalSystem S, class Audit>
StepResult runge_kutta_munthe_kaas_step(const S& system, const typename S::Scalar& t,
                                        const typename S::Scalar& h, Configuration<S>& q, Velocity<S>& v,
                                        Audit& audit) {
  using T = typename S::Scalar;
  using Tableau = ButcherSix;
  const auto value = [](const Tableau::Fraction& f) {
    return T(double(f.numerator)) / T(double(f.denominator));
  };
  std::array<Velocity<S>, Tableau::stages> K, F;
  const auto group = group_of(system);
  const Velocity<S> zero = zero_velocity(system);
  const auto sum = [&](const auto& weights, std::size_t count, const auto& slopes) {
    Velocity<S> s = zero;
    for (std::size_t j = 0; j < count; ++j)
      if (weights[j].numerator != 0) s += value(weights[j]) * slopes[j];
    return Velocity<S>(h * s);
  };
  for (std::size_t i = 0; i < Tableau::stages; ++i) {
    const Velocity<S> theta = sum(Tableau::a[i], i, K);
    // Beyond pi a step makes no sense, and beyond 2 pi T^{-1} none.
    if (!(to_double(group.rotation_angle(theta)) < std::numbers::pi)) return {Outcome::rotation_too_large};
    const Velocity<S> V = v + sum(Tableau::a[i], i, F);
    const auto dynamics = consistent_dynamics(system, T(t + value(Tableau::c[i]) * h),
                                              group.compose(q, group.exp(theta)), V, audit);
    if (!dynamics) return {Outcome::singular_matrix};
    if (!std::isfinite(to_double(T(dynamics->acceleration.norm())))) return {Outcome::non_finite};
    K[i] = group.tangent_inverse(theta) * V;
    F[i] = dynamics->acceleration;
  }
  const Velocity<S> theta = sum(Tableau::b, Tableau::stages, K);
  if (!(to_double(group.rotation_angle(theta)) < std::numbers::pi)) return {Outcome::rotation_too_large};
  q = group.compose(q, group.exp(theta));
  v += sum(Tableau::b, Tableau::stages, F);
  return {};
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
      const StepResult step = runge_kutta_munthe_kaas_step(system, T(t - h), h, q, v, audit);
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
