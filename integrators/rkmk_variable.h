#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "groups/decimal.h"
#include "groups/entrywise.h"
#include "integrators/explicit_stepper.h"
#include "integrators/fits.h"
#include "integrators/inlining.h"
#include "integrators/option.h"
#include "integrators/runge_kutta_munthe_kaas.h"
#include "integrators/step_control.h"

namespace liebench {

// The Runge-Kutta-Munthe-Kaas method with the tableau of Dormand & Prince of order 5, whose steps follow from the difference to
// its embedded solution of order 4. Both solutions are increments from the same q_n, and so their difference is one of vectors:
//
//   theta - theta^ = h sum_{i=1}^7 (b_i - b^_i) K_i,   v - v^ = h sum_{i=1}^7 (b_i - b^_i) F_i
//
// The seventh stage is the step itself, and its F the first of the next step.
struct RkmkVariable {
  static constexpr std::string_view name = "rkmk_variable";
  static constexpr std::string_view summary =
      "explicit Runge-Kutta-Munthe-Kaas method DOPRI5(4) with steps by a tolerance";
  static constexpr Fits fits = Fits::without_constraints;
  static constexpr auto option_list = std::to_array<OptionInfo>({tolerance_option});
  static std::string title(const OptionValues&) { return "RKMK dopri5, variable step"; }
  static ConvergenceOrders orders(const OptionValues&) {
    return {.q = 5, .v = 5, .lambda = 5, .estimate = 5};
  }

  struct Options {
    double tolerance = 1e-6;
  };
  static Options options(const OptionValues& values) { return {.tolerance = values.real("tolerance")}; }

  template <MechanicalSystem S, class Audit>
  class Stepper;

  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options& options, const S& system, Visitor&& visit) {
    return visit(Stepper<S, Audit>(system, options));
  }
};

template <MechanicalSystem S, class Audit>
class RkmkVariable::Stepper : public BasicExplicitStepper<S, Audit> {
  using Base = BasicExplicitStepper<S, Audit>;

 public:
  using typename Base::T;

  Stepper(const S& system, const Options& options)
      : Base(system), tolerance_(options.tolerance), control_(5), acceleration_(zero_velocity(system)) {}

  int steps() const { return 1; }
  int starting_points() const { return 1; }

  // The interval [t_0, t_0 + length], from q_0 and v_0.
  StepResult start(const T& length, std::span<const SolutionPoint<S>> points) {
    Base::begin(length, points[0]);
    t_end_ = t_ + length;
    control_ = StepControl(5);
    if (length == T(0.0)) return {};
    const Outcome outcome = Base::acceleration(t_, q_, velocity_, acceleration_);
    if (outcome != Outcome::ok) return {outcome};
    h_ = first_step(length);
    return {h_ != T(0.0) ? Outcome::ok : Outcome::non_finite};
  }
  bool finished() const { return t_ == t_end_; }

  // One step that is accepted.
  StepResult step() {
    return inlined_step<S>([this] { return take_step(); });
  }

 private:
  static constexpr const auto& tableau = dormand_prince_pair;
  static constexpr std::size_t stages = tableau.stages;
  using Base::h_;
  using Base::q_;
  using Base::t_;
  using Base::velocity_;

  StepResult take_step() {
    for (;;) {
      const T left = t_end_ - t_;
      const bool last = !(abs_of(h_) < abs_of(left));
      const T h = last ? left : h_;
      // No time passes any more.
      if (!last && t_ + h == t_) return {Outcome::step_limit};
      Configuration<S> q_next = q_;
      Velocity<S> v_next = velocity_;
      const auto acceleration = [&](const T& t, const Configuration<S>& Q, const Velocity<S>& V,
                                    Velocity<S>& F) {
        q_next = Q;
        v_next = V;
        return Base::acceleration(t, Q, V, F);
      };
      std::array<Velocity<S>, stages> K, F;
      K[0] = velocity_;
      F[0] = acceleration_;
      double error = 0.0;
      const Outcome outcome =
          munthe_kaas_stages<tableau>(Base::system_, t_, h, q_, velocity_, acceleration, K, F, [&] {
            error = scaled_error<S>(weighted_sum<tableau, stages>(h, K), weighted_sum<tableau, stages>(h, F),
                                    v_next, tolerance_);
            if (error <= 1.0) acceleration_ = F[stages - 1];
            return std::isfinite(error) ? Outcome::ok : Outcome::non_finite;
          });
      if (outcome != Outcome::ok) {
        // A shorter step may do, if there is one to speak of.
        if (abs_of(h) < shortest_part * abs_of(t_end_)) return {outcome};
        control_.fail();
      } else if (control_.accept(error)) {
        q_ = q_next;
        velocity_ = v_next;
        t_ = last ? t_end_ : t_ + h;
        // The end of the interval cuts the last step: it says nothing of the next.
        h_ = h * T(control_.factor());
        return {};
      }
      Base::audit_.rejection();
      h_ = h * T(control_.factor());
    }
  }

  // By the size of v and v' [Hairer, Norsett & Wanner, II.4], without their second evaluation: 0.1 tol^{1/5} of the time in which the
  // velocity changes by itself or the body turns by a radian.
  T first_step(const T& length) const {
    const double v = to_double(T(velocity_.norm())), a = to_double(T(acceleration_.norm()));
    const double rate = v + a / (1.0 + v);
    if (!std::isfinite(rate)) return T(0.0);
    const double h = 0.1 * std::pow(std::min(tolerance_, 1e-2), 0.2) / std::max(rate, 1e-6);
    const T wanted = T(length < T(0.0) ? -h : h);
    return abs_of(wanted) < abs_of(length) ? wanted : length;
  }

  static constexpr double shortest_part = 1e-12;
  double tolerance_;
  StepControl control_;
  T t_end_ = T(0.0);
  Velocity<S> acceleration_;  // v'_n
};

}  // namespace liebench
