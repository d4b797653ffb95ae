#pragma once

#include <array>
#include <string>
#include <string_view>
#include <type_traits>

#include "integrators/explicit_stepper.h"
#include "integrators/fits.h"
#include "integrators/option.h"
#include "integrators/runge_kutta_munthe_kaas.h"
#include "integrators/runge_kutta_tableau.h"

namespace liebench {

// The coefficients of the method of order 3 of Crouch & Grossman (Journal of Nonlinear Science 3, 1993, 1-33).
inline constexpr ExplicitTableau<3> crouch_grossman_three{.a = {{{}, {{{3, 4}}}, {{{119, 216}, {17, 108}}}}},
                                                          .b = {{{13, 51}, {-2, 3}, {24, 17}}},
                                                          .c = {{{}, {3, 4}, {17, 24}}},
                                                          .order = 3};

// Its stages are products of exponentials, for q' = DL_q(e) v~; v on R^m by the same tableau, F_i = v'(t_i, q_i, v_i):
//
//   q_i = q_n o exp(h a_i1 v_1) o ... o exp(h a_{i,i-1} v_{i-1}),  q_{n+1} = q_n o exp(h b_1 v_1) o exp(h b_2 v_2) o exp(h b_3 v_3)
//
// Six exponentials; the conditions of order 3 hold beside those of a Runge-Kutta method.
struct CrouchGrossman {
  static constexpr std::string_view name = "crouch_grossman";
  static constexpr std::string_view summary =
      "explicit method of Crouch & Grossman of order 3: products of exponentials";
  static constexpr Fits fits = Fits::without_constraints;
  static constexpr std::array<OptionInfo, 0> option_list{};
  static std::string title(const OptionValues&) { return "Crouch-Grossman CG3"; }
  static ConvergenceOrders orders(const OptionValues&) { return same_order(3); }

  struct Options {};
  static Options options(const OptionValues&) { return {}; }

  struct Scheme {
    template <MechanicalSystem S, class Acceleration>
    static StepResult step(const S& system, const typename S::Scalar& t, const typename S::Scalar& h,
                           Configuration<S>& q, Velocity<S>& v, const Acceleration& acceleration) {
      using T = typename S::Scalar;
      constexpr const auto& tableau = crouch_grossman_three;
      constexpr std::size_t stages = tableau.stages;
      const auto group = group_of(system);
      std::array<Velocity<S>, stages> V, F;
      // q o exp(h w_1 v_1) o ..., w the row i of the tableau, of which i are not zero.
      const auto product = [&](std::size_t i, Configuration<S>& to) {
        to = q;
        for (std::size_t j = 0; j < i; ++j) {
          const Velocity<S> theta = (value_of<T>(tableau.row(i)[j]) * h) * V[j];
          if (const Outcome outcome = outcome_of_turn(system, theta); outcome != Outcome::ok) return outcome;
          to = group.compose(to, group.exp(theta));
        }
        return Outcome::ok;
      };
      // The stages from i on, and the step where there are no more.
      const auto go_on = [&]<std::size_t i>(const auto& self,
                                            std::integral_constant<std::size_t, i>) -> Outcome {
        Configuration<S> Q;
        if (const Outcome outcome = product(i, Q); outcome != Outcome::ok) return outcome;
        const Velocity<S> next = v + weighted_sum<tableau, i>(h, F);
        if constexpr (i == stages) {
          const Velocity<S> whole = weighted_sum<tableau, i>(h, V);
          if (const Outcome outcome = outcome_of_turn(system, whole); outcome != Outcome::ok) return outcome;
          q = Q;
          v = next;
          return Outcome::ok;
        } else {
          V[i] = next;
          const T time = t + value_of<T>(tableau.c[i]) * h;
          if (const Outcome outcome = acceleration(time, Q, V[i], F[i]); outcome != Outcome::ok)
            return outcome;
          return self(self, std::integral_constant<std::size_t, i + 1>{});
        }
      };
      V[0] = v;
      if (const Outcome outcome = acceleration(t, q, v, F[0]); outcome != Outcome::ok) return {outcome};
      return {go_on(go_on, std::integral_constant<std::size_t, 1>{})};
    }
  };

  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options&, const S& system, Visitor&& visit) {
    return visit(ExplicitStepper<S, Audit, Scheme>(system));
  }
};

}  // namespace liebench
