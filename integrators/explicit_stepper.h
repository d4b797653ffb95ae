#pragma once

#include <cmath>
#include <span>

#include "integrators/inlining.h"
#include "integrators/mass_solver.h"
#include "integrators/outcome.h"
#include "integrators/starting_values.h"
#include "problems/system.h"

namespace liebench {

// What every explicit method for q' = DL_q(e) v~, M(q) v' = -g(t, q, v) does alike: it holds the state and solves for
// v'. A stepper adds what BasicStepper (integrators/basic_stepper.h) asks for.
template <MechanicalSystem S, class Audit>
class BasicExplicitStepper {
 public:
  using System = S;
  using T = typename S::Scalar;

  const T& time() const { return t_; }
  const Configuration<S>& configuration() const { return q_; }
  const Velocity<S>& velocity() const { return velocity_; }
  const Multipliers<S>& multipliers() const { return lambda_; }
  const S& system() const { return system_; }
  const Audit& audit() const { return audit_; }
  Audit& audit() { return audit_; }

 protected:
  explicit BasicExplicitStepper(const S& system)
      : system_(system),
        q_(group_of(system).identity()),
        velocity_(zero_velocity(system)),
        lambda_(zero_multipliers(system)) {}

  void begin(const T& h, const SolutionPoint<S>& point) {
    h_ = h;
    t_ = point.t;
    q_ = point.q;
    velocity_ = point.v;
    mass_.prepare(system_, audit_);
  }

  // F = v'
  Outcome acceleration(const T& t, const Configuration<S>& q, const Velocity<S>& v, Velocity<S>& F) {
    const Velocity<S> force = -system_.force(t, q, v);
    return mass_.solve(system_, q, force, F, audit_) ? Outcome::ok : Outcome::singular_matrix;
  }

  // Moves to t_n + h, unless v is no number.
  StepResult move_to(const Configuration<S>& q, const Velocity<S>& v) {
    if (!std::isfinite(to_double(T(v.squaredNorm())))) return {Outcome::non_finite};
    q_ = q;
    velocity_ = v;
    t_ = t_ + h_;
    return {};
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

// The stepper of an explicit one-step method. The method is its scheme,
//
//   Scheme::step(system, t, h, q, v, acceleration)   moves q and v from t to t + h, or leaves them and says why
//
// with acceleration(t, q, v, F), which writes F = v' and says how it went.
template <MechanicalSystem S, class Audit, class Scheme>
class ExplicitStepper : public BasicExplicitStepper<S, Audit> {
  using Base = BasicExplicitStepper<S, Audit>;

 public:
  using typename Base::T;

  explicit ExplicitStepper(const S& system) : Base(system) {}

  int steps() const { return 1; }
  int starting_points() const { return 1; }

  // From q_0 and v_0.
  StepResult start(const T& h, std::span<const SolutionPoint<S>> points) {
    Base::begin(h, points[0]);
    return {};
  }

  StepResult step() {
    return inlined_step<S>([this] { return take_step(); });
  }

 private:
  StepResult take_step() {
    const auto acceleration = [this](const T& t, const Configuration<S>& q, const Velocity<S>& v,
                                     Velocity<S>& F) { return Base::acceleration(t, q, v, F); };
    Configuration<S> q = Base::q_;
    Velocity<S> v = Base::velocity_;
    const StepResult result = Scheme::step(Base::system_, Base::t_, Base::h_, q, v, acceleration);
    return result.outcome == Outcome::ok ? Base::move_to(q, v) : result;
  }
};

}  // namespace liebench
