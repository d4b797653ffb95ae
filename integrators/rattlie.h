#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "integrators/audit.h"
#include "integrators/fits.h"
#include "integrators/inlining.h"
#include "integrators/option.h"
#include "integrators/stage_solver.h"
#include "integrators/variational_stepper.h"

// RATTLie [Hante & Arnold 2021, RATTLie: a variational Lie group integration scheme for constrained mechanical
// systems], the variational integrator of order 2 of the discrete Lagrangian with the kinetic energy of a constant
// velocity Dq in a step:
//
//   T^{-T}(-h Dq) M Dq + h/2 f(q_n) + h/2 B(q_n)^T lambda^+_n = p_n,   q_{n+1} = q_n o exp(h Dq~),   Phi(q_{n+1}) = 0
//   p_{n+1} = T^{-T}(h Dq) M Dq - h/2 f(q_{n+1}) - h/2 B(q_{n+1})^T lambda^-_{n+1},   B(q_{n+1}) v_{n+1} = 0,   p = M v
//   lambda_n = (lambda^+_n + lambda^-_n) / 2
//
// with f of integrators/momentum_equation.h. Both constraints hold in every step, and lambda has no transient phase.
// Without constraints it is the Lie group method of Stoermer and Verlet. Symmetric and symplectic, where f does not
// depend on v. lambda_{n+1} takes the first line of the step that follows: a step ends with it, and fails where that
// does.

namespace liebench {

template <MechanicalSystem S, class Audit>
class RattlieStepper : public VariationalStepper<S, Audit> {
  using Base = VariationalStepper<S, Audit>;

 public:
  using Base::system;
  using typename Base::T;

  explicit RattlieStepper(const S& system) : Base(system) {}

  StepResult start(const T& h, std::span<const SolutionPoint<S>> points) {
    const StepResult result = Base::start(h, points);
    if constexpr (S::constraints != 0)
      if (Base::constrained()) projection_.emplace(system()).prepare(system(), newton_.audit());
    return result;
  }

  StepResult step() {
    return inlined_step<S>([this] { return take_step(); });
  }

 private:
  using Base::ahead_;
  using Base::force_;
  using Base::h_;
  using Base::is_ahead_;
  using Base::lambda_;
  using Base::newton_;
  using Base::q_;
  using Base::t_;
  using Base::velocity_;
  using typename Base::Solution;

  StepResult take_step() {
    if (!is_ahead_) {
      const StepResult result = Base::solve_from_velocity(t_, q_, velocity_, force_, ahead_);
      if (result.outcome != Outcome::ok) return result;
      is_ahead_ = Base::constrained();
    }
    const T t = t_ + h_;
    const Configuration<S>& q = ahead_.point.q;
    const Velocity<S> f = Base::force_behind(t, ahead_);
    const Velocity<S> kicks = Base::transported_behind(ahead_) - (h_ / T(2.0)) * f;
    Velocity<S> v = ahead_.point.values.velocity;
    if (!Base::constrained()) {
      Velocity<S> change = zero_velocity(system());
      const StepResult result = Base::solve_mass(q, kicks, change);
      if (result.outcome != Outcome::ok) return result;
      set(v, v + change);
      Base::keep(ahead_.change, ahead_.impulse);
      Base::move_to(t, q, v, f);
      return result;
    }
    if constexpr (S::constraints != 0) return project_and_look_ahead(t, q, kicks, v, f);
    return {};
  }

  // [M B^T; B 0] [v_{n+1} - Dq; h lambda^-_{n+1} / 2] = [kicks; -(B Dq + Phi_t)] at q_{n+1}, and the first line of
  // the next step.
  StepResult project_and_look_ahead(const T& t, const Configuration<S>& q, const Velocity<S>& kicks,
                                    Velocity<S>& v, const Velocity<S>& f) requires ConstrainedSystem<S> {
    Audit& audit = newton_.audit();
    projection_->take(system(), q);
    projection_->shift(system(), q);
    if (const Outcome outcome = projection_->factorize(system(), q, q, audit); outcome != Outcome::ok)
      return {outcome};
    const Multipliers<S> rate = -projection_->rate(system(), t, q, v);
    Velocity<S> change = zero_velocity(system());
    Multipliers<S> impulse = zero_multipliers(system());
    projection_->solve(system(), q, q, kicks, rate, change, impulse, audit);
    set(v, v + change);
    Base::keep(ahead_.change, ahead_.impulse);
    Solution next = ahead_;  // GCC does not see that it is written where it is read
    const StepResult result = Base::solve_from_velocity(t, q, v, f, next);
    if (result.outcome != Outcome::ok) return result;
    set(lambda_, (impulse + next.impulse) / h_);
    Base::move_to(t, q, v, f);
    ahead_ = next;
    return result;
  }

  // Of v on B v = 0, by the Schur complement where that is small.
  struct NoProjection {};
  using Projection = std::conditional_t<S::constraints == 0, NoProjection, std::optional<StageSolver<S>>>;
  [[no_unique_address]] Projection projection_;
};

struct Rattlie {
  static constexpr std::string_view name = "rattlie";
  static constexpr std::string_view summary =
      "RATTLie of Hante & Arnold, order 2: variational, with the constraint and its hidden one; Stoermer & "
      "Verlet's "
      "method where there is none";
  static constexpr Fits fits = Fits::every_system;
  static constexpr std::array<OptionInfo, 0> option_list{};

  static std::string title(const OptionValues&) { return "RATTLie"; }
  static ConvergenceOrders orders(const OptionValues&) { return same_order(2); }
  static bool symmetric(const OptionValues&) { return true; }
  static KeptConstraints kept_constraints(const OptionValues&) {
    return {.position = true, .velocity = true};
  }

  struct Options {};
  static Options options(const OptionValues&) { return {}; }

  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options&, const S& system, Visitor&& visit) {
    return visit(RattlieStepper<S, Audit>(system));
  }
};

}  // namespace liebench
