#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <type_traits>

#include "groups/entrywise.h"
#include "integrators/affine_closure.h"
#include "integrators/basic_stepper.h"
#include "integrators/bdf_coefficients.h"
#include "integrators/consistent_projection.h"
#include "integrators/history.h"
#include "integrators/inlining.h"
#include "integrators/starting_values.h"

// The k-step BDF methods in increment form on a Lie group,
//
//   v_{n+1} = sum_{i=1}^k gamma_i Dq_{n+1-i} + kappa_{n+1}
//   h v'_{n+1} = sum_{i=0}^k alpha_i v_{n+1-i}
//
// They differ in kappa alone, what the curvature of the group adds to the kinematic equation: -h^2 L_k for BLieDF2nd
// (integrators/lie_correction.h), the logarithms of Faltinsen et al. for theirs (integrators/faltinsen_kinematics.h), those
// about the new point for the centred one (integrators/centred_kinematics.h). In the stabilized index-2 form
// gamma_1 B(q_n)^T eta_{n+1} joins the first line.
//
// Both lines are evaluated in differences. With d_j = Dq_j - Dq_{j-1}, and by (5),
//
//   v_{n+1} - v_n = sum_{i=1}^k gamma_i d_{n+1-i} + kappa_{n+1} - kappa_n
//   h v'_{n+1}    = sum_{i=1}^k gamma_i (v_{n+2-i} - v_{n+1-i})
//
// which is the same method in exact arithmetic. As sum_{i=0}^k alpha_i v_{n+1-i} the second sum would make an
// acceleration of eps |v| / h out of a constant velocity, in every step in the same direction: at h = 1e-5 s it ruled all
// errors below 1e-8 (docs/theory.md). In the first step v_{n+1} - v_n comes from the starting values.

namespace liebench {

// What the kinematic equation of a step is made of.
template <MechanicalSystem S>
struct BdfState {
  using T = typename S::Scalar;
  static constexpr int most_steps = BdfCoefficients<T>::most_steps;

  BdfState(const S& system, int steps)
      : k(steps),
        coefficients(bdf_coefficients<T>(steps)),
        velocity(zero_velocity(system)),
        increment(velocity),
        kappa(velocity),
        velocity_changes(steps + 1, velocity),
        increment_changes(steps + 1, velocity) {}

  // By how much the last `steps` steps turn, all together [rad]: a bound of the angle of their product.
  template <class Group>
  LinearScalar<T> turn(const Group& group, int steps) const {
    Velocity<S> Dq = increment;
    LinearScalar<T> angle = 0.0;
    for (int i = 0; i < steps; ++i) {
      angle += to_linear(group.rotation_angle(h * Dq));
      Dq -= increment_changes[i];
    }
    return angle;
  }

  // d_n = Dq_n - Dq_{n-1}, extrapolated.
  Velocity<S> predicted_change() const {
    if (increment_changes.size() == 0) return Velocity<S>::Constant(increment.size(), T(0.0));
    return increment_changes.extrapolated();
  }

  int k;
  T h = T(0.0);
  BdfCoefficients<T> coefficients;
  Velocity<S> velocity;   // v_n
  Velocity<S> increment;  // Dq_{n-1}
  Velocity<S> kappa;      // kappa_n
  // v_n - v_{n-1}, ... and Dq_{n-1} - Dq_{n-2}, ...; more than k - 1 for the prediction
  History<Velocity<S>, most_steps + 1> velocity_changes, increment_changes;
};

// k is a member, not a parameter of the type: one code serves all k (docs/performance.md, "Build").
//
// Kinematics gives
//   Kinematics(system, options of the method)
//   start(h, motions)         the q_j^{-1} o q_{j+1}, j = 0, ..., k - 2, of the starting points
//   defined(state)            false where the kinematic equation has no unique value (a logarithm beyond pi)
//   closure(state, affine)    the closure of the step from t_n, of which `affine` is what holds for kappa_{n+1} = kappa_n
//   accept(motion)            q_n^{-1} o q_{n+1}
template <MechanicalSystem S, Form form, class Audit, class Kinematics>
class BdfStepper : public BasicStepper<S, form, Audit> {
  using Base = BasicStepper<S, form, Audit>;

 public:
  using Base::system;
  using typename Base::Group;
  using typename Base::T;
  int steps() const { return state_.k; }
  // Solution points t_0, ..., t_{k-1} that start() needs, and t_k, from which eq. (56) takes its local error.
  int starting_points() const { return state_.k + 1; }

  template <class Options>
  BdfStepper(const S& system, const Options& options)
      : Base(system, options.safeguard),
        modified_start_(options.modified_start),
        state_(system, options.k),
        kinematics_(system, options),
        first_change_(zero_velocity(system)),
        stabilization_(zero_velocity(system)),
        scaled_lambdas_(options.k + 2, zero_multipliers(system)) {}

  // Eq. (21): q_{k-1}, increments Dq_0 ... Dq_{k-2} by k - 1 logarithms, v_0 ... v_{k-1}; and eq. (56) where asked for.
  StepResult start(const T& h, std::span<const SolutionPoint<S>> points) {
    const int k = state_.k;
    h_ = h;
    state_.h = h;
    // The logarithms below are those of the motion only while it turns by less than pi in a step.
    if (k > 1)
      for (const SolutionPoint<S>& p : points)
        if (!Base::turns_by_less_than_pi(h * p.v)) return {Outcome::rotation_too_large};
    const SolutionPoint<S>& last = points[std::size_t(k - 1)];
    t_ = last.t;
    q_ = last.q;
    velocity_ = last.v;
    lambda_ = last.lambda;
    scaled_lambdas_.push(h_ * lambda_);
    // sum_{i=2}^k gamma_i Dq_{k-i}: what v_k takes from the starting increments.
    Velocity<S> known = zero_velocity(system());
    // With one step there is no increment yet; v_0 is next to the first one.
    state_.increment = points[0].v;
    std::array<Configuration<S>, std::size_t(BdfState<S>::most_steps - 1)> motions;
    const auto group = group_of(system());
    motions.fill(group.identity());
    for (int j = 1; j < k; ++j) {
      state_.velocity_changes.push(points[std::size_t(j)].v - points[std::size_t(j - 1)].v);
      motions[std::size_t(j - 1)] = motion_between(points, j - 1);
      const Velocity<S> increment = group.log(motions[std::size_t(j - 1)]) / h_;
      if (j > 1) state_.increment_changes.push(increment - state_.increment);
      state_.increment = increment;
      known += state_.coefficients.gamma[std::size_t(k - j)] * increment;
    }
    kinematics_.start(std::span(motions).first(std::size_t(k - 1)));
    first_change_ = state_.coefficients.gamma[0] * state_.increment + known - velocity_;
    first_ = true;
    if constexpr (S::constraints != 0 && !Base::stabilized)
      if (modified_start_) return modify_starting_velocities(points);
    return {};
  }

  // t_n -> t_{n+1}
  StepResult step() {
    return inlined_step<S>([this] { return take_step(); });
  }

 private:
  StepResult take_step() {
    set(state_.velocity, velocity_);
    if (!kinematics_.defined(state_)) return {Outcome::rotation_too_large};
    const AffineClosure<S> affine = affine_part();
    const auto closure = kinematics_.closure(state_, affine);
    Velocity<S> change = predicted_change(closure);
    Multipliers<S> scaled_lambda;
    if constexpr (S::constraints != 0) scaled_lambda = scaled_lambdas_.extrapolated();
    typename Base::Point point;
    const StepResult result = Base::advance(closure, change, scaled_lambda, point);
    if (result.outcome != Outcome::ok) return result;
    const Velocity<S>& velocity_change = point.values.velocity_change;
    set(state_.kappa,
        state_.kappa + (velocity_change - (affine.velocity_slope * point.change + affine.velocity_change)));
    state_.velocity_changes.push(velocity_change);
    if constexpr (Base::stabilized) set(stabilization_, point.change - change);
    set(state_.increment, state_.increment + change);
    state_.increment_changes.push(change);
    kinematics_.accept(point.motion);
    first_ = false;
    if constexpr (S::constraints != 0) scaled_lambdas_.push(scaled_lambda);
    return result;
  }

  using Base::h_;
  using Base::lambda_;
  using Base::newton_;
  using Base::q_;
  using Base::t_;
  using Base::velocity_;

  // q_j^{-1} o q_{j+1}
  Configuration<S> motion_between(std::span<const SolutionPoint<S>> points, int j) const {
    const auto group = group_of(system());
    return group.compose(group.inverse(points[std::size_t(j)].q), points[std::size_t(j + 1)].q);
  }

  // The closure for kappa_{n+1} = kappa_n.
  AffineClosure<S> affine_part() const {
    const int k = state_.k;
    const auto& gamma = state_.coefficients.gamma;
    const auto older_gamma = [&](int i) -> const T& { return gamma[std::size_t(i + 1)]; };
    AffineClosure<S> closure;
    closure.velocity_slope = gamma[0];
    closure.acceleration_slope = gamma[0] * gamma[0];
    set(closure.base_increment, state_.increment);
    set(closure.velocity, velocity_);
    Velocity<S>& change = closure.velocity_change;
    set(change, first_change_);
    if (!first_) {
      change.setConstant(T(0.0));
      state_.increment_changes.add_weighted(0, k - 1, older_gamma, change);
    }
    // The position increments are those without eta, the velocities those with it.
    if constexpr (Base::stabilized) set(change, change - gamma[0] * stabilization_);
    Velocity<S>& acceleration = closure.scaled_acceleration;
    set(acceleration, gamma[0] * change);
    state_.velocity_changes.add_weighted(0, k - 1, older_gamma, acceleration);
    return closure;
  }

  // From the extrapolated change of velocity through the closure, exact to the order of the method and beyond.
  Velocity<S> predicted_change(const AffineClosure<S>& closure) const {
    if (state_.velocity_changes.size() == 0) return zero_velocity(system());
    Velocity<S> change = state_.velocity_changes.extrapolated();
    set(change, (change - closure.velocity_change) / closure.velocity_slope);
    return change;
  }
  // Where v is no affine function of d, d itself is extrapolated.
  template <class Closure>
  Velocity<S> predicted_change(const Closure&) const {
    return state_.predicted_change();
  }

  // Eq. (56): v_j += Dv, [M B^T; B 0] [Dv; .] = [0; B l / h] at q_{k-1}, with the local error of the step that ends at
  // t_k from the solution itself, l / h = sum_{i=1}^k gamma_i Dq(t_{k-i}) + kappa_k - v(t_k).
  [[gnu::noinline]] StepResult modify_starting_velocities(std::span<const SolutionPoint<S>> points) requires
      ConstrainedSystem<S> {
    state_.velocity = velocity_;
    if (!kinematics_.defined(state_)) return {Outcome::rotation_too_large};
    const auto closure = kinematics_.closure(state_, affine_part());
    const Velocity<S> increment = group_of(system()).log(motion_between(points, state_.k - 1)) / h_;
    const Velocity<S> exact_change = points[std::size_t(state_.k)].v - points[std::size_t(state_.k - 1)].v;
    const Velocity<S> local_error = closure.at(increment - state_.increment).velocity_change - exact_change;
    const auto& q = points[std::size_t(state_.k - 1)].q;
    const Multipliers<S> b = constraint_product(system(), q, local_error);
    const auto solution = solve_saddle_point(system(), q, zero_velocity(system()), b, newton_.audit());
    if (!solution) return {Outcome::singular_matrix};
    // All v_j move by the same vector: their differences stay.
    velocity_ += solution->x;
    first_change_ -= solution->x;
    return {};
  }

  bool modified_start_;
  bool first_ = true;
  BdfState<S> state_;
  [[no_unique_address]] Kinematics kinematics_;
  Velocity<S> first_change_;   // v_k - v_{k-1} at d = 0, without kappa_k
  Velocity<S> stabilization_;  // B(q_{n-1})^T eta_n; zero in the index-3 form
  History<Multipliers<S>, BdfState<S>::most_steps + 2> scaled_lambdas_;  // h lambda_n, ...
};

}  // namespace liebench
