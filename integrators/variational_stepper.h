#pragma once

#include "integrators/momentum_stepper.h"

namespace liebench {

// The step equation of RATTLie and SHAKELie [Hante & Arnold 2021], solved from (q_n, v_n) or from the increment
// before: q_{n+1} and the impulse of the constraints at q_n. Where there are constraints lambda_n takes two impulses,
// before and behind q_n: their steppers are one such solution ahead.
template <MechanicalSystem S, class Audit>
class VariationalStepper : public MomentumStepper<S, Audit, VariationalTransport> {
  using Base = MomentumStepper<S, Audit, VariationalTransport>;

 public:
  using Base::system;
  using typename Base::T;

  StepResult start(const T& h, std::span<const SolutionPoint<S>> points) {
    is_ahead_ = false;
    return Base::start(h, points);
  }

 protected:
  using Base::h_;
  using Base::velocity_;
  using typename Base::Closure;

  struct Solution {
    typename Base::Point point;
    Velocity<S> change;
    Multipliers<S> impulse;
  };

  explicit VariationalStepper(const S& system)
      : Base(system),
        changes_(3, zero_velocity(system)),
        impulses_(3, zero_multipliers(system)),
        ahead_{{}, zero_velocity(system), zero_multipliers(system)} {}

  bool constrained() const {
    if constexpr (S::constraints == 0)
      return false;
    else
      return multiplier_size(system()) != 0;
  }

  // T^{-T}(-h Dq) M Dq + h f / 2 + B^T mu = M v, predicted from the solutions before.
  StepResult solve_from_velocity(const T& t, const Configuration<S>& q, const Velocity<S>& v,
                                 const Velocity<S>& f, Solution& s) {
    return solve_from(t, q, {v, system().momentum(q, v), (h_ / T(2.0)) * f}, s);
  }
  StepResult solve_from(const T& t, const Configuration<S>& q, const Closure& closure, Solution& s) {
    set(s.change, changes_.size() > 0 ? changes_.extrapolated() : Base::first_change_);
    if constexpr (S::constraints != 0)
      s.impulse =
          impulses_.size() > 0 ? impulses_.extrapolated() : Multipliers<S>((h_ / T(2.0)) * Base::lambda_);
    return Base::solve(T(t + h_), h_, q, closure, s.change, s.impulse, s.point);
  }
  void keep(const Velocity<S>& change, const Multipliers<S>& impulse) {
    changes_.push(change);
    if constexpr (S::constraints != 0) impulses_.push(impulse);
  }

  // f at the end of a solution, where v = 2 Dq - v_n.
  Velocity<S> force_behind(const T& t, const Solution& s) const {
    const Velocity<S> v = T(2.0) * s.point.values.velocity - velocity_;
    return Base::force_without_gyroscopic_term(t, s.point.q, v);
  }
  // (T^{-T}(h Dq) - I) M Dq
  Velocity<S> transported_behind(const Solution& s) const {
    return transported_change<VariationalTransport>(system(), s.point.step, s.point.momentum);
  }

  History<Velocity<S>, 3> changes_;
  History<Multipliers<S>, 3> impulses_;
  Solution ahead_;  // from q_n, once is_ahead_
  bool is_ahead_ = false;
};

}  // namespace liebench
