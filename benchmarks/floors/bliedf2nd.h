#pragma once

#include "benchmarks/floors/floor.h"

namespace liebench::floors {

// BLieDF2nd with k = 3 and L_3, eqs. (20) to (23), for one of the tops.
template <class Top>
class BLieDF2nd {
 public:
  using System = typename Top::System;
  using Vector = typename Top::Vector;
  static constexpr int starting_points = 4;

  void start(double h, std::span<const SolutionPoint<System>> points) {
    h_ = h;
    t_ = points[2].t;
    q_ = configuration_from<typename Top::Configuration>(points[2].q);
    v_ = from_eigen(points[2].v);
    const Vector older = increment_from<System>(h, points, 0);
    increment_ = increment_from<System>(h, points, 1);
    increment_changes_[0] = increment_ - older;
    velocity_changes_[0] = v_ - from_eigen(points[1].v);
    velocity_changes_[1] = from_eigen(points[1].v) - from_eigen(points[0].v);
    count_ = 2;
    if constexpr (Top::l > 0) {
      scaled_lambdas_[0] = h * from_eigen(points[2].lambda);
      lambda_count_ = 1;
    }
    correction_ = correction();
    first_change_ = gamma1 * increment_ + gamma2 * increment_ + gamma3 * older - correction_ - v_;
  }

  bool step() {
    // v_{n+1} - v_n and h v' at d = 0.
    Vector change = first_change_;
    if (!first_) {
      const Vector correction_n = correction();
      change = gamma2 * increment_changes_[0] + gamma3 * increment_changes_[1] - (correction_n - correction_);
      correction_ = correction_n;
    }
    if constexpr (stabilized) change = change - gamma1 * stabilization_;
    const auto& dv = velocity_changes_;
    const AffineClosure<Vector> closure{
        .base = increment_,
        .velocity = v_,
        .velocity_change = change,
        .scaled_acceleration = gamma1 * change + gamma2 * dv[0] + gamma3 * dv[1],
        .velocity_slope = gamma1,
        .acceleration_slope = gamma1 * gamma1};
    const double* c = extrapolation[count_];
    typename Top::Unknowns z;
    z.d = (1.0 / gamma1) * (c[0] * dv[0] + c[1] * dv[1] + c[2] * dv[2] + c[3] * dv[3] - change);
    if constexpr (Top::l > 0) {
      const double* b = extrapolation[lambda_count_];
      const auto& hl = scaled_lambdas_;
      z.scaled_lambda = b[0] * hl[0] + b[1] * hl[1] + b[2] * hl[2] + b[3] * hl[3] + b[4] * hl[4];
    }
    if constexpr (stabilized) z.eta = {0.0, 0.0, 0.0};

    typename Top::Solution s;
    if (!top_.solve(h_, q_, closure, z, s) || turns_too_far(s.turn)) return false;

    t_ += h_;
    v_ = v_ + s.velocity_change;
    velocity_changes_[3] = velocity_changes_[2];
    velocity_changes_[2] = velocity_changes_[1];
    velocity_changes_[1] = velocity_changes_[0];
    velocity_changes_[0] = s.velocity_change;
    if (count_ < 4) ++count_;
    if constexpr (stabilized) stabilization_ = s.change - z.d;
    increment_ = increment_ + z.d;
    increment_changes_[1] = increment_changes_[0];
    increment_changes_[0] = z.d;
    first_ = false;
    if constexpr (Top::l > 0) {
      lambda_ = (1.0 / h_) * z.scaled_lambda;
      for (int i = 4; i > 0; --i) scaled_lambdas_[i] = scaled_lambdas_[i - 1];
      scaled_lambdas_[0] = z.scaled_lambda;
      if (lambda_count_ < 5) ++lambda_count_;
    }
    return true;
  }

  double time() const { return t_; }
  const typename Top::Configuration& configuration() const { return q_; }
  const Vector& velocity() const { return v_; }
  const KeptMatrix& kept() const { return top_.kept; }

 private:
  static constexpr double gamma1 = 11.0 / 6.0, gamma2 = -7.0 / 6.0, gamma3 = 1.0 / 3.0;
  static constexpr bool stabilized = std::is_same_v<Top, StabilizedTop>;

  // h^2 L_3, eq. (22b)
  Vector correction() const {
    return (h_ / 24.0) * commutator(v_, 3.0 * velocity_changes_[0] - velocity_changes_[1]);
  }

  Top top_;
  double h_ = 0.0, t_ = 0.0;
  typename Top::Configuration q_{};
  Vector v_{}, increment_{}, correction_{}, first_change_{}, stabilization_{};
  Vector velocity_changes_[4]{}, increment_changes_[2]{};
  Vec3 lambda_{}, scaled_lambdas_[5]{};
  int count_ = 0, lambda_count_ = 0;
  bool first_ = true;
};

}  // namespace liebench::floors
