#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>

#include "harness/run.h"
#include "integrators/list.h"
#include "integrators/self_start.h"
#include "integrators/starting_values.h"

// The inside of the seam: everything from here down is a template on system and scalar.

namespace liebench {

namespace detail {

template <class Vector>
double max_norm(const Vector& v) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    const double x = std::abs(to_double(v(i)));
    if (!(x <= largest)) largest = x;
  }
  return largest;
}

// ||a - b||_2 / ||b||_2, the difference taken before rounding; ||a - b||_2 where b = 0.
template <class Vector>
double relative_distance(const Vector& a, const Vector& b) {
  const Eigen::VectorXd difference = (a - b).eval().template cast<double>();
  const Eigen::VectorXd reference = b.template cast<double>();
  const double size = reference.norm();
  return size > 0.0 ? difference.norm() / size : difference.norm();
}

// A solution point in the scalar of the run.
template <MechanicalSystem S>
SolutionPoint<S> rounded(const SolutionPoint<typename S::template rebind<Extended>>& p) {
  using T = typename S::Scalar;
  using Group = typename S::template rebind<Extended>::Group;
  SolutionPoint<S> r;
  if constexpr (std::is_same_v<T, double>)
    r.t = to_double(p.t);
  else
    r.t = p.t;
  r.q = Group::template cast<T>(p.q);
  r.v = p.v.template cast<T>();
  r.acceleration = p.acceleration.template cast<T>();
  r.lambda = p.lambda.template cast<T>();
  return r;
}

// Compares a running method with the exact solution and keeps the norms.
template <MechanicalSystem S>
class Monitor {
 public:
  using Exact = typename S::template rebind<Extended>;

  Monitor(const S& system, std::uint64_t steps)
      : system_(system), stride_(std::max<std::uint64_t>(1, steps / 1000)), steps_(steps) {
    initial_angular_momentum_ =
        to_double(system.angular_momentum(system.initial_configuration(), system.initial_velocity()));
    initial_energy_ = to_double(system.energy(system.initial_configuration(), system.initial_velocity()));
  }

  // The state at t_n. q is compared through the rotation and the position that it stands for.
  [[gnu::noinline]] void observe(std::uint64_t n, const Configuration<S>& configuration,
                                 const Velocity<S>& velocity, const Multipliers<S>& multipliers,
                                 const SolutionPoint<Exact>& exact) {
    using Represented = typename Exact::Group::Represented;
    const auto q = Exact::Group::represented(S::Group::template cast<Extended>(configuration));
    const auto exact_q = Exact::Group::represented(exact.q);
    const auto v = velocity.template cast<Extended>().eval();
    q_.end_absolute = max_norm(Represented::separation(q, exact_q));
    v_.end_absolute = max_norm((v - exact.v).eval());
    q_.max_absolute = std::max(q_.max_absolute, q_.end_absolute);
    v_.max_absolute = std::max(v_.max_absolute, v_.end_absolute);
    if constexpr (S::constraints > 0) {
      const auto lambda = multipliers.template cast<Extended>().eval();
      lambda_.end_absolute = max_norm((lambda - exact.lambda).eval());
      lambda_.max_absolute = std::max(lambda_.max_absolute, lambda_.end_absolute);
      if (n == steps_) lambda_.end_relative = relative_distance(lambda, exact.lambda);
    }
    if (n == steps_) {
      q_.end_relative = relative_distance(Represented::stacked(q), Represented::stacked(exact_q));
      v_.end_relative = relative_distance(v, exact.v);
    }
    if (n % stride_ == 0 || n == steps_) observe_drift(configuration, velocity);
  }

  void report(RunResult& result) const {
    result.q = q_;
    result.v = v_;
    if constexpr (S::constraints > 0) result.lambda = lambda_;
    result.drift = drift_;
  }

 private:
  void observe_drift(const Configuration<S>& q, const Velocity<S>& v) {
    drift_.energy = std::max(drift_.energy, std::abs(to_double(system_.energy(q, v)) - initial_energy_));
    drift_.angular_momentum =
        std::max(drift_.angular_momentum,
                 std::abs(to_double(system_.angular_momentum(q, v)) - initial_angular_momentum_));
    drift_.group = std::max(drift_.group, to_double(S::Group::defect(q)));
    if constexpr (S::constraints > 0) {
      drift_.position_constraint =
          std::max(drift_.position_constraint.value_or(0.0), max_norm(system_.constraint(q)));
      drift_.velocity_constraint = std::max(drift_.velocity_constraint.value_or(0.0),
                                            max_norm((system_.constraint_gradient(q) * v).eval()));
    }
  }

  const S& system_;
  std::uint64_t stride_;
  std::uint64_t steps_;
  double initial_energy_;
  double initial_angular_momentum_;
  ErrorNorms q_, v_, lambda_;
  Drift drift_;
};

constexpr std::string_view explanation(Outcome outcome) {
  switch (outcome) {
    case Outcome::ok:
      return "";
    case Outcome::newton_diverged:
      return "Newton's increments do not shrink; the step size is too large here";
    case Outcome::singular_matrix:
      return "the matrix of the step equation has a zero pivot";
    case Outcome::non_finite:
      return "an infinity or a NaN in the state";
    case Outcome::rotation_too_large:
      return "an increment turns by pi or more; the step size is too large here";
    case Outcome::step_limit:
      return "more steps than allowed";
  }
  return "";
}

// One accuracy run. `exact(t)` is the solution point at t.
template <class Stepper, class Solution>
RunResult follow(Stepper stepper, const typename Stepper::System& system, const RunRequest& request,
                 const Solution& exact) {
  using S = typename Stepper::System;
  using T = typename S::Scalar;
  const auto time = [&](std::uint64_t n) { return request.step_size * Extended(double(n)); };
  RunResult result;
  const auto fail = [&](const StepResult& step, std::uint64_t n) {
    result.outcome = step.outcome;
    result.failure = RunFailure{.time = to_double(time(n)),
                                .step = n,
                                .residual = step.residual,
                                .message = std::string(explanation(step.outcome))};
    result.audit = stepper.audit();
    return result;
  };

  T h;
  if constexpr (std::is_same_v<T, double>)
    h = to_double(request.step_size);
  else
    h = request.step_size;
  std::array<SolutionPoint<S>, std::size_t(most_starting_points)> room;
  const auto points = std::span(room).first(std::size_t(stepper.starting_points()));
  const auto first = std::uint64_t(stepper.steps());
  if (request.start == Start::self) {
    const StepResult own = self_start(system, T(0.0), h, points, stepper.audit());
    if (own.outcome != Outcome::ok) return fail(own, first - 1);
  } else {
    for (std::size_t j = 0; j < points.size(); ++j) points[j] = rounded<S>(exact(time(j)));
  }
  if (const StepResult start = stepper.start(h, points); start.outcome != Outcome::ok)
    return fail(start, first - 1);
  Monitor<S> monitor(system, request.steps);
  const auto observe = [&](std::uint64_t n) {
    monitor.observe(n, stepper.configuration(), stepper.velocity(), stepper.multipliers(), exact(time(n)));
  };
  if (request.start == Start::self) {
    // What the method's own start has computed are errors of the run; of the last point as the method goes on from it.
    for (std::uint64_t n = 1; n + 1 < first; ++n)
      monitor.observe(n, points[n].q, points[n].v, points[n].lambda, exact(time(n)));
    if (first > 1) observe(first - 1);
  }
  for (std::uint64_t n = first; n <= request.steps; ++n) {
    if (const StepResult step = stepper.step(); step.outcome != Outcome::ok) return fail(step, n);
    observe(n);
  }
  monitor.report(result);
  result.audit = stepper.audit();
  return result;
}

}  // namespace detail

// Runs the integrator that the request names, of the list of all, on a system with its exact solution.
template <MechanicalSystem S, class Solution>
RunResult run_method(const RunRequest& request, const S& system, const Solution& exact) {
  RunResult result;
  const auto attempt = [&]<class Method>(IntegratorList<Method>) {
    if (Method::name != request.integrator) return false;
    result = Method::template with_stepper<S, KernelAudit>(
        Method::options(request.options), system,
        [&](auto stepper) { return detail::follow(std::move(stepper), system, request, exact); });
    return true;
  };
  const bool found = [&]<class... Methods>(IntegratorList<Methods...>) {
    return (attempt(IntegratorList<Methods>{}) || ...);
  }(Integrators{});
  if (!found) throw std::logic_error(fmt::format("integrator \"{}\" is not in the list", request.integrator));
  return result;
}

}  // namespace liebench
