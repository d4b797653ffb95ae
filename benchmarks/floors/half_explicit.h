#pragma once

#include <array>
#include <cstddef>
#include <numbers>
#include <span>

#include "benchmarks/floors/lu.h"
#include "benchmarks/floors/one_step.h"
#include "benchmarks/floors/tip_force.h"
#include "benchmarks/floors/top.h"
#include "groups/rotation_coefficients.h"
#include "integrators/half_explicit_tableau.h"

// Half-explicit steps of the constrained top on R^3 x SO(3), eq. (58), by hand: integrators/half_explicit_stepper.h has the
// equations.

namespace liebench::floors {

template <const auto& tableau, bool projection>
class HalfExplicit : public TipFloor {
 public:
  void start(double h, std::span<const SolutionPoint<System>> points) {
    TipFloor::start(h, points);
    lambda_ = from_eigen(points[0].lambda);
  }

  // Loops over the stages, which the compiler unrolls.
  [[gnu::flatten]] bool step() {
    std::array<Vec6, s> K, F;
    std::array<Vec3, s> lambda;
    K[0] = v_;
    F[0] = has_acceleration_ ? acceleration_ : accelerated(q_, free_acceleration(v_), lambda_);
    Vec6 theta = h_ * sum(1, 1, K), V = v_ + h_ * sum(1, 1, F);
    if (turns_too_far(theta.w)) return false;
    Configuration Q = moved(theta), end = Q;
    Vec6 end_velocity = V;
#pragma GCC unroll 8
    for (std::size_t i = 1; i < s; ++i) {
      if (i == tableau.end) {
        end = Q;
        end_velocity = V;
      }
      K[i] = {V.x, tangent_inverse_times(theta.w, V.w)};
      theta = h_ * sum(i + 1, i + 1, K);
      if (turns_too_far(theta.w)) return false;
      const Configuration next = moved(theta);
      if (!force_.factorize(Q, next)) return false;
      // V_{i+1} without v'_i.
      const Vec6 known = v_ + h_ * sum(i + 1, i, F);
      const double own = h_ * weight(i + 1, i);
      const Vec6 free = free_acceleration(V);
      lambda[i] = force_.solve(rate(next, free) + (1.0 / own) * rate(next, known));
      F[i] = accelerated(Q, free, lambda[i]);
      V = known + own * F[i];
      Q = next;
    }
    if (tableau.end == s) {
      end = Q;
      end_velocity = V;
    }
    if constexpr (projection)
      if (!project(end, end_velocity)) return false;
    Vec3 force{0.0, 0.0, 0.0};
#pragma GCC unroll 8
    for (std::size_t i = 1; i < s; ++i)
      if (tableau.d[i].numerator != 0)
        force = force + (double(tableau.d[i].numerator) / double(tableau.d[i].denominator)) * lambda[i];
    if (!std::isfinite(max_norm(end_velocity) + max_norm(force))) return false;
    t_ += h_;
    q_ = end;
    v_ = end_velocity;
    lambda_ = force;
    if constexpr (tableau.first_same_as_last()) {
      acceleration_ = F[s - 1];
      has_acceleration_ = !projection;
    }
    return true;
  }

 private:
  static constexpr std::size_t s = tableau.stages;

  static constexpr double weight(std::size_t row, std::size_t j) {
    const Fraction& f = tableau.row(row)[j];
    return (double(f.numerator) + double(f.root_three) * std::numbers::sqrt3) / double(f.denominator);
  }
  [[gnu::always_inline]] static Vec6 sum(std::size_t row, std::size_t count,
                                         const std::array<Vec6, s>& slopes) {
    Vec6 result{};
#pragma GCC unroll 8
    for (std::size_t j = 0; j < count; ++j)
      if (weight(row, j) != 0.0) result = result + weight(row, j) * slopes[j];
    return result;
  }
  Configuration moved(const Vec6& theta) const {
    return at(q_.x + theta.x, q_.R * exp(theta.w));
  }

  // Onto Phi = 0 and B v = 0, by the least change in the norm of M.
  [[gnu::noinline]] bool project(Configuration& q, Vec6& v) {
    if (!force_.factorize(q, q)) return false;
    const Configuration from = q;
    const Vec6 none{};
    Vec6 delta{};
    Vec3 phi = violation(q);
    double left = max_norm(phi);
    for (int i = 0; i < 30 && 0.0 < left; ++i) {
      delta = delta + accelerated(from, none, force_.solve(phi));
      const Configuration nearer = at(from.x + delta.x, from.R * exp(delta.w));
      phi = violation(nearer);
      const double now = max_norm(phi);
      if (!std::isfinite(now)) return false;
      if (!(now < left)) break;
      q = nearer;
      left = now;
    }
    if (!force_.factorize(q, q)) return false;
    v = v + accelerated(q, none, force_.solve(rate(q, v)));
    return true;
  }

  TipForce force_;
  bool has_acceleration_ = false;
  Vec6 acceleration_{};
  Vec3 lambda_{};
};

}  // namespace liebench::floors
