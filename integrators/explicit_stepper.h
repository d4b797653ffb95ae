#pragma once

#include <cmath>
#include <span>

#include "integrators/inlining.h"
#include "integrators/mass_solver.h"
#include "integrators/outcome.h"
#include "integrators/starting_values.h"
#include "problems/system.h"

namespace liebench {

// What the steppers of explicit one-step methods for q' = DL_q(e) v~, M v' = -g(t, q, v) share: the state, and the solution for v'.
template <MechanicalSystem S, class Audit>
class ExplicitState {
 public:
  using System = S;
  using T = typename S::Scalar;

  explicit ExplicitState(const S& system)
      : system_(system),
        q_(group_of(system).identity()),
        velocity_(zero_velocity(system)),
        lambda_(zero_multipliers(system)) {}

  int steps() const { return 1; }
  int starting_points() const { return 1; }
  const T& time() const { return t_; }
  const Configuration<S>& configuration() const { return q_; }
  const Velocity<S>& velocity() const { return velocity_; }
  const Multipliers<S>& multipliers() const { return lambda_; }
  const S& system() const { return system_; }
  const Audit& audit() const { return audit_; }
  Audit& audit() { return audit_; }

  // From q_0 and v_0.
  StepResult start(const T& h, std::span<const SolutionPoint<S>> points) {
    h_ = h;
    t_ = points[0].t;
    q_ = points[0].q;
    velocity_ = points[0].v;
    mass_.prepare(system_, audit_);
    return {};
  }

 protected:
  // Writes F = v' and says how it went.
  Outcome accelerate(const T& t, const Configuration<S>& q, const Velocity<S>& v, Velocity<S>& F) {
    const Velocity<S> force = -system_.force(t, q, v);
    return mass_.solve(system_, q, force, F, audit_) ? Outcome::ok : Outcome::singular_matrix;
  }

  S system_;
  [[no_unique_address]] Audit audit_;
  MassSolver<S> mass_;
  T h_ = T(0.0);
  T t_ = T(0.0);
  Configuration<S> q_;
  Velocity<S> velocity_;
  Multipliers<S> lambda_;  // none
};

// The method is its scheme,
//
//   Scheme::step(system, t, h, q, v, acceleration)   moves q and v from t to t + h, or leaves them and says why
//
// with acceleration(t, q, v, F), which writes F = v' and says how it went.
template <MechanicalSystem S, class Audit, class Scheme>
class ExplicitStepper : public ExplicitState<S, Audit> {
  using Base = ExplicitState<S, Audit>;

 public:
  using Base::Base;
  using typename Base::T;

  StepResult step() {
    if constexpr (inlines_all<S>) {
      return step_inlined();
    } else {
      return take_step();
    }
  }

 private:
  using Base::h_;
  using Base::q_;
  using Base::t_;
  using Base::velocity_;

  [[gnu::noinline, gnu::flatten]] StepResult step_inlined() { return take_step(); }

  StepResult take_step() {
    const auto acceleration = [this](const T& t, const Configuration<S>& q, const Velocity<S>& v,
                                     Velocity<S>& F) { return Base::accelerate(t, q, v, F); };
    Configuration<S> q = q_;
    Velocity<S> v = velocity_;
    StepResult result = Scheme::step(Base::system_, t_, h_, q, v, acceleration);
    if (result.outcome != Outcome::ok) return result;
    if (!std::isfinite(to_double(T(v.squaredNorm())))) return {Outcome::non_finite};
    q_ = q;
    velocity_ = v;
    t_ = t_ + h_;
    return result;
  }
};

}  // namespace liebench
