#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "integrators/audit.h"
#include "integrators/bdf_stepper.h"
#include "integrators/fits.h"
#include "integrators/form.h"
#include "integrators/lie_correction.h"
#include "integrators/option.h"

// BLieDF2nd, the k-step BDF method for second-order systems on Lie groups of Wieloch & Arnold, k = 1, ..., 6 (the paper has
// k = 2, 3, 4):
//
//   q_{n+1} = q_n o exp(h Dq_n~)                                                          (20a), (23a)
//   sum_{i=1}^k gamma_i Dq_{n+1-i} = v_{n+1} + h^2 L_k(v_n, ..., v_{n-k+1})               (20b), (23b)
//   (1/h) M(q_{n+1}) sum_{i=0}^k alpha_i v_{n+1-i} = -g - B^T lambda at t_{n+1}           (20c), (23c)
//   Phi(q_{n+1}) = 0                                                                      (23d), index 3
//
// In the stabilized index-2 form gamma_1 B(q_n)^T eta_{n+1} joins the left side of (23b), and B(q_{n+1}) v_{n+1} = 0; there
// lambda has no transient phase and needs no modified start.
//
// Order k in q, v and lambda with L_k, order min(k, 2) with L_k = 0. L_k and its implicit evaluation:
// integrators/lie_correction.h.

namespace liebench {

enum class Correction { none, explicit_term, implicit_term };

struct BLieDF2nd {
  static constexpr std::string_view name = "bliedf2nd";
  static constexpr std::string_view summary =
      "k-step BDF method of Wieloch & Arnold with one commutator a step as correction L_k";
  static constexpr Fits fits = Fits::every_system;
  static constexpr auto option_list = std::to_array<OptionInfo>({
      steps_option(6),
      {.name = "correction",
       .kind = OptionKind::boolean_or_choice,
       .fallback = 1,
       .choices = {"implicit"},
       .meaning =
           "L_k of eq. (22) from the velocities so far; false: L_k = 0, order min(k, 2); implicit: L_k at "
           "t_{n+1}, stable in the index-3 form where the explicit one of k = 5, 6 is not"},
      modified_start_option,
      form_option,
      safeguard_option,
  });

  static std::string title(const OptionValues& values) {
    const std::string correction = values.is_choice("correction")  ? ", L_k implicit"
                                   : !values.boolean("correction") ? ", L_k = 0"
                                                                   : "";
    return "BLieDF2nd, k = " + std::to_string(values.integer("k")) + correction;
  }
  static ConvergenceOrders orders(const OptionValues& values) {
    const int k = values.integer("k");
    const bool corrected = values.is_choice("correction") || values.boolean("correction");
    return same_order(corrected ? k : std::min(k, 2));
  }

  struct Options {
    int k = 2;
    Correction correction = Correction::explicit_term;
    bool modified_start = false;
    Form form = Form::index3;
    bool safeguard = false;

    bool explicit_correction() const { return correction == Correction::explicit_term; }
  };
  static Options options(const OptionValues& values) {
    Options options{.k = values.integer("k"),
                    .modified_start = values.boolean_or("modified_start", false),
                    .form = form_of(values.choice_or("form", "")),
                    .safeguard = values.boolean_or("safeguard", false)};
    if (values.is_choice("correction"))
      options.correction = Correction::implicit_term;
    else if (!values.boolean("correction"))
      options.correction = Correction::none;
    return options;
  }

  template <MechanicalSystem S, Form form = Form::index3, class Audit = NoAudit>
  using Stepper = BdfStepper<S, form, Audit, ExplicitCorrection<S>>;
  // k >= 3, where there is a correction, on groups with commutators.
  template <MechanicalSystem S, Form form = Form::index3, class Audit = NoAudit>
  using ImplicitStepper = BdfStepper<S, form, Audit, ImplicitCorrection<S>>;

  // Calls visit(stepper) with the stepper that the options ask for.
  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options& options, const S& system, Visitor&& visit) {
    return with_form<S>(options.form, [&]<Form form>(FormConstant<form>) {
      if constexpr (may_have_commutators<S>())
        if (has_commutators(system) && options.k >= 3 && options.correction == Correction::implicit_term)
          return visit(ImplicitStepper<S, form, Audit>(system, options));
      return visit(Stepper<S, form, Audit>(system, options));
    });
  }
};

}  // namespace liebench
