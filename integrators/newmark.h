#pragma once

#include <array>
#include <string>
#include <string_view>

#include "integrators/fits.h"
#include "integrators/generalized_alpha.h"
#include "integrators/option.h"

// Newmark's method on a Lie group with beta = 1/4, gamma = 1/2 (the average acceleration), of order 2 and symmetric:
//
//   q_{n+1} = q_n o exp(h Dq~),   Dq = v_n + h/4 (v'_n + v'_{n+1}),   v_{n+1} = v_n + h/2 (v'_n + v'_{n+1})
//   M v'_{n+1} = -g
//
// [Simo & Vu-Quoc 1988; Bruels & Cardona 2010]: generalized-alpha with alpha_m = alpha_f = 0, where a_n = v'_n. With
// constraints it is weakly unstable [Cardona & Geradin 1989].

namespace liebench {

struct Newmark {
  static constexpr std::string_view name = "newmark";
  static constexpr std::string_view summary =
      "Newmark's method on the group with the average acceleration, order 2, symmetric";
  static constexpr Fits fits = Fits::without_constraints;
  static constexpr std::array option_list{safeguard_option};

  static std::string title(const OptionValues&) { return "Newmark, beta = 1/4, gamma = 1/2"; }
  static ConvergenceOrders orders(const OptionValues&) { return same_order(2); }
  static bool symmetric(const OptionValues&) { return true; }

  struct Options : SafeguardOptions {};
  static Options options(const OptionValues& values) { return {safeguard_options(values)}; }

  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options& options, const S& system, Visitor&& visit) {
    using Stepper = GeneralizedAlpha::Stepper<S, Form::index3, Audit>;
    const auto parameters = GeneralizedAlphaParameters<typename S::Scalar>::average_acceleration();
    return visit(Stepper(system, parameters, options.safeguard));
  }
};

}  // namespace liebench
