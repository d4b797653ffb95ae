#pragma once

#include <array>
#include <string>
#include <string_view>

#include "integrators/bdf_stepper.h"
#include "integrators/centred_kinematics.h"
#include "integrators/fits.h"
#include "integrators/form.h"
#include "integrators/lie_correction.h"
#include "integrators/option.h"

// The k-step BDF method centred at the new point, k = 1, ..., 6, of order k: the classical method in canonical
// coordinates about q_{n+1}, where the tangent operator is the identity,
//
//   v_{n+1} = (1/h) sum_{i=1}^k alpha_i log(q_{n+1}^{-1} o q_{n+1-i}),   h v'_{n+1} = sum_{i=0}^k alpha_i v_{n+1-i}
//
// in the spirit of Faltinsen, Marthinsen & Munthe-Kaas 2001, whose coordinates are those about q_n
// (integrators/faltinsen_bdf.h). Kinematic equation: integrators/centred_kinematics.h. The k steps of the longest
// logarithm turn by less than pi together.
//
// Index 3: Phi(q_{n+1}) = 0; order reduction of lambda in the transient phase and its cure by modified starting
// velocities are those of BLieDF2nd, with the local error of this method. Stabilized index 2: B(q_n)^T eta_{n+1} joins
// Dq_n in the kinematic equation, not in the update of q, and B(q_{n+1}) v_{n+1} = 0.

namespace liebench {

struct CentredBdf {
  static constexpr std::string_view name = "centred_bdf";
  static constexpr std::string_view summary =
      "k-step BDF method in canonical coordinates about the new point: logarithms alone";
  static constexpr Fits fits = Fits::every_system;
  static constexpr auto option_list = std::to_array<OptionInfo>({
      steps_option(6),
      modified_start_option,
      form_option,
      safeguard_option,
  });

  static std::string title(const OptionValues& values) {
    return "centred BDF, k = " + std::to_string(values.integer("k"));
  }
  static ConvergenceOrders orders(const OptionValues& values) { return same_order(values.integer("k")); }

  struct Options {
    int k = 2;
    bool modified_start = false;
    Form form = Form::index3;
    bool safeguard = false;

    bool explicit_correction() const { return false; }
  };
  static Options options(const OptionValues& values) {
    return {.k = values.integer("k"),
            .modified_start = values.boolean_or("modified_start", false),
            .form = form_of(values.choice_or("form", "")),
            .safeguard = values.boolean_or("safeguard", false)};
  }

  // Where no logarithm bends, the method is BLieDF2nd without a correction.
  template <MechanicalSystem S, Form form = Form::index3, class Audit = NoAudit>
  using PlainStepper = BdfStepper<S, form, Audit, ExplicitCorrection<S>>;
  template <MechanicalSystem S, Form form = Form::index3, class Audit = NoAudit>
  using Stepper = BdfStepper<S, form, Audit, CentredKinematics<S>>;

  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options& options, const S& system, Visitor&& visit) {
    return with_form<S>(options.form, [&]<Form form>(FormConstant<form>) {
      if constexpr (may_have_commutators<S>())
        if (has_commutators(system) && options.k > 1) return visit(Stepper<S, form, Audit>(system, options));
      return visit(PlainStepper<S, form, Audit>(system, options));
    });
  }
};

}  // namespace liebench
