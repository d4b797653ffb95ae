#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <string_view>

#include "integrators/audit.h"
#include "integrators/bdf_coefficients.h"
#include "integrators/consistent_projection.h"
#include "integrators/form.h"
#include "integrators/history.h"
#include "integrators/newton.h"
#include "integrators/option.h"
#include "integrators/starting_values.h"

// BLieDF2nd, the k-step BDF method for second-order systems on Lie groups of Wieloch & Arnold, k = 1, ..., 4:
//
//   q_{n+1} = q_n o exp(h Dq_n~)                                                          (20a), (23a)
//   sum_{i=1}^k gamma_i Dq_{n+1-i} = v_{n+1} + h^2 L_k(v_n, ..., v_{n-k+1})               (20b), (23b)
//   (1/h) M(q_{n+1}) sum_{i=0}^k alpha_i v_{n+1-i} = -g - B^T lambda at t_{n+1}           (20c), (23c)
//   Phi(q_{n+1}) = 0                                                                      (23d), index 3
//
// In the stabilized index-2 form gamma_1 B(q_n)^T eta_{n+1} joins the left side of (23b), and B(q_{n+1}) v_{n+1} = 0; there
// lambda has no transient phase and needs no modified start.
//
// Order k in q, v and lambda with L_k of eq. (22), order min(k, 2) with L_k = 0.

namespace liebench {

struct BLieDF2nd {
  static constexpr std::string_view name = "bliedf2nd";
  static constexpr std::string_view summary =
      "k-step BDF method of Wieloch & Arnold with one commutator a step as correction L_k";
  static constexpr auto option_list = std::to_array<OptionInfo>({
      {.name = "k",
       .kind = OptionKind::integer,
       .fallback = 2,
       .least = 1,
       .most = 4,
       .meaning = "number of steps, and order"},
      {.name = "correction",
       .kind = OptionKind::boolean,
       .fallback = 1,
       .meaning = "L_k of eq. (22); false: L_k = 0, order min(k, 2)"},
      {.name = "modified_start",
       .kind = OptionKind::boolean,
       .fallback = 0,
       .meaning = "starting velocities of eq. (56), against the order reduction of lambda in the transient "
                  "phase (index 3)"},
      {.name = "form",
       .kind = OptionKind::choice,
       .fallback = 0,
       .choices = {"index3", "stabilized_index2"},
       .meaning = "formulation of the constrained equations"},
  });

  struct Options {
    int k = 2;
    bool correction = true;
    bool modified_start = false;
    Form form = Form::index3;
  };
  static Options options(const OptionValues& values) {
    return {.k = values.integer("k"),
            .correction = values.boolean("correction"),
            .modified_start = values.boolean("modified_start"),
            .form = form_of(values.choice("form"))};
  }

  template <int k, MechanicalSystem S, class Audit = NoAudit, Form form = Form::index3>
  class Stepper;

  // Calls visit(stepper) with the stepper that the options ask for.
  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options& options, const S& system, Visitor&& visit) {
    if constexpr (S::constraints > 0)
      if (options.form == Form::stabilized_index2)
        return with_steps<Form::stabilized_index2, S, Audit>(options, system, visit);
    return with_steps<Form::index3, S, Audit>(options, system, visit);
  }

 private:
  template <Form form, MechanicalSystem S, class Audit, class Visitor>
  static auto with_steps(const Options& options, const S& system, Visitor& visit) {
    switch (options.k) {
      case 1:
        return visit(Stepper<1, S, Audit, form>(system, options));
      case 2:
        return visit(Stepper<2, S, Audit, form>(system, options));
      case 3:
        return visit(Stepper<3, S, Audit, form>(system, options));
      default:
        return visit(Stepper<4, S, Audit, form>(system, options));
    }
  }
};

// The running method: start() once, then step() as often as wanted. Nothing is allocated.
template <int k, MechanicalSystem S, class Audit, Form form>
class BLieDF2nd::Stepper {
 public:
  using System = S;
  using T = typename S::Scalar;
  using Group = typename S::Group;
  static constexpr int steps = k;
  // Solution points t_0, ..., t_{k-1} that start() needs, and t_k, from which eq. (56) takes its local error.
  static constexpr int starting_points = k + 1;

  Stepper(const S& system, const Options& options)
      : options_(options), coefficients_(bdf_coefficients<k, T>()), newton_(system) {
    lambda_.setConstant(T(0.0));
    for (Velocity<S>* v : {&velocity_, &increment_, &correction_, &first_change_, &stabilization_})
      v->setConstant(T(0.0));
  }

  // Eq. (21): q_{k-1}, increments Dq_0 ... Dq_{k-2} by k - 1 logarithms, v_0 ... v_{k-1}; and eq. (56) where
  // asked for.
  StepResult start(const T& h, std::span<const SolutionPoint<S>> points) {
    h_ = h;
    // The logarithms below are those of the motion only while it turns by less than pi in a step.
    if constexpr (k > 1)
      for (const SolutionPoint<S>& p : points)
        if (!(to_double(Group::rotation_angle(h * p.v)) < std::numbers::pi))
          return {Outcome::rotation_too_large};
    const SolutionPoint<S>& last = points[std::size_t(k - 1)];
    t_ = last.t;
    q_ = last.q;
    velocity_ = last.v;
    lambda_ = last.lambda;
    scaled_lambdas_.push(h_ * lambda_);
    // sum_{i=2}^k gamma_i Dq_{k-i} - h^2 L_k: what (20b) at t_k takes from the starting values.
    Velocity<S> known = Velocity<S>::Constant(T(0.0));
    // With one step there is no increment yet; v_0 is next to the first one.
    increment_ = points[0].v;
    for (int j = 1; j < k; ++j) {
      velocity_changes_.push(points[std::size_t(j)].v - points[std::size_t(j - 1)].v);
      const Velocity<S> increment = increment_between(points, j - 1);
      if (j > 1) increment_changes_.push(increment - increment_);
      increment_ = increment;
      known += coefficients_.gamma[std::size_t(k - j)] * increment;
    }
    if (has_correction()) {
      correction_ = scaled_correction();
      known -= correction_;
    }
    if constexpr (S::constraints > 0 && !stabilized)
      if (options_.modified_start) {
        const StepResult modified = modify_starting_velocities(points, known);
        if (modified.outcome != Outcome::ok) return modified;
        if (has_correction()) {
          // L_k takes the modified velocity from the first step on.
          known += correction_;
          correction_ = scaled_correction();
          known -= correction_;
        }
      }
    first_change_ = coefficients_.gamma[0] * increment_ + known - velocity_;
    first_ = true;
    return {};
  }

  // t_n -> t_{n+1}
  StepResult step() {
    constexpr int m = Group::dimension;
    const AffineClosure<S> closure = next_closure();
    typename Kernel::Unknowns z;
    z.template head<m>() = predicted_change(closure);
    if constexpr (S::constraints > 0) z.template segment<S::constraints>(m) = scaled_lambdas_.extrapolated();
    if constexpr (stabilized) z.template tail<S::constraints>().setConstant(T(0.0));
    const T t = t_ + h_;
    typename Kernel::Point point;
    const StepResult result = newton_.solve(t, h_, q_, closure, z, point);
    if (result.outcome != Outcome::ok) return result;
    if (!(to_double(Group::rotation_angle(point.step)) < std::numbers::pi))
      return {Outcome::rotation_too_large};
    const Velocity<S> change = z.template head<m>();
    t_ = t;
    q_ = point.q;
    velocity_ = point.v;
    velocity_changes_.push(closure.change_of_velocity(point.change));
    if constexpr (stabilized) stabilization_ = point.change - change;
    increment_ += change;
    increment_changes_.push(change);
    first_ = false;
    if constexpr (S::constraints > 0) {
      const Multipliers<S> scaled_lambda = z.template segment<S::constraints>(m);
      lambda_ = scaled_lambda / h_;
      scaled_lambdas_.push(scaled_lambda);
    }
    return result;
  }

  const T& time() const { return t_; }
  const Configuration<S>& configuration() const { return q_; }
  const Velocity<S>& velocity() const { return velocity_; }
  const Multipliers<S>& multipliers() const { return lambda_; }
  const Audit& audit() const { return newton_.audit(); }

 private:
  // Dq_j = log(q_j^{-1} o q_{j+1}) / h
  Velocity<S> increment_between(std::span<const SolutionPoint<S>> points, int j) const {
    const auto& from = points[std::size_t(j)].q;
    const auto& to = points[std::size_t(j + 1)].q;
    return Group::log(Group::compose(Group::inverse(from), to)) / h_;
  }

  using Kernel = NewtonKernel<S, form, Audit>;
  static constexpr bool stabilized = S::constraints > 0 && form == Form::stabilized_index2;

  bool has_correction() const { return k >= 3 && !Group::commutative && options_.correction; }

  // Eqs. (20b) and (20c) in differences. With d_j = Dq_j - Dq_{j-1}, and by (5),
  //
  //   v_{n+1} - v_n = sum_{i=1}^k gamma_i d_{n+1-i} - h^2 (L_k(v_n, ...) - L_k(v_{n-1}, ...))
  //   h v'          = sum_{i=1}^k gamma_i (v_{n+2-i} - v_{n+1-i})
  //
  // which is the same method in exact arithmetic. As sum_{i=0}^k alpha_i v_{n+1-i} the second sum would make
  // an acceleration of eps |v| / h out of a constant velocity, in every step in the same direction: at
  // h = 1e-5 s it ruled all errors below 1e-8 (docs/theory.md). In the first step v_{n+1} - v_n comes from
  // the starting values.
  AffineClosure<S> next_closure() {
    const auto& gamma = coefficients_.gamma;
    Velocity<S> change = first_change_;
    if (!first_) {
      change.setConstant(T(0.0));
      for (int i = 1; i < k; ++i) change += gamma[std::size_t(i)] * increment_changes_[i - 1];
      if (has_correction()) {
        const Velocity<S> correction = scaled_correction();
        change -= correction - correction_;
        correction_ = correction;
      }
    }
    // The position increments are those without eta, the velocities those with it.
    if constexpr (stabilized) change -= gamma[0] * stabilization_;
    Velocity<S> acceleration = gamma[0] * change;
    for (int i = 1; i < k; ++i) acceleration += gamma[std::size_t(i)] * velocity_changes_[i - 1];
    return {.base = increment_,
            .velocity = velocity_,
            .velocity_slope = gamma[0],
            .velocity_change = change,
            .acceleration_slope = gamma[0] * gamma[0],
            .scaled_acceleration = acceleration};
  }

  // h^2 L_k, eq. (22): one commutator.
  Velocity<S> scaled_correction() const {
    const auto& dv = velocity_changes_;                             // v_n - v_{n-1}, v_{n-1} - v_{n-2}, ...
    Velocity<S> scaled_derivative = Velocity<S>::Constant(T(0.0));  // h v'
    if constexpr (k == 3) scaled_derivative = (T(3.0) * dv[0] - dv[1]) / T(2.0);
    if constexpr (k == 4) scaled_derivative = (T(7.0) * dv[0] - T(3.0) * dv[2]) / T(4.0);
    return (h_ / T(12.0)) * Group::commutator(velocity_, scaled_derivative);
  }

  // From the extrapolated change of velocity through the closure: exact to the order of the method and
  // beyond.
  Velocity<S> predicted_change(const AffineClosure<S>& closure) const {
    if (velocity_changes_.size() == 0) return Velocity<S>::Constant(T(0.0));
    return (velocity_changes_.extrapolated() - closure.velocity_change) / closure.velocity_slope;
  }

  // Eq. (56): v_j += Dv, [M B^T; B 0] [Dv; .] = [0; B l / h] at q_{k-1}, with the local error of the step
  // that ends at t_k from the solution itself, l / h = sum_{i=1}^k gamma_i Dq(t_{k-i}) - v(t_k) - h^2 L_k;
  // `known` is its part without Dq(t_{k-1}) and v(t_k).
  StepResult modify_starting_velocities(std::span<const SolutionPoint<S>> points,
                                        const Velocity<S>& known) requires ConstrainedSystem<S> {
    const Velocity<S> local_error =
        coefficients_.gamma[0] * increment_between(points, k - 1) + known - points[std::size_t(k)].v;
    const auto& q = points[std::size_t(k - 1)].q;
    const Multipliers<S> b = newton_.system().constraint_gradient(q) * local_error;
    const auto solution = solve_saddle_point(newton_.system(), q, Velocity<S>::Constant(T(0.0)).eval(), b);
    if (!solution) return {Outcome::singular_matrix};
    // All v_j move by the same vector: their differences stay.
    velocity_ += solution->x;
    return {};
  }

  Options options_;
  BdfCoefficients<k, T> coefficients_;
  Kernel newton_;
  T h_ = T(0.0);
  T t_ = T(0.0);
  Configuration<S> q_ = Group::identity();
  Velocity<S> velocity_;       // v_n
  Multipliers<S> lambda_;      // lambda_n
  Velocity<S> increment_;      // Dq_{n-1}
  Velocity<S> correction_;     // h^2 L_k of the step before
  Velocity<S> first_change_;   // v_k - v_{k-1} at d = 0
  Velocity<S> stabilization_;  // B(q_{n-1})^T eta_n; zero in the index-3 form
  bool first_ = true;
  History<Velocity<S>, k + 1> velocity_changes_;   // v_n - v_{n-1}, ...; more than k - 1 for the prediction
  History<Velocity<S>, k> increment_changes_;      // Dq_{n-1} - Dq_{n-2}, ...
  History<Multipliers<S>, k + 2> scaled_lambdas_;  // h lambda_n, ...
};

}  // namespace liebench
