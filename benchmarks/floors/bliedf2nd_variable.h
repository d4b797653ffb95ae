#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <type_traits>

#include "benchmarks/floors/floor.h"
#include "benchmarks/floors/rkmk_variable.h"
#include "integrators/order_control.h"
#include "integrators/step_differences.h"

namespace liebench::floors {

inline const Vec3& turn_of(const Vec3& v) {
  return v;
}
inline const Vec3& turn_of(const Vec6& v) {
  return v.w;
}

// The part of w that the constraint of the last step leaves, by its matrix: gamma_1^2 times the solution for (M w, 0).
inline Vec6 tangential_part(const Index3Top& top, const Vec6& w, double slope) {
  const double r[Index3Top::n] = {top::mass * w.x.x,
                                  top::mass * w.x.y,
                                  top::mass * w.x.z,
                                  top::J1 * w.w.x,
                                  top::J2 * w.w.y,
                                  top::J3 * w.w.z,
                                  0.0,
                                  0.0,
                                  0.0};
  double c[Index3Top::n];
  top.lu.solve(r, c);
  return slope * Vec6{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}};
}

// BLieDF2nd with steps and orders 1, ..., 4 by a tolerance, for one of the tops. The rules of step and order, and the coefficients of
// a sequence of steps, are those of the method itself (integrators/order_control.h, integrators/step_differences.h), which know plain
// numbers only. The look at stability before an order is raised is left out: nothing damps the top, and it is asked for a few times in a
// run.
template <class Top>
class BLieDF2ndVariable {
 public:
  using System = typename Top::System;
  using Vector = typename Top::Vector;
  static constexpr int starting_points = 1;

  void start(double length, std::span<const SolutionPoint<System>> points) {
    t_ = points[0].t;
    t_end_ = t_ + length;
    q_ = configuration_from<typename Top::Configuration>(points[0].q);
    v_ = from_eigen(points[0].v);
    const Vector a = from_eigen(points[0].acceleration);
    if constexpr (Top::l > 0) lambda_ = from_eigen(points[0].lambda);
    const double v = max_norm(v_);
    h_ = dividing(std::min(0.1 * std::sqrt(tolerance) / (v + max_norm(a) / (1.0 + v)), length));
    past_.fill(h_);
    accelerations_[0] = a;
    lag_ = (h_ / -2.0) * a;
    increment_ = v_ + lag_;
  }
  bool finished() const { return t_ == t_end_; }

  bool step() {
    const double t = t_;
    const auto q = q_;
    const Vector v = v_;
    const Vec3 lambda = lambda_;
    keep_below_half_a_turn();
    for (;;) {
      const bool last = !(t_end_ - t_ > 1.5 * h_);
      if (last) h_ = t_end_ - t_;
      if (!last && t_ + h_ == t_) return false;
      k_ = control_.order();
      prepare();
      const AffineClosure<Vector> closure = next_closure();
      renew_matrix(closure.velocity_slope);
      typename Top::Unknowns z;
      z.d = (1.0 / gamma_[0]) * (h_ * predicted(k_, accelerations_) - closure.velocity_change);
      if constexpr (Top::l > 0) {
        z.scaled_lambda = h_ * lambda_;
        if (const int l = std::min(k_, lambda_count_); l > 0)
          z.scaled_lambda = z.scaled_lambda + (h_ * h_) * predicted(l, lambda_slopes_);
      }
      if constexpr (stabilized) z.eta = {0.0, 0.0, 0.0};
      typename Top::Solution s;
      double factor = 0.0;
      if (top_.solve(h_, q_, closure, z, s) && !turns_too_far(s.turn)) {
        t_ = t_ + h_;
        v_ = v + s.velocity_change;
        if constexpr (Top::l > 0) lambda_ = (1.0 / h_) * z.scaled_lambda;
        const OrderControl::Errors errors = errors_of(z.d, s.velocity_change);
        if (errors.same <= 1.0) {
          if (last) t_ = t_end_;
          remember(z.d, s.velocity_change, lambda);
          lengthen(control_.accept(errors));
          return true;
        }
        factor = control_.reject(errors);
      } else {
        factor = control_.fail();
      }
      t_ = t;
      q_ = q;
      v_ = v;
      lambda_ = lambda;
      ++rejections_;
      h_ = dividing(factor * h_);
    }
  }

  double time() const { return t_; }
  const typename Top::Configuration& configuration() const { return q_; }
  const Vector& velocity() const { return v_; }
  const KeptMatrix& kept() const { return top_.kept; }
  long rejections() const { return rejections_; }

 private:
  static constexpr double tolerance = 1e-6;
  static constexpr int most_order = 4;
  static constexpr bool stabilized = std::is_same_v<Top, StabilizedTop>;
  using Differences = StepDifferences<double>;
  using PerSlope = std::array<double, Differences::most>;

  double dividing(double h) const {
    const double left = t_end_ - t_;
    return left / std::max(std::ceil(left / h - 1e-6), 1.0);
  }
  double longest_step() const { return 0.9 * std::numbers::pi / std::sqrt(squared_norm(turn_of(v_))); }
  void keep_below_half_a_turn() {
    const double longest = longest_step();
    if (!(h_ > 1.05 * longest)) return;
    h_ = dividing(longest);
    control_.step_changed();
  }
  void lengthen(double factor) {
    if (factor <= 1.0 || finished()) return;
    const double longer = dividing(std::min(factor * h_, longest_step()));
    if (longer / h_ < OrderControl::worthwhile) return;
    h_ = longer;
    control_.step_changed();
  }

  void prepare() {
    const PerSlope steps{h_, past_[0], past_[1], past_[2], past_[3]};
    if (k_ == prepared_order_ && steps == prepared_steps_) return;
    differences_ = Differences(steps);
    prepared_order_ = k_;
    prepared_steps_ = steps;
    gamma_.fill(0.0);
    S_0_ = S_1_ = 0.0;
    for (int l = 0; l < k_; ++l) {
      for (int i = 0; i <= l; ++i) gamma_[i] += differences_.D[l][i];
      S_0_ += differences_.square_moment[l];
      S_1_ += differences_.cubic_moment[l];
    }
    double sum = -1.0;
    for (std::size_t i = 0; i < gamma_.size(); ++i) gammas_less_one_[i] = sum += gamma_[i];
  }
  void renew_matrix(double slope) {
    const auto differs = [](double x, double y) { return !(std::abs(x - y) < 0.02 * std::abs(y)); };
    if (!differs(h_, matrix_step_) && !differs(slope, matrix_slope_)) return;
    top_.kept.factorized = false;
    matrix_step_ = h_;
    matrix_slope_ = slope;
  }

  // x_1 by phi_l = 0.
  template <class Value>
  Value predicted(int l, const Value (&past)[4]) const {
    const auto& D = differences_.D[l];
    Value sum = D[1] * past[0];
    for (int i = 1; i < l; ++i) sum = sum + D[i + 1] * past[i];
    return (-1.0 / D[0]) * sum;
  }

  AffineClosure<Vector> next_closure() {
    Vector change = lag_;
    for (int i = 0; i < k_ - 2; ++i) change = change + gammas_less_one_[i + 1] * changes_[i];
    const auto& m = differences_.middle;
    Vector weighted = S_0_ * accelerations_[0];
    if (k_ >= 3) {
      const Vector second = (1.0 / (m[1] - m[3])) * (accelerations_[0] - accelerations_[2]);
      weighted = S_0_ * (accelerations_[0] - m[1] * second) + S_1_ * second;
    }
    correction_ = (1.0 / 12.0) * commutator(v_, weighted);
    change = change - correction_;
    Vector acceleration = (gamma_[0] / h_) * change;
    for (int i = 0; i < k_ - 1; ++i) acceleration = acceleration + gamma_[i + 1] * accelerations_[i];
    return {.base = increment_,
            .velocity = v_,
            .velocity_change = change,
            .scaled_acceleration = h_ * acceleration,
            .velocity_slope = gamma_[0],
            .acceleration_slope = gamma_[0] * gamma_[0]};
  }

  OrderControl::Errors errors_of(const Vector& d, const Vector& velocity_change) const {
    const auto& m = differences_.middle;
    const int other = k_ < 3 ? 2 : 3;
    const Vector x = (1.0 / h_) * velocity_change;
    const Vector second = (1.0 / (m[0] - m[other - 1])) * (x - accelerations_[other - 2]);
    const Vector first = x - m[0] * second;
    const Vector of_first = (1.0 / 12.0) * commutator(v_, first);
    const Vector of_second = (1.0 / 12.0) * commutator(v_, second);
    const Vector of_correction = S_0_ * of_first + S_1_ * of_second - correction_;
    const auto error = [&](int l) {
      const auto& D = differences_.D[l];
      double gamma_1 = 0.0;
      for (int i = 0; i < l; ++i) gamma_1 += differences_.D[i][0];
      const double factor = h_ / gamma_1;
      double sum = D[0];
      Vector of_q = sum * d, of_v = D[0] * x;
      for (int i = 1; i < l; ++i) {
        sum += D[i];
        of_q = of_q + sum * changes_[i - 1];
      }
      for (int i = 1; i <= l; ++i) of_v = of_v + D[i] * accelerations_[i - 1];
      of_q = of_q - differences_.square_moment[l] * of_first - differences_.cubic_moment[l] * of_second -
             of_correction;
      of_v = factor * of_v;
      if constexpr (std::is_same_v<Top, Index3Top>) of_v = tangential_part(top_, of_v, gamma_[0] * gamma_[0]);
      return scaled_error((factor * h_) * of_q, of_v, v_, 1.0 / tolerance);
    };
    OrderControl::Errors errors{.same = error(k_)};
    const bool accepted = errors.same <= 1.0, may_change = control_.may_change();
    if (k_ > 1 && (!accepted || may_change)) errors.lower = error(k_ - 1);
    if (k_ < most_order && accepted && may_change && changes_count_ >= k_) errors.higher = error(k_ + 1);
    return errors;
  }

  template <class Value, std::size_t n>
  static void push(Value (&past)[n], const Value& value) {
    for (std::size_t i = n - 1; i > 0; --i) past[i] = past[i - 1];
    past[0] = value;
  }
  void remember(const Vector& d, const Vector& velocity_change, const Vec3& lambda) {
    lag_ = lag_ + (d - velocity_change);
    increment_ = increment_ + d;
    push(changes_, d);
    changes_count_ = std::min(changes_count_ + 1, 3);
    push(accelerations_, (1.0 / h_) * velocity_change);
    if constexpr (Top::l > 0) {
      push(lambda_slopes_, (1.0 / h_) * (lambda_ - lambda));
      lambda_count_ = std::min(lambda_count_ + 1, 4);
    }
    for (std::size_t i = past_.size() - 1; i > 0; --i) past_[i] = past_[i - 1];
    past_[0] = h_;
  }

  Top top_;
  OrderControl control_{most_order};
  double h_ = 0.0, t_ = 0.0, t_end_ = 0.0;
  long rejections_ = 0;
  int k_ = 1, prepared_order_ = 0;
  PerSlope prepared_steps_{}, gamma_{}, gammas_less_one_{};
  Differences differences_{std::span<const double>()};
  double S_0_ = 0.0, S_1_ = 0.0, matrix_step_ = 0.0, matrix_slope_ = 0.0;
  std::array<double, 4> past_{};
  typename Top::Configuration q_{};
  Vector v_{}, increment_{}, lag_{}, correction_{}, accelerations_[4]{}, changes_[3]{};
  Vec3 lambda_{}, lambda_slopes_[4]{};
  int changes_count_ = 0, lambda_count_ = 0;
};

}  // namespace liebench::floors
