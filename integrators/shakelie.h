#pragma once

#include <array>
#include <string>
#include <string_view>

#include "integrators/audit.h"
#include "integrators/fits.h"
#include "integrators/inlining.h"
#include "integrators/option.h"
#include "integrators/variational_stepper.h"

// SHAKELie [Hante & Arnold 2021]: RATTLie without the projection of velocities, with one lambda_n at each point,
//
//   T^{-T}(-h Dq) M Dq + h/2 f(q_n) + h/2 B(q_n)^T lambda_n = p_n,   q_{n+1} = q_n o exp(h Dq~),   Phi(q_{n+1}) = 0
//   p_{n+1} = T^{-T}(h Dq) M Dq - h/2 f(q_{n+1}) - h/2 B(q_{n+1})^T lambda_{n+1},   p = M v
//
// The first line minus the second of the step before has no p_n: in exact arithmetic q_n and lambda_n are those of
// RATTLie from the same values. v_n is another, for which B(q_n) v_n = O(h^2). As there, a step ends with the first
// line of the next.

namespace liebench {

template <MechanicalSystem S, class Audit>
class ShakelieStepper : public VariationalStepper<S, Audit> {
  static_assert(ConstrainedSystem<S>);
  using Base = VariationalStepper<S, Audit>;

 public:
  using Base::system;
  using typename Base::T;

  explicit ShakelieStepper(const S& system) : Base(system) {}

  StepResult step() {
    return inlined_step<S>([this] { return take_step(); });
  }

 private:
  using Base::ahead_;
  using Base::h_;
  using Base::is_ahead_;
  using Base::lambda_;
  using Base::t_;
  using typename Base::Solution;

  StepResult take_step() {
    if (!is_ahead_) {
      const StepResult result =
          Base::solve_from_velocity(t_, Base::q_, Base::velocity_, Base::force_, ahead_);
      if (result.outcome != Outcome::ok) return result;
      is_ahead_ = true;
      // From now on a solution takes two half steps of force.
      Base::keep(T(2.0) * ahead_.change, T(2.0) * ahead_.impulse);
    }
    const T t = t_ + h_;
    const Configuration<S>& q = ahead_.point.q;
    const Velocity<S>& increment = ahead_.point.values.velocity;
    const Velocity<S> f = Base::force_behind(t, ahead_);
    const Velocity<S> transported = Base::transported_behind(ahead_);
    Solution next = ahead_;  // GCC does not see that it is written where it is read
    StepResult result =
        Base::solve_from(t, q, {increment, ahead_.point.momentum, h_ * f - transported}, next);
    if (result.outcome != Outcome::ok) return result;
    const Velocity<S> kicks = transported - (h_ * f + system().constraint_force(q, next.impulse)) / T(2.0);
    Velocity<S> v = zero_velocity(system());
    result = Base::solve_mass(q, kicks, v);
    if (result.outcome != Outcome::ok) return result;
    set(v, v + increment);
    Base::keep(next.change, next.impulse);
    set(lambda_, next.impulse / h_);
    Base::move_to(t, q, v, f);
    ahead_ = next;
    return result;
  }
};

struct Shakelie {
  static constexpr std::string_view name = "shakelie";
  static constexpr std::string_view summary =
      "SHAKELie of Hante & Arnold, order 2: RATTLie without the projection of velocities on the hidden "
      "constraint";
  static constexpr Fits fits = Fits::with_constraints;
  static constexpr std::array<OptionInfo, 0> option_list{};

  static std::string title(const OptionValues&) { return "SHAKELie"; }
  static ConvergenceOrders orders(const OptionValues&) { return same_order(2); }
  static KeptConstraints kept_constraints(const OptionValues&) {
    return {.position = true, .velocity = false};
  }

  struct Options {};
  static Options options(const OptionValues&) { return {}; }

  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options&, const S& system, Visitor&& visit) {
    return visit(ShakelieStepper<S, Audit>(system));
  }
};

}  // namespace liebench
