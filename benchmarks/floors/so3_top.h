#pragma once

#include "benchmarks/floors/kept_matrix.h"
#include "benchmarks/floors/lu.h"
#include "benchmarks/floors/rotation.h"
#include "benchmarks/floors/top.h"
#include "problems/heavy_top.h"

// One step of the top on SO(3), eq. (57), by hand: unknown d, residual h r.

namespace liebench::floors {

struct SO3Top {
  using System = HeavyTopSO3<double>;
  using Vector = Vec3;
  static constexpr int l = 0;
  static constexpr int n = 3;

  struct Configuration {
    Mat3 R;
  };
  struct Unknowns {
    Vec3 d;
  };
  // What the closure gives at the solution, and the rotation vector of the step.
  struct Solution {
    Vec3 change, velocity_change, scaled_acceleration, turn;
    Mat3 motion;  // exp(turn~)
  };

  KeptMatrix kept;
  Lu<n> lu;

  // q_n becomes q_{n+1}; false where the iteration fails.
  template <class Closure>
  bool solve(double h, Configuration& q, const Closure& closure, Unknowns& z, Solution& s) {
    double previous = 0.0;
    bool fresh = false, stalled = false;
    const double fixed_scale = 0.01 * max_norm(closure.base);
    if (kept.wants_refresh()) {
      if (!factorize(h, q.R, closure, z.d)) return false;
      fresh = true;
    }
    Next next = Next::iterate;
    for (int iteration = 1; next != Next::done; ++iteration) {
      const Vec3 d = z.d;
      const Vec3 turn = h * (closure.base + d);
      const Mat3 R = q.R * exp(turn);
      closure.evaluate(h, d, s);
      const Vec3 w = closure.velocity + s.velocity_change;
      const Vec3& a = s.scaled_acceleration;
      // J a + h (w x J w - X x R^T m gamma): only the third row of R is in it.
      const double g = top::weight * top::arm;
      const double r[n] = {top::tip1 * a.x + h * ((top::tip3 - top::tip2) * w.y * w.z - g * R.zz),
                           top::tip2 * a.y + h * ((top::tip1 - top::tip3) * w.z * w.x),
                           top::tip3 * a.z + h * ((top::tip2 - top::tip1) * w.x * w.y + g * R.zx)};
      double c[n];
      lu.solve(r, c);
      const Vec3 correction{c[0], c[1], c[2]};
      z.d = d - correction;
      const double size_of_d = max_norm(z.d);
      const double size = relative(max_norm(correction), fixed_scale + size_of_d);
      if (!std::isfinite(size) || size_of_d * h > 1e8) return false;
      next = kept.judge(size, iteration, previous, fresh, stalled);
      if (next == Next::fail) return false;
      if (next == Next::factorize) {
        if (!factorize(h, q.R, closure, d)) return false;
        fresh = true;
      }
    }
    s.change = z.d;
    s.turn = h * (closure.base + z.d);
    s.motion = exp(s.turn);
    q.R = q.R * s.motion;
    closure.evaluate(h, z.d, s);
    return true;
  }

 private:
  // J dv'/dd h + h C dv/dd + h^2 K T
  template <class Closure>
  [[gnu::noinline]] bool factorize(double h, const Mat3& R_n, const Closure& closure, const Vec3& d) {
    Solution s;
    closure.evaluate(h, d, s);
    const Vec3 w = closure.velocity + s.velocity_change;
    const Vec3 turn = h * (closure.base + d);
    const Mat3 R = R_n * exp(turn);
    const double g = top::weight * top::arm;
    const Mat3 J = diagonal(top::tip1, top::tip2, top::tip3);
    const Mat3 C{
        0.0, (top::tip3 - top::tip2) * w.z, (top::tip3 - top::tip2) * w.y, (top::tip1 - top::tip3) * w.z,
        0.0, (top::tip1 - top::tip3) * w.x, (top::tip2 - top::tip1) * w.y, (top::tip2 - top::tip1) * w.x,
        0.0};
    const Mat3 K{g * R.zy, -g * R.zx, 0.0, 0.0, 0.0, 0.0, 0.0, -g * R.zz, g * R.zy};
    const Mat3 A = J * closure.acceleration_derivative(h, d) + (h * C) * closure.velocity_derivative(h, d) +
                   (h * h) * (K * tangent(turn));
    kept.renewed(max_norm(A));
    lu.set(0, 0, A);
    return kept.factorized = lu.factorize();
  }
};

}  // namespace liebench::floors
