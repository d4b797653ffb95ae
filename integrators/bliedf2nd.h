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
                  "phase (constrained problems)"},
      {.name = "form",
       .kind = OptionKind::choice,
       .fallback = 0,
       .choices = {"index3"},
       .meaning = "formulation of the constrained equations"},
  });

  struct Options {
    int k = 2;
    bool correction = true;
    bool modified_start = false;
  };
  static Options options(const OptionValues& values) {
    return {.k = values.integer("k"),
            .correction = values.boolean("correction"),
            .modified_start = values.boolean("modified_start")};
  }

  template <int k, MechanicalSystem S, class Audit = NoAudit>
  class Stepper;

  // Calls visit(stepper) with the stepper that the options ask for.
  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options& options, const S& system, Visitor&& visit) {
    switch (options.k) {
      case 1:
        return visit(Stepper<1, S, Audit>(system, options));
      case 2:
        return visit(Stepper<2, S, Audit>(system, options));
      case 3:
        return visit(Stepper<3, S, Audit>(system, options));
      default:
        return visit(Stepper<4, S, Audit>(system, options));
    }
  }
};

// The running method: start() once, then step() as often as wanted. Nothing is allocated.
template <int k, MechanicalSystem S, class Audit>
class BLieDF2nd::Stepper {
 public:
  using System = S;
  using T = typename S::Scalar;
  using Group = typename S::Group;
  static constexpr int steps = k;
  // Solution points t_0, ..., t_{k-1} that start() needs, and t_k, from which eq. (56) takes its local error.
  static constexpr int starting_points = k + 1;

  Stepper(const S& system, const Options& options)
      : options_(options), coefficients_(bdf_coefficients<k, T>()), newton_(system) {}

  // Eq. (21): q_{k-1}, increments Dq_0 ... Dq_{k-2} by k - 1 logarithms, v_0 ... v_{k-1}; and eq. (56) where
  // asked for.
  StepResult start(const T& h, std::span<const SolutionPoint<S>> points) {
    h_ = h;
    for (int j = 0; j < k; ++j) {
      const SolutionPoint<S>& p = points[std::size_t(j)];
      velocities_.push(p.v);
      if (j > 0) increments_.push(increment(points, j - 1));
    }
    const SolutionPoint<S>& last = points[std::size_t(k - 1)];
    t_ = last.t;
    q_ = last.q;
    lambda_ = last.lambda;
    scaled_lambdas_.push(h_ * lambda_);
    if constexpr (S::constraints > 0)
      if (options_.modified_start) return modify_starting_velocities(points);
    return {};
  }

  // t_n -> t_{n+1}
  StepResult step() {
    const AffineClosure<S> closure = this->closure();
    typename NewtonKernel<S, Audit>::Unknowns z;
    z.template head<Group::dimension>() = predicted_increment(closure);
    if constexpr (S::constraints > 0) z.template tail<S::constraints>() = scaled_lambdas_.extrapolated();
    const T t = t_ + h_;
    typename NewtonKernel<S, Audit>::Point point;
    const StepResult result = newton_.solve(t, h_, q_, closure, z, point);
    if (result.outcome != Outcome::ok) return result;
    const Velocity<S> increment = z.template head<Group::dimension>();
    if (!(to_double(Group::rotation_angle(h_ * increment)) < std::numbers::pi))
      return {Outcome::rotation_too_large, result.residual};
    t_ = t;
    q_ = point.q;
    velocities_.push(point.v);
    increments_.push(increment);
    if constexpr (S::constraints > 0) {
      const Multipliers<S> scaled_lambda = z.template tail<S::constraints>();
      lambda_ = scaled_lambda / h_;
      scaled_lambdas_.push(scaled_lambda);
    }
    return result;
  }

  const T& time() const { return t_; }
  const Configuration<S>& configuration() const { return q_; }
  const Velocity<S>& velocity() const { return velocities_[0]; }
  const Multipliers<S>& multipliers() const { return lambda_; }
  const Audit& audit() const { return newton_.audit(); }

 private:
  // Points beyond the method's own k: they sharpen the prediction.
  static constexpr int extra = 2;

  Velocity<S> increment(std::span<const SolutionPoint<S>> points, int j) const {
    const auto& from = points[std::size_t(j)].q;
    const auto& to = points[std::size_t(j + 1)].q;
    return Group::log(Group::compose(Group::inverse(from), to)) / h_;
  }

  // v = gamma_1 Dq_n + sum_{i=2}^k gamma_i Dq_{n+1-i} - h^2 L_k,   h v' = sum_{i=0}^k alpha_i v_{n+1-i}
  //
  // The second sum is evaluated as sum_{i=1}^k gamma_i (v_{n+2-i} - v_{n+1-i}), eq. (5): rounded alpha_i do
  // not add up to zero, and the acceleration eps |v| / h that they make of a constant velocity acts in every
  // step in the same direction (at h = 1e-5 s it ruled all errors below 1e-8).
  AffineClosure<S> closure() const {
    const auto& gamma = coefficients_.gamma;
    Velocity<S> offset = Velocity<S>::Constant(T(0.0));
    for (std::size_t i = 1; i < std::size_t(k); ++i) offset += gamma[i] * increments_[int(i) - 1];
    if constexpr (k >= 3 && !Group::commutative)
      if (options_.correction) offset -= scaled_correction();
    Velocity<S> acceleration = gamma[0] * (offset - velocities_[0]);
    for (std::size_t i = 1; i < std::size_t(k); ++i)
      acceleration += gamma[i] * (velocities_[int(i) - 1] - velocities_[int(i)]);
    return {gamma[0], offset, gamma[0] * gamma[0], acceleration};
  }

  // h^2 L_k, eq. (22): one commutator.
  Velocity<S> scaled_correction() const {
    const auto& v = velocities_;
    Velocity<S> scaled_derivative;  // h v'
    if constexpr (k == 3) {
      scaled_derivative = (T(3.0) * v[0] - T(4.0) * v[1] + v[2]) / T(2.0);
    } else {
      scaled_derivative = (T(7.0) * (v[0] - v[1]) - T(3.0) * (v[2] - v[3])) / T(4.0);
    }
    return (h_ / T(12.0)) * Group::commutator(v[0], scaled_derivative);
  }

  // From the extrapolated velocity through the closure: exact to the order of the method and beyond.
  Velocity<S> predicted_increment(const AffineClosure<S>& closure) const {
    return (velocities_.extrapolated() - closure.velocity_offset) / closure.velocity_slope;
  }

  // Eq. (56): v_j += Dv, [M B^T; B 0] [Dv; .] = [0; B l / h] at q_{k-1}, with the local error of the step
  // that ends at t_k from the solution itself, l / h = sum_{i=1}^k gamma_i Dq(t_{k-i}) - v(t_k) - h^2 L_k.
  StepResult modify_starting_velocities(std::span<const SolutionPoint<S>> points) requires
      ConstrainedSystem<S> {
    Velocity<S> local_error = coefficients_.gamma[0] * increment(points, k - 1) - points[std::size_t(k)].v;
    local_error += closure().velocity_offset;
    const auto& q = points[std::size_t(k - 1)].q;
    const Multipliers<S> b = newton_.system().constraint_gradient(q) * local_error;
    const auto solution = solve_saddle_point(newton_.system(), q, Velocity<S>::Constant(T(0.0)).eval(), b);
    if (!solution) return {Outcome::singular_matrix, 0.0};
    for (int j = 0; j < k; ++j) velocities_[j] += solution->x;
    return {};
  }

  Options options_;
  BdfCoefficients<k, T> coefficients_;
  NewtonKernel<S, Audit> newton_;
  T h_;
  T t_;
  Configuration<S> q_;
  Multipliers<S> lambda_;
  History<Velocity<S>, k + extra> velocities_;            // v_n, v_{n-1}, ...
  History<Velocity<S>, (k > 1 ? k - 1 : 1)> increments_;  // Dq_{n-1}, Dq_{n-2}, ...
  History<Multipliers<S>, k + extra> scaled_lambdas_;     // h lambda_n, ...
};

}  // namespace liebench
