#pragma once

#include <cmath>
#include <span>

#include "integrators/basic_stepper.h"
#include "integrators/form.h"
#include "integrators/history.h"
#include "integrators/mass_solver.h"
#include "integrators/momentum_equation.h"
#include "integrators/outcome.h"
#include "integrators/starting_values.h"
#include "problems/system.h"

namespace liebench {

// What the methods of integrators/momentum_equation.h do alike: from q_0, v_0 (and v'_0, lambda_0 for a prediction).
// Of systems with a mass matrix that is constant, which those of this program are.
//
// A force that depends on v beyond the gyroscopic term, f(t, q, v), is taken once for a point, at v = 2 Dq - v_n,
// which is v_{n+1} but for O(h^2): the order stays 2, but the method is not symmetric then, and explicit in what
// dissipates.
template <MechanicalSystem S, class Audit, class Transport>
class MomentumStepper : public BasicStepper<S, Form::index3, Audit, MomentumEquation<S, Transport>> {
  using Base = BasicStepper<S, Form::index3, Audit, MomentumEquation<S, Transport>>;

 public:
  using Base::system;
  using typename Base::T;
  int steps() const { return 1; }
  int starting_points() const { return 1; }

  StepResult start(const T& h, std::span<const SolutionPoint<S>> points) {
    h_ = h;
    t_ = points[0].t;
    q_ = points[0].q;
    velocity_ = points[0].v;
    lambda_ = points[0].lambda;
    mass_.prepare(system(), newton_.audit());
    force_ = force_without_gyroscopic_term(t_, q_, velocity_);
    first_change_ = (h / T(2.0)) * points[0].acceleration;
    return {};
  }

 protected:
  using Closure = MomentumClosure<S>;
  using typename Base::Point;
  using Equation = MomentumEquation<S, Transport>;
  using Base::h_;
  using Base::lambda_;
  using Base::newton_;
  using Base::q_;
  using Base::t_;
  using Base::velocity_;

  explicit MomentumStepper(const S& system)
      : Base(system, false), force_(zero_velocity(system)), first_change_(force_) {
    if constexpr (DenseSystem<S>) static_assert(S::constant_mass);
  }

  // f = g + ad(v)^T M v
  Velocity<S> force_without_gyroscopic_term(const T& t, const Configuration<S>& q,
                                            const Velocity<S>& v) const {
    Velocity<S> f = system().force(t, q, v);
    if constexpr (may_have_commutators<S>())
      if (has_commutators(system()))
        set(f, f + group_of(system()).coadjoint(v, Velocity<S>(system().momentum(q, v))));
    return f;
  }

  // From q over the time h to t; `change` and `impulse` are predictions, and the solution afterwards.
  StepResult solve(const T& t, const T& h, const Configuration<S>& q, const Closure& closure,
                   Velocity<S>& change, Multipliers<S>& impulse, Point& point) {
    typename Equation::Unknowns z = Equation::unknowns(system());
    set(Equation::change(z, system()), change);
    if constexpr (S::constraints != 0) set(Equation::scaled_lambda(z, system()), impulse);
    const StepResult result = newton_.solve(t, h, q, closure, z, point);
    if (result.outcome != Outcome::ok) return result;
    if (!Base::turns_by_less_than_pi(point.step)) return {Outcome::rotation_too_large};
    if (multiplier_size(system()) == 0) Equation::move(system(), q, point);
    set(change, Equation::change(z, system()));
    if constexpr (S::constraints != 0) set(impulse, Equation::scaled_lambda(z, system()));
    return result;
  }

  // M x = a
  StepResult solve_mass(const Configuration<S>& q, const Velocity<S>& a, Velocity<S>& x) {
    if (!mass_.solve(system(), q, a, x, newton_.audit())) return {Outcome::singular_matrix};
    return finite(x);
  }
  static StepResult finite(const Velocity<S>& x) {
    return {std::isfinite(to_double(T(x.squaredNorm()))) ? Outcome::ok : Outcome::non_finite};
  }

  void move_to(const T& t, const Configuration<S>& q, const Velocity<S>& v, const Velocity<S>& f) {
    t_ = t;
    q_ = q;
    set(velocity_, v);
    set(force_, f);
  }

  MassSolver<S> mass_;
  Velocity<S> force_;         // f(t_n, q_n)
  Velocity<S> first_change_;  // h v'_0 / 2
};

}  // namespace liebench
