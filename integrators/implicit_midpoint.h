#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "groups/entrywise.h"
#include "integrators/affine_closure.h"
#include "integrators/audit.h"
#include "integrators/basic_stepper.h"
#include "integrators/fits.h"
#include "integrators/form.h"
#include "integrators/history.h"
#include "integrators/inlining.h"
#include "integrators/option.h"
#include "integrators/starting_values.h"

// The implicit midpoint rule on a Lie group, of order 2 and symmetric:
//
//   M(q_w) (v_{n+1} - v_n) = -h g(t_n + h/2, q_w, w),   w = (v_n + v_{n+1}) / 2,   q_w = q_n o exp(h/2 w~)
//   q_{n+1} = q_n o exp(h w~)
//
// It is the implicit Euler method over h / 2, w - v_n = h/2 v'_w, q_w = q_n o exp(h/2 w~), and its mirror image: the
// step equation is solved for that, and the mirror image is q_{n+1} = q_w o exp(h/2 w~), v_{n+1} = 2 w - v_n. In a
// linear space it is the classical rule: it keeps quadratic invariants there.

namespace liebench {

// h_ of the base is half of the step size.
template <MechanicalSystem S, class Audit>
class ImplicitMidpointStepper : public BasicStepper<S, Form::index3, Audit> {
  using Base = BasicStepper<S, Form::index3, Audit>;

 public:
  using Base::system;
  using typename Base::T;
  int steps() const { return 1; }
  int starting_points() const { return 1; }

  ImplicitMidpointStepper(const S& system, bool safeguard)
      : Base(system, safeguard), changes_(3, zero_velocity(system)) {}

  // From q_0 and v_0, with v'_0 for a prediction.
  StepResult start(const T& h, std::span<const SolutionPoint<S>> points) {
    h_ = h / T(2.0);
    t_ = points[0].t;
    q_ = points[0].q;
    velocity_ = points[0].v;
    first_change_ = h_ * points[0].acceleration;
    return {};
  }

  StepResult step() {
    return inlined_step<S>([this] { return take_step(); });
  }

 private:
  StepResult take_step() {
    const T t = t_;
    const Configuration<S> q = q_;
    const Velocity<S> v = velocity_;
    // d = w - v_n
    const AffineClosure<S> closure{.base_increment = v,
                                   .velocity = v,
                                   .velocity_slope = T(1.0),
                                   .velocity_change = zero_velocity(system()),
                                   .acceleration_slope = T(1.0),
                                   .scaled_acceleration = zero_velocity(system())};
    Velocity<S> change = changes_.size() > 0 ? changes_.extrapolated() : first_change_;
    Multipliers<S> none = zero_multipliers(system());
    typename Base::Point point;
    StepResult result = Base::advance(closure, change, none, point);
    if (result.outcome != Outcome::ok) return result;
    if (!Base::turns_by_less_than_pi(T(2.0) * point.step)) {
      t_ = t;
      q_ = q;
      set(velocity_, v);
      return {Outcome::rotation_too_large};
    }
    t_ = t + T(2.0) * h_;
    q_ = group_of(system()).compose(point.q, point.motion);
    set(velocity_, v + T(2.0) * change);
    changes_.push(change);
    return result;
  }

  using Base::h_;
  using Base::q_;
  using Base::t_;
  using Base::velocity_;

  History<Velocity<S>, 3> changes_;  // v'_w h / 2 of the steps before: for the prediction
  Velocity<S> first_change_;         // the same of the first step
};

struct ImplicitMidpoint {
  static constexpr std::string_view name = "implicit_midpoint";
  static constexpr std::string_view summary = "implicit midpoint rule on the group, order 2, symmetric";
  static constexpr Fits fits = Fits::without_constraints;
  static constexpr std::array option_list{safeguard_option};

  static std::string title(const OptionValues&) { return "implicit midpoint"; }
  static ConvergenceOrders orders(const OptionValues&) { return same_order(2); }
  static bool symmetric(const OptionValues&) { return true; }

  struct Options : SafeguardOptions {};
  static Options options(const OptionValues& values) { return {safeguard_options(values)}; }

  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options& options, const S& system, Visitor&& visit) {
    return visit(ImplicitMidpointStepper<S, Audit>(system, options.safeguard));
  }
};

}  // namespace liebench
