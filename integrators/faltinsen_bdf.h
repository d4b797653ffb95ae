#pragma once

#include <array>
#include <string>
#include <string_view>

#include "integrators/audit.h"
#include "integrators/bdf_stepper.h"
#include "integrators/faltinsen_kinematics.h"
#include "integrators/fits.h"
#include "integrators/form.h"
#include "integrators/lie_correction.h"
#include "integrators/option.h"

// The k-step BDF method of Faltinsen, Marthinsen & Munthe-Kaas (Applied Numerical Mathematics 39, 2001, 349-365) for
// second-order systems, k = 1, ..., 4, of order k: the classical method in canonical coordinates about q_n, which move with
// every step. Kinematic equation and variants: integrators/faltinsen_kinematics.h. The velocities, in the linear space R^m,
// follow the classical BDF method.
//
// Index 3: Phi(q_{n+1}) = 0; order reduction of lambda in the transient phase and its cure by modified starting velocities
// are those of BLieDF2nd, with the local error of this method. Stabilized index 2: B(q_n)^T eta_{n+1} joins Dq_n in the
// kinematic equation, not in the update of q, and B(q_{n+1}) v_{n+1} = 0.

namespace liebench {

struct FaltinsenBdf {
  static constexpr std::string_view name = "faltinsen_bdf";
  static constexpr std::string_view summary =
      "k-step BDF method of Faltinsen, Marthinsen & Munthe-Kaas in canonical coordinates that move with the "
      "step";
  static constexpr Fits fits = Fits::every_system;
  static constexpr auto option_list = std::to_array<OptionInfo>({
      steps_option(4),
      {.name = "variant",
       .kind = OptionKind::choice,
       .fallback = 0,
       .choices = {"exact", "bch"},
       .meaning = "logarithms, or series with the least number of commutators"},
      modified_start_option,
      form_option,
      safeguard_option,
  });

  static std::string title(const OptionValues& values) {
    return "Faltinsen BDF " + values.choice("variant") + ", k = " + std::to_string(values.integer("k"));
  }
  static ConvergenceOrders orders(const OptionValues& values) { return same_order(values.integer("k")); }

  enum class Variant { exact, bch };
  struct Options {
    int k = 2;
    Variant variant = Variant::exact;
    bool modified_start = false;
    Form form = Form::index3;
    bool safeguard = false;

    bool explicit_correction() const { return false; }
  };
  static Options options(const OptionValues& values) {
    return {.k = values.integer("k"),
            .variant = values.choice("variant") == "bch" ? Variant::bch : Variant::exact,
            .modified_start = values.boolean_or("modified_start", false),
            .form = form_of(values.choice_or("form", "")),
            .safeguard = values.boolean_or("safeguard", false)};
  }

  // Where no logarithm and no commutator enters, the method is BLieDF2nd without a correction.
  template <MechanicalSystem S>
  static bool is_plain(const Options& options, const S& system) {
    return !has_commutators(system) || options.k == 1 || (options.k == 2 && options.variant == Variant::bch);
  }
  template <MechanicalSystem S, Form form = Form::index3, class Audit = NoAudit>
  using PlainStepper = BdfStepper<S, form, Audit, ExplicitCorrection<S>>;
  template <MechanicalSystem S, Variant variant, Form form = Form::index3, class Audit = NoAudit>
  using Stepper = BdfStepper<S, form, Audit, FaltinsenKinematics<S, variant == Variant::exact>>;

  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options& options, const S& system, Visitor&& visit) {
    return with_form<S>(options.form, [&]<Form form>(FormConstant<form>) {
      if constexpr (may_have_commutators<S>())
        if (!is_plain(options, system)) {
          if (options.variant == Variant::bch)
            return visit(Stepper<S, Variant::bch, form, Audit>(system, options));
          return visit(Stepper<S, Variant::exact, form, Audit>(system, options));
        }
      return visit(PlainStepper<S, form, Audit>(system, options));
    });
  }
};

}  // namespace liebench
