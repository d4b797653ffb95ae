#pragma once

#include <string>
#include <string_view>
#include <type_traits>

#include "integrators/fits.h"
#include "integrators/half_explicit_stepper.h"
#include "integrators/half_explicit_tableau.h"
#include "integrators/option.h"

namespace liebench {

// Half-explicit Runge-Kutta methods in canonical coordinates of the step: explicit but for one small linear system a
// stage, which gives multipliers that keep the hidden constraint B(q) v = 0; the constraint itself drifts by the error
// of the method, without `projection`. For systems that are not stiff. integrators/half_explicit_stepper.h has the
// equations. [Brasey & Hairer, SIAM Journal on Numerical Analysis 30 (1993) 538-552; Arnold, BIT 38 (1998) 415-438; Arnold &
// Tumiotto, Multibody Syst. Dyn. (2024), doi 10.1007/s11044-024-10002-8]
struct HalfExplicit {
  static constexpr std::string_view name = "half_explicit";
  static constexpr std::string_view summary =
      "half-explicit Runge-Kutta methods of the index-2 form, in canonical coordinates of the step";
  static constexpr Fits fits = Fits::with_constraints;
  static constexpr auto option_list = std::to_array<OptionInfo>({
      {.name = "tableau",
       .kind = OptionKind::choice,
       .fallback = 1,
       .choices = {"herk3", "herk4", "hedop5"},
       .meaning = "order 3 with 3 stages, order 4 with 5, or Dormand & Prince's of order 5 with 7"},
      {.name = "projection",
       .kind = OptionKind::boolean,
       .fallback = 0,
       .meaning =
           "each step ends with positions and velocities on the constraint and its hidden counterpart"},
  });

  enum class Tableau { herk3, herk4, hedop5 };

  // A tableau as a type.
  template <const auto& tableau_>
  struct Chosen {
    template <MechanicalSystem S, class Audit>
    using Stepper = HalfExplicitStepper<S, Audit, tableau_>;
    static constexpr ConvergenceOrders orders = tableau_.orders;
  };
  template <class Visitor>
  static auto with_tableau(Tableau tableau, const Visitor& visit) {
    switch (tableau) {
      case Tableau::herk3:
        return visit(Chosen<herk_three>{});
      case Tableau::hedop5:
        return visit(Chosen<hedop_five>{});
      case Tableau::herk4:
        break;
    }
    return visit(Chosen<herk_four>{});
  }

  static std::string title(const OptionValues& values) {
    const std::string& word = values.choice("tableau");
    const std::string name = word == "herk3" ? "HERK3" : word == "herk4" ? "HERK4" : "HEDOP5";
    return values.boolean("projection") ? name + ", projected" : name;
  }
  static ConvergenceOrders orders(const OptionValues& values) {
    return with_tableau(options(values).tableau, [](auto chosen) { return chosen.orders; });
  }
  static KeptConstraints kept_constraints(const OptionValues& values) {
    return {.position = values.boolean("projection"), .velocity = true};
  }

  struct Options {
    Tableau tableau = Tableau::herk4;
    bool projection = false;
  };
  static Options options(const OptionValues& values) {
    const std::string& word = values.choice("tableau");
    return {word == "herk3"    ? Tableau::herk3
            : word == "hedop5" ? Tableau::hedop5
                               : Tableau::herk4,
            values.boolean("projection")};
  }

  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options& options, const S& system, Visitor&& visit) {
    return with_tableau(options.tableau, [&](auto chosen) {
      using Stepper = typename decltype(chosen)::template Stepper<S, Audit>;
      return visit(Stepper(system, options.projection));
    });
  }
};

}  // namespace liebench
