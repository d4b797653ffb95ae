#pragma once

#include <array>
#include <limits>
#include <string>
#include <string_view>

#include "integrators/explicit_stepper.h"
#include "integrators/fits.h"
#include "integrators/option.h"
#include "integrators/runge_kutta_munthe_kaas.h"

// The explicit Newmark method (beta = 0, gamma = 1/2: velocity Verlet) on a Lie group, after Krysl & Endres, Explicit
// Newmark/Verlet algorithm for time integration of the rotational dynamics of rigid bodies (International Journal for Numerical Methods in
// Engineering 62, 2005, 2154-2177):
//
//   w = v_n + h/2 v'_n,   q_{n+1} = q_n o exp(h w~),   v_{n+1} = w + h/2 v'_{n+1}
//
// Order 2, symmetric; one exponential a step. Forces of the velocity, at least the gyroscopic ones, make the last equation one
// for v_{n+1}, which is iterated: that contracts by h/2 |dv'/dv|.
struct ExplicitNewmark {
  static constexpr std::string_view name = "explicit_newmark";
  static constexpr std::string_view summary = "explicit Newmark method on the group, order 2, symmetric";
  static constexpr liebench::Fits fits = liebench::Fits::without_constraints;
  static constexpr std::array<liebench::OptionInfo, 0> option_list{};
  static std::string title(const liebench::OptionValues&) { return "explicit Newmark"; }
  static liebench::ConvergenceOrders orders(const liebench::OptionValues&) { return liebench::same_order(2); }

  struct Options {};
  static Options options(const liebench::OptionValues&) { return {}; }

  struct Scheme {
    template <liebench::MechanicalSystem S, class Acceleration>
    static liebench::StepResult step(const S& system, const typename S::Scalar& t,
                                     const typename S::Scalar& h, liebench::Configuration<S>& q,
                                     liebench::Velocity<S>& v, const Acceleration& acceleration) {
      using liebench::Outcome;
      using T = typename S::Scalar;
      using Velocity = liebench::Velocity<S>;
      const auto group = liebench::group_of(system);
      const T half = h / T(2.0);
      Velocity F;
      if (const Outcome o = acceleration(t, q, v, F); o != Outcome::ok) return {o};
      const Velocity middle = v + half * F, turn = h * middle;
      if (const Outcome o = liebench::outcome_of_turn(system, turn); o != Outcome::ok) return {o};
      const liebench::Configuration<S> next = group.compose(q, group.exp(turn));
      Velocity w = middle + half * F;
      for (int iteration = 0; iteration < most_iterations; ++iteration) {
        if (const Outcome o = acceleration(T(t + h), next, w, F); o != Outcome::ok) return {o};
        const Velocity better = middle + half * F;
        const double change = liebench::to_double(T((better - w).norm()));
        w = better;
        // Within the rounding of w.
        if (change <= 4 * epsilon * liebench::to_double(T(w.norm()))) {
          q = next;
          v = w;
          return {};
        }
      }
      return {Outcome::newton_diverged};
    }
    static constexpr int most_iterations = 50;
    static constexpr double epsilon = std::numeric_limits<double>::epsilon();
  };

  template <liebench::MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options&, const S& system, Visitor&& visit) {
    return visit(liebench::ExplicitStepper<S, Audit, Scheme>(system));
  }
};
