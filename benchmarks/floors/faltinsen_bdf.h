#pragma once

#include "benchmarks/floors/floor.h"

namespace liebench::floors {

inline const Vec3& rotation(const Vec3& v) {
  return v;
}
inline const Vec3& rotation(const Vec6& v) {
  return v.w;
}
inline Vec3 with_rotation(const Vec3&, const Vec3& w) {
  return w;
}
inline Vec6 with_rotation(const Vec6& v, const Vec3& w) {
  return {v.x, w};
}

enum class FaltinsenVariant { exact, bch };

// v = w + (T(u) - I) w with u = h Dq, Dq = base + d, and only the rotation curved: w - Dq = slope d + `ahead`.
template <class Vector, FaltinsenVariant variant>
struct FaltinsenClosure {
  Vector base;
  Vector velocity;
  Vector velocity_change;      // at d = 0, for kappa_{n+1} = kappa_n
  Vector scaled_acceleration;  // the same
  double velocity_slope;
  double acceleration_slope;
  Vec3 ahead;   // w - Dq at d = 0
  Vec3 memory;  // alpha_3 c_2
  Vec3 kappa;   // kappa_n

  static Vec3 bent(double h, const Vec3& increment, const Vec3& excess) {
    const Vec3 p = h * cross(increment, excess);  // u x w, for u x Dq = 0
    if constexpr (variant == FaltinsenVariant::bch) {
      return -0.5 * p;
    } else {
      const Vec3 u = h * increment;
      const double s = squared_norm(u);
      return tangent_coefficient(s) * cross(u, p) - exp_coefficients(s).versine * p;
    }
  }

  template <class Solution>
  void evaluate(double h, const Vector& d, Solution& s) const {
    const Vec3 increment = rotation(base) + rotation(d);
    const Vec3 excess = (velocity_slope - 1.0) * rotation(d) + ahead;
    const Vec3 kappa_change = memory + bent(h, increment, excess) - kappa;
    s.velocity_change = velocity_slope * d + velocity_change;
    s.scaled_acceleration = acceleration_slope * d + scaled_acceleration;
    s.velocity_change = with_rotation(s.velocity_change, rotation(s.velocity_change) + kappa_change);
    s.scaled_acceleration =
        with_rotation(s.scaled_acceleration, rotation(s.scaled_acceleration) + velocity_slope * kappa_change);
  }
  // The first terms of gamma_1 T(u) + h D_s(T(s) w).
  Mat3 velocity_derivative(double h, const Vector& d) const {
    const Vec3 increment = rotation(base) + rotation(d);
    const Vec3 w = increment + (velocity_slope - 1.0) * rotation(d) + ahead;
    return diagonal(velocity_slope, velocity_slope, velocity_slope) +
           (0.5 * h) * skew(w - velocity_slope * increment);
  }
  Mat3 acceleration_derivative(double h, const Vector& d) const {
    return velocity_slope * velocity_derivative(h, d);
  }
};

// The BDF method with k = 3 of Faltinsen, Marthinsen & Munthe-Kaas in increments for one of the tops. With a = h Dq_{n-1},
// b = h Dq_{n-2}, u = h Dq_n and E = exp:
//
//   w = sum_{i=1}^3 gamma_i Dq_{n+1-i} + alpha_3 c_2,   c_2 = s_2 / h + Dq_{n-1} + Dq_{n-2}
//   exact   s_2 = -log(E_{n-2} E_{n-1}),      v_{n+1} = T(u) w
//   bch     s_2 = -(a + b) + 1/2 [a, b],      v_{n+1} = w - 1/2 [u, w]
template <class Top, FaltinsenVariant variant>
class FaltinsenBdf {
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
    motion_ = exp(h * rotation(increment_));
    older_motion_ = exp(h * rotation(older));
    increment_changes_[0] = increment_ - older;
    count_ = 1;
    velocity_changes_[0] = v_ - from_eigen(points[1].v);
    velocity_changes_[1] = from_eigen(points[1].v) - from_eigen(points[0].v);
    if constexpr (Top::l > 0) {
      scaled_lambdas_[0] = h * from_eigen(points[2].lambda);
      lambda_count_ = 1;
    }
    first_change_ = gamma1 * increment_ + gamma2 * increment_ + gamma3 * older - v_;
  }

  bool step() {
    const auto& dd = increment_changes_;
    const auto& dv = velocity_changes_;
    Vector change = first_ ? first_change_ : gamma2 * dd[0] + gamma3 * dd[1];
    if constexpr (stabilized) change = change - gamma1 * stabilization_;
    const Vec3 memory = alpha3 * c2();
    const FaltinsenClosure<Vector, variant> closure{
        .base = increment_,
        .velocity = v_,
        .velocity_change = change,
        .scaled_acceleration = gamma1 * change + gamma2 * dv[0] + gamma3 * dv[1],
        .velocity_slope = gamma1,
        .acceleration_slope = gamma1 * gamma1,
        .ahead = memory - gamma3 * rotation(dd[0]),
        .memory = memory,
        .kappa = kappa_};
    const double* c = extrapolation[count_];
    typename Top::Unknowns z;
    z.d = c[0] * dd[0] + c[1] * dd[1] + c[2] * dd[2] + c[3] * dd[3];
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
    kappa_ = kappa_ + rotation(s.velocity_change - (gamma1 * s.change + change));
    velocity_changes_[1] = velocity_changes_[0];
    velocity_changes_[0] = s.velocity_change;
    if constexpr (stabilized) stabilization_ = s.change - z.d;
    increment_ = increment_ + z.d;
    increment_changes_[3] = increment_changes_[2];
    increment_changes_[2] = increment_changes_[1];
    increment_changes_[1] = increment_changes_[0];
    increment_changes_[0] = z.d;
    if (count_ < 4) ++count_;
    older_motion_ = motion_;
    motion_ = s.motion;
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
  static constexpr double gamma1 = 11.0 / 6.0, gamma2 = -7.0 / 6.0, gamma3 = 1.0 / 3.0, alpha3 = -1.0 / 3.0;
  static constexpr bool stabilized = std::is_same_v<Top, StabilizedTop>;

  Vec3 c2() const {
    const Vec3& increment = rotation(increment_);
    const Vec3& change = rotation(increment_changes_[0]);  // Dq_{n-1} - Dq_{n-2}
    if constexpr (variant == FaltinsenVariant::bch) {
      // 1/2 [a, b] / h, and [Dq_{n-1}, Dq_{n-2}] = [change, Dq_{n-1}]
      return (0.5 * h_) * cross(change, increment);
    } else {
      return 2.0 * increment - change - (1.0 / h_) * log(older_motion_ * motion_);
    }
  }

  Top top_;
  double h_ = 0.0, t_ = 0.0;
  typename Top::Configuration q_{};
  Vector v_{}, increment_{}, first_change_{}, stabilization_{};
  Vec3 kappa_{};
  Mat3 motion_{}, older_motion_{};  // exp(h Dq_{n-1}), exp(h Dq_{n-2})
  Vector velocity_changes_[2]{}, increment_changes_[4]{};
  Vec3 lambda_{}, scaled_lambdas_[5]{};
  int count_ = 0, lambda_count_ = 0;
  bool first_ = true;
};

}  // namespace liebench::floors
