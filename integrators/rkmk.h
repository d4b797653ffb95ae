#pragma once

#include <array>
#include <string>
#include <string_view>

#include "integrators/explicit_stepper.h"
#include "integrators/fits.h"
#include "integrators/option.h"
#include "integrators/runge_kutta_munthe_kaas.h"

namespace liebench {

// Runge-Kutta-Munthe-Kaas methods in canonical coordinates of the first kind about q_n, with T^{-1} in closed form: the order on the
// group is that of the tableau. integrators/runge_kutta_munthe_kaas.h has the equations.
struct Rkmk {
  static constexpr std::string_view name = "rkmk";
  static constexpr std::string_view summary =
      "explicit Runge-Kutta-Munthe-Kaas methods: a classical tableau in canonical coordinates of the step";
  static constexpr Fits fits = Fits::without_constraints;
  static constexpr auto option_list = std::to_array<OptionInfo>({
      {.name = "tableau",
       .kind = OptionKind::choice,
       .fallback = 0,
       .choices = {"rk4", "dopri5", "butcher6"},
       .meaning =
           "Kutta's of order 4, Dormand & Prince's of order 5 with 6 stages, Butcher's of order 6 with 7"},
  });

  enum class Tableau { rk4, dopri5, butcher6 };

  template <const auto& tableau>
  struct Scheme {
    template <MechanicalSystem S, class Acceleration>
    static StepResult step(const S& system, const typename S::Scalar& t, const typename S::Scalar& h,
                           Configuration<S>& q, Velocity<S>& v, const Acceleration& acceleration) {
      return runge_kutta_munthe_kaas_step<tableau>(system, t, h, q, v, acceleration);
    }
  };

  template <class Visitor>
  static auto with_tableau(Tableau tableau, const Visitor& visit) {
    switch (tableau) {
      case Tableau::dopri5:
        return visit(Scheme<dormand_prince_five>{});
      case Tableau::butcher6:
        return visit(Scheme<butcher_six>{});
      case Tableau::rk4:
        break;
    }
    return visit(Scheme<classical_four>{});
  }

  static std::string title(const OptionValues& values) { return "RKMK " + values.choice("tableau"); }
  static ConvergenceOrders orders(const OptionValues& values) {
    return with_tableau(
        options(values).tableau,
        []<const auto & tableau>(Scheme<tableau>) { return same_order(tableau.order); });
  }

  struct Options {
    Tableau tableau = Tableau::rk4;
  };
  static Options options(const OptionValues& values) {
    const std::string& word = values.choice("tableau");
    return {word == "dopri5" ? Tableau::dopri5 : word == "butcher6" ? Tableau::butcher6 : Tableau::rk4};
  }

  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options& options, const S& system, Visitor&& visit) {
    return with_tableau(options.tableau, [&]<class Chosen>(Chosen) {
      return visit(ExplicitStepper<S, Audit, Chosen>(system));
    });
  }
};

}  // namespace liebench
