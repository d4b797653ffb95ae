#pragma once

#include <numbers>

#include "groups/entrywise.h"
#include "integrators/audit.h"
#include "integrators/form.h"
#include "integrators/newton.h"
#include "integrators/outcome.h"
#include "problems/system.h"

namespace liebench {

// What every implicit method does alike: it holds the state at t_n, solves the step equation from the prediction of the
// method, and moves to t_{n+1}. Nothing is allocated.
//
// A stepper adds
//   steps()            the index of the first point that it computes
//   starting_points()  how many solution points start() takes, at most most_starting_points
//   start(h, points)  from t_0, t_0 + h, ...
//   step()            t_n -> t_{n+1}
inline constexpr int most_starting_points = 7;

template <MechanicalSystem S, Form form, class Audit, class Equation = StepEquation<S, form>>
class BasicStepper {
 public:
  using System = S;
  using T = typename S::Scalar;
  using Group = typename S::Group;

  const T& time() const { return t_; }
  const Configuration<S>& configuration() const { return q_; }
  const Velocity<S>& velocity() const { return velocity_; }
  const Multipliers<S>& multipliers() const { return lambda_; }
  const S& system() const { return newton_.system(); }
  const Audit& audit() const { return newton_.audit(); }
  Audit& audit() { return newton_.audit(); }

 protected:
  using Kernel = NewtonKernel<S, form, Audit, Equation>;
  using Point = typename Kernel::Point;
  static constexpr int l = S::constraints;
  static constexpr bool stabilized = Equation::stabilized;

  BasicStepper(const S& system, bool safeguard)
      : newton_(system),
        q_(group_of(system).identity()),
        velocity_(zero_velocity(system)),
        lambda_(zero_multipliers(system)),
        safeguard_(safeguard),
        last_step_(velocity_) {}

  // Solves the step equation and moves to its solution. `scaled_lambda` is the prediction of h lambda_{n+1}, and its
  // value afterwards; `change` the same of d = Dq_n - base, without B^T eta.
  template <class Closure>
  StepResult advance(const Closure& closure, Velocity<S>& change, Multipliers<S>& scaled_lambda,
                     Point& point) {
    typename Kernel::Unknowns z = Equation::unknowns(system());
    set(Equation::change(z, system()), change);
    if constexpr (l != 0) set(Equation::scaled_lambda(z, system()), scaled_lambda);
    if constexpr (stabilized) Equation::eta(z, system()).setConstant(T(0.0));
    const T t = t_ + h_;
    StepResult result = newton_.solve(t, h_, q_, closure, z, point);
    if (result.outcome == Outcome::ok && !turns_by_less_than_pi(point.step, turned_before(closure)))
      result = {Outcome::rotation_too_large};
    if (result.outcome != Outcome::ok) {
      if (!safeguard_ || !solve_again(t, closure, z, point)) return result;
      result = {};
    }
    t_ = t;
    q_ = point.q;
    if (safeguard_) {
      set(last_step_, point.step);
      stepped_ = true;
    }
    set(velocity_, point.values.velocity);
    set(change, Equation::change(z, system()));
    if constexpr (l != 0) {
      set(scaled_lambda, Equation::scaled_lambda(z, system()));
      set(lambda_, scaled_lambda / h_);
    }
    return result;
  }

  // Damped, from the last multipliers and the increment that the method expects of an undisturbed motion (d = 0), or none at all (a stiff
  // spring that was not at rest). False where both fail, and where the increment is half a turn and more away from that of the step before: a constraint
  // that is fulfilled by it is fulfilled by one of a turn less, too.
  template <class Closure>
  [[gnu::noinline, gnu::cold]] bool solve_again(const T& t, const Closure& closure,
                                                typename Kernel::Unknowns& z, Point& point) {
    const Velocity<S> before = stepped_ ? last_step_ : Velocity<S>(h_ * velocity_);
    for (const bool at_rest : {false, true}) {
      z.setConstant(T(0.0));
      if (at_rest) Equation::change(z, system()) = -closure.base();
      if constexpr (l != 0) Equation::scaled_lambda(z, system()) = h_ * lambda_;
      if (newton_.solve_damped(t, h_, q_, closure, z, point).outcome == Outcome::ok &&
          turns_by_less_than_pi(point.step, turned_before(closure)) &&
          turns_by_less_than_pi(point.step - before))
        return true;
    }
    return false;
  }

  // Together with `before`; false for a NaN, too.
  bool turns_by_less_than_pi(const Velocity<S>& v, double before = 0.0) const {
    return before + to_double(group_of(system()).rotation_angle(v)) < std::numbers::pi;
  }
  // The steps that are in a logarithm of the closure with the new one.
  template <class Closure>
  static double turned_before(const Closure& closure) {
    if constexpr (requires { closure.turned; })
      return closure.turned;
    else
      return 0.0;
  }

  Kernel newton_;
  T h_ = T(0.0);
  T t_ = T(0.0);
  Configuration<S> q_;
  Velocity<S> velocity_;   // v_n
  Multipliers<S> lambda_;  // lambda_n
  bool safeguard_;
  bool stepped_ = false;
  Velocity<S> last_step_;  // h Dq_{n-1}, where the safeguard is on and stepped_
};

}  // namespace liebench
