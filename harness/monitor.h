#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "groups/extended.h"
#include "harness/run.h"
#include "integrators/starting_values.h"
#include "problems/system.h"

// How far a run is from the exact solution.

namespace liebench::detail {

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

// A state that a run has reached.
struct ObservedStep {
  std::uint64_t number;
  Extended t;  // since the start
  bool last;
};

// Every how many steps the invariants are looked at: all, where the method chooses them.
inline std::uint64_t drift_stride(const RunRequest& request) {
  return request.chooses_steps ? 1 : std::max<std::uint64_t>(1, request.steps / 1000);
}

// Compares a running method with the exact solution and keeps the norms.
template <MechanicalSystem S>
class Monitor {
 public:
  using Exact = typename S::template rebind<Extended>;

  Monitor(const S& system, std::uint64_t stride) : system_(system), stride_(stride) {
    initial_angular_momentum_ =
        to_double(system.angular_momentum(system.initial_configuration(), system.initial_velocity()));
    initial_energy_ = to_double(system.energy(system.initial_configuration(), system.initial_velocity()));
  }

  // The state at t_n, `last` of the run. q is compared through the rotation and the position that it stands for.
  [[gnu::noinline]] void observe(const ObservedStep& step, const Configuration<S>& configuration,
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
    if constexpr (S::constraints != 0) {
      const auto lambda = multipliers.template cast<Extended>().eval();
      lambda_.end_absolute = max_norm((lambda - exact.lambda).eval());
      lambda_.max_absolute = std::max(lambda_.max_absolute, lambda_.end_absolute);
      if (step.last) lambda_.end_relative = relative_distance(lambda, exact.lambda);
    }
    if (step.last) {
      q_.end_relative = relative_distance(Represented::stacked(q), Represented::stacked(exact_q));
      v_.end_relative = relative_distance(v, exact.v);
    }
    if (step.number % stride_ == 0 || step.last)
      observe_drift(in_scalar_of_run(exact.t), configuration, velocity);
  }

  void report(RunResult& result) const {
    result.q = q_;
    result.v = v_;
    if constexpr (S::constraints != 0) result.lambda = lambda_;
    result.drift = drift_;
  }

 private:
  static typename S::Scalar in_scalar_of_run(const Extended& t) {
    if constexpr (std::is_same_v<typename S::Scalar, Extended>)
      return t;
    else
      return typename S::Scalar(to_double(t));
  }
  void observe_drift(const typename S::Scalar& t, const Configuration<S>& q, const Velocity<S>& v) {
    drift_.energy = std::max(drift_.energy, std::abs(to_double(system_.energy(q, v)) - initial_energy_));
    drift_.angular_momentum =
        std::max(drift_.angular_momentum,
                 std::abs(to_double(system_.angular_momentum(q, v)) - initial_angular_momentum_));
    drift_.group = std::max(drift_.group, to_double(S::Group::defect(q)));
    if constexpr (S::constraints != 0) {
      drift_.position_constraint =
          std::max(drift_.position_constraint.value_or(0.0), max_norm(constraint_at(system_, t, q)));
      drift_.velocity_constraint =
          std::max(drift_.velocity_constraint.value_or(0.0), max_norm(constraint_rate(system_, t, q, v)));
    }
  }

  const S& system_;
  std::uint64_t stride_;
  double initial_energy_;
  double initial_angular_momentum_;
  ErrorNorms q_, v_, lambda_;
  Drift drift_;
};

}  // namespace liebench::detail
