#pragma once

#include <array>
#include <string>
#include <string_view>

#include "integrators/explicit_stepper.h"
#include "integrators/fits.h"
#include "integrators/option.h"
#include "integrators/runge_kutta_munthe_kaas.h"

namespace liebench {

// The commutator-free method of order 4 of Celledoni, Marthinsen & Owren (Future Generation Computer Systems 19, 2003, 341-352), for
// q' = DL_q(e) v~; v on R^m by Kutta's method of order 4 with the same stages, F_i = v'(t_i, q_i, v_i):
//
//   q_2 = q_n o exp(h/2 v_1),  q_3 = q_n o exp(h/2 v_2),  q_4 = q_2 o exp(h v_3 - h/2 v_1)
//   q_{n+1} = q_n o exp(h/12 (3 v_1 + 2 v_2 + 2 v_3 - v_4)) o exp(h/12 (-v_1 + 2 v_2 + 2 v_3 + 3 v_4))
//
// No T^{-1}, no commutator; five exponentials.
struct CommutatorFree {
  static constexpr std::string_view name = "commutator_free";
  static constexpr std::string_view summary =
      "explicit commutator-free method CF4 of Celledoni, Marthinsen & Owren, order 4";
  static constexpr Fits fits = Fits::without_constraints;
  static constexpr std::array<OptionInfo, 0> option_list{};
  static std::string title(const OptionValues&) { return "commutator-free CF4"; }
  static ConvergenceOrders orders(const OptionValues&) { return same_order(4); }

  struct Options {};
  static Options options(const OptionValues&) { return {}; }

  struct Scheme {
    template <MechanicalSystem S, class Acceleration>
    static StepResult step(const S& system, const typename S::Scalar& t, const typename S::Scalar& h,
                           Configuration<S>& q, Velocity<S>& v, const Acceleration& acceleration) {
      using T = typename S::Scalar;
      const auto group = group_of(system);
      const T half = h / T(2.0), twelfth = h / T(12.0);
      Velocity<S> F1, F2, F3, F4;
      Outcome outcome = Outcome::ok;
      const auto evaluate = [&](const T& time, const Configuration<S>& Q, const Velocity<S>& V,
                                Velocity<S>& F) {
        outcome = acceleration(time, Q, V, F);
        return outcome == Outcome::ok;
      };
      const auto may_turn = [&](const Velocity<S>& theta) {
        outcome = outcome_of_turn(system, theta);
        return outcome == Outcome::ok;
      };
      const auto moved = [&](const Configuration<S>& from, const Velocity<S>& theta) {
        return Configuration<S>(group.compose(from, group.exp(theta)));
      };
      if (!evaluate(t, q, v, F1)) return {outcome};
      const Velocity<S> theta2 = half * v;
      if (!may_turn(theta2)) return {outcome};
      const Configuration<S> q2 = moved(q, theta2);
      const Velocity<S> v2 = v + half * F1;
      if (!evaluate(T(t + half), q2, v2, F2)) return {outcome};
      const Velocity<S> theta3 = half * v2;
      if (!may_turn(theta3)) return {outcome};
      const Velocity<S> v3 = v + half * F2;
      if (!evaluate(T(t + half), moved(q, theta3), v3, F3)) return {outcome};
      const Velocity<S> theta4 = h * v3 - theta2;
      if (!may_turn(theta4)) return {outcome};
      const Velocity<S> v4 = v + h * F3;
      if (!evaluate(T(t + h), moved(q2, theta4), v4, F4)) return {outcome};
      const Velocity<S> middle = T(2.0) * (v2 + v3);
      const Velocity<S> first = twelfth * (T(3.0) * v + middle - v4);
      const Velocity<S> second = twelfth * (middle - v + T(3.0) * v4);
      if (!may_turn(first + second)) return {outcome};
      q = moved(moved(q, first), second);
      v += (h / T(6.0)) * (F1 + T(2.0) * (F2 + F3) + F4);
      return {};
    }
  };

  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options&, const S& system, Visitor&& visit) {
    return visit(ExplicitStepper<S, Audit, Scheme>(system));
  }
};

}  // namespace liebench
