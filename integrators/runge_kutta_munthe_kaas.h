#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <type_traits>

#include "integrators/outcome.h"
#include "integrators/runge_kutta_tableau.h"
#include "problems/system.h"

namespace liebench {

// A rotation by pi and more in a step or a stage makes no sense, and by 2 pi has no T^{-1}; and an infinity or a NaN.
inline Outcome outcome_of_angle(double angle) {
  if (angle < std::numbers::pi) return Outcome::ok;
  return std::isfinite(angle) ? Outcome::rotation_too_large : Outcome::non_finite;
}
template <MechanicalSystem S>
Outcome outcome_of_turn(const S& system, const Velocity<S>& theta) {
  return outcome_of_angle(to_double(group_of(system).rotation_angle(theta)));
}

// The stages of a Runge-Kutta-Munthe-Kaas method from (t, q, v) [Munthe-Kaas 1999], for q' = DL_q(e) v~ on G and v' = F(t, q, v) on
// R^m:
//
//   Theta_i = h sum_j a_ij K_j,  V_i = v_n + h sum_j a_ij F_j,  Q_i = q_n o exp(Theta_i~)
//   K_i = T^{-1}(Theta_i) V_i,   F_i = F(t_n + c_i h, Q_i, V_i)
//
// K_1 = v and F_1 are there already; end() is what follows the last of them. acceleration(t, q, v, F) writes F and says how it went.
template <const auto& tableau, MechanicalSystem S, class Acceleration, class End>
Outcome munthe_kaas_stages(const S& system, const typename S::Scalar& t, const typename S::Scalar& h,
                           const Configuration<S>& q, const Velocity<S>& v, const Acceleration& acceleration,
                           std::array<Velocity<S>, tableau.stages>& K,
                           std::array<Velocity<S>, tableau.stages>& F, const End& end) {
  using T = typename S::Scalar;
  const auto go_on = [&]<std::size_t i>(const auto& self, std::integral_constant<std::size_t, i>) -> Outcome {
    if constexpr (i == tableau.stages) {
      return end();
    } else {
      const auto group = group_of(system);
      const Velocity<S> theta = weighted_sum<tableau, i>(h, K);
      if (const Outcome outcome = outcome_of_turn(system, theta); outcome != Outcome::ok) return outcome;
      const Velocity<S> V = v + weighted_sum<tableau, i>(h, F);
      const T time = t + value_of<T>(tableau.c[i]) * h;
      if (const Outcome outcome = acceleration(time, group.compose(q, group.exp(theta)), V, F[i]);
          outcome != Outcome::ok)
        return outcome;
      K[i] = group.tangent_inverse_times(theta, V);
      return self(self, std::integral_constant<std::size_t, i + 1>{});
    }
  };
  return go_on(go_on, std::integral_constant<std::size_t, 1>{});
}

// One step:
//   q_{n+1} = q_n o exp(h sum_i b_i K_i~),  v_{n+1} = v_n + h sum_i b_i F_i
// A step that fails leaves q and v.
template <const auto& tableau, MechanicalSystem S, class Acceleration>
StepResult runge_kutta_munthe_kaas_step(const S& system, const typename S::Scalar& t,
                                        const typename S::Scalar& h, Configuration<S>& q, Velocity<S>& v,
                                        const Acceleration& acceleration) {
  constexpr std::size_t stages = tableau.stages;
  std::array<Velocity<S>, stages> K, F;
  K[0] = v;
  if (const Outcome outcome = acceleration(t, q, v, F[0]); outcome != Outcome::ok) return {outcome};
  return {munthe_kaas_stages<tableau>(system, t, h, q, v, acceleration, K, F, [&] {
    const auto group = group_of(system);
    const Velocity<S> theta = weighted_sum<tableau, stages>(h, K);
    if (const Outcome outcome = outcome_of_turn(system, theta); outcome != Outcome::ok) return outcome;
    q = group.compose(q, group.exp(theta));
    v += weighted_sum<tableau, stages>(h, F);
    return Outcome::ok;
  })};
}

}  // namespace liebench
