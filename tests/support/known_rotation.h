#pragma once

#include <qd/dd_real.h>

#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

#include "groups/extended.h"
#include "groups/so3.h"
#include "integrators/affine_closure.h"
#include "integrators/bdf_stepper.h"

// A rotation whose velocity is known, v(t) = (sin 1.3 t + 0.4, cos 0.7 t - e^-t / 2, 0.8 e^{t/2} + 0.3 sin 2 t), for the
// local error of kinematic equations in extended precision. Its increments, the one thing that takes an integration, are
// those of theta' = T^{-1}(theta) v, theta(0) = 0, Dq = theta(h) / h, by Gragg's extrapolation, which shares nothing with
// the integrators.

namespace liebench {

class KnownRotation {
 public:
  using Group = SO3<Extended>;
  using Vector = Group::Tangent;

  static Vector velocity(const Extended& t) {
    return Vector(sin(t * 1.3) + 0.4, cos(t * 0.7) - exp(-t) * 0.5, exp(t * 0.5) * 0.8 + sin(t * 2.0) * 0.3);
  }

  // Dq of the step from t to t + h: modified midpoint rule with 2, 4, ..., 2 levels sub-steps, whose error is a series in
  // the square of the sub-step; the last of `levels` columns is of order 2 levels = 16.
  static Vector increment(const Extended& t, const Extended& h) {
    constexpr std::size_t levels = 8;
    std::vector<Vector> row;
    for (std::size_t level = 1; level <= levels; ++level) {
      std::vector<Vector> next{midpoint_rule(t, h, int(2 * level))};
      for (std::size_t j = 1; j < level; ++j) {
        next.push_back(next[j - 1] +
                       (next[j - 1] - row[j - 1]) / Extended(ratio_minus_one(level, level - j)));
      }
      row = std::move(next);
    }
    return row.back() / h;
  }

 private:
  // (n / m)^2 - 1
  static Extended ratio_minus_one(std::size_t n, std::size_t m) {
    return Extended(double(n * n)) / double(m * m) - 1.0;
  }
  static Vector rate(const Extended& t, const Vector& theta) {
    return Group::tangent_inverse(theta) * velocity(t);
  }
  static Vector midpoint_rule(const Extended& t, const Extended& h, int n) {
    const Extended step = h / double(n);
    Vector before = Vector::Constant(Extended(0.0));
    Vector now = step * rate(t, before);
    for (int i = 1; i < n; ++i) {
      const Vector next = before + (step * 2.0) * rate(t + step * double(i), now);
      before = now;
      now = next;
    }
    return (now + before + step * rate(t + h, now)) / Extended(2.0);
  }
};

// The k-step kinematic equation at a step of the known rotation that ends at t = 1: state and affine closure as a stepper
// would have them, from exact values and with kappa_n = 0.
template <int k, MechanicalSystem S>
struct KnownStep {
  using Vector = KnownRotation::Vector;
  S system{HeavyTopParameters{}};
  BdfState<S> state{system, k};
  AffineClosure<S> affine;
  std::vector<Vector> increments;  // Dq_n, Dq_{n-1}, ..., Dq_{n+1-k}
  Vector change;                   // Dq_n - Dq_{n-1}
  Vector exact;                    // v(t_{n+1})

  explicit KnownStep(const Extended& h) {
    const auto time = [&](int i) { return Extended(1.0) - h * double(i); };  // t_{n+1-i}
    const auto v = [&](int i) { return KnownRotation::velocity(time(i)); };
    for (int i = 0; i <= k; ++i) increments.push_back(KnownRotation::increment(time(i + 1), h));
    state.h = h;
    state.velocity = v(1);
    state.increment = increments[1];
    state.kappa.setConstant(Extended(0.0));
    for (int i = k - 1; i >= 1; --i) state.velocity_changes.push(v(i) - v(i + 1));
    for (int i = k - 1; i >= 1; --i)
      state.increment_changes.push(increments[std::size_t(i)] - increments[std::size_t(i + 1)]);
    change = increments[0] - increments[1];
    exact = v(0);
    const auto& gamma = state.coefficients.gamma;
    Vector known = gamma[0] * increments[1] - v(1);
    for (std::size_t i = 1; i < std::size_t(k); ++i) known += gamma[i] * increments[i];
    affine = {.base_increment = increments[1],
              .velocity = v(1),
              .velocity_slope = gamma[0],
              .velocity_change = known,
              .acceleration_slope = gamma[0] * gamma[0],
              .scaled_acceleration = gamma[0] * known};
  }
};

}  // namespace liebench
