#pragma once

#include "benchmarks/floors/kept_matrix.h"
#include "benchmarks/floors/lu.h"
#include "benchmarks/floors/rotation.h"
#include "benchmarks/floors/top.h"
#include "problems/heavy_top.h"

// One step of the constrained top on R^3 x SO(3), eq. (58), index 3, by hand: unknowns (d, h lambda), residual
// (h r, Phi / h).

namespace liebench::floors {

struct Index3Top {
  using System = HeavyTopR3xSO3<double>;
  using Vector = Vec6;
  static constexpr int l = 3;
  static constexpr int n = 9;

  struct Configuration {
    Vec3 x;
    Mat3 R;
  };
  struct Unknowns {
    Vec6 d;
    Vec3 scaled_lambda;
  };
  struct Solution {
    Vec6 change, velocity_change, scaled_acceleration;
    Vec3 turn;
    Mat3 motion;  // exp(turn~)
  };

  KeptMatrix kept;
  Lu<n> lu;

  template <class Closure>
  bool solve(double h, Configuration& q, const Closure& closure, Unknowns& z, Solution& s) {
    double previous = 0.0;
    bool fresh = false, stalled = false;
    const double inverse_h = 1.0 / h;
    const double fixed_scale =
        0.01 * max_norm(closure.base) + std::max(max_norm(q.x), max_norm(q.R)) * inverse_h;
    if (kept.wants_refresh()) {
      if (!factorize(h, q, closure, z.d, z.scaled_lambda)) return false;
      fresh = true;
    }
    Next next = Next::iterate;
    for (int iteration = 1; next != Next::done; ++iteration) {
      const Vec6 d = z.d;
      const Vec6 step = h * (closure.base + d);
      const Vec3 x = q.x + step.x;
      const Mat3 R = q.R * exp(step.w);
      closure.evaluate(h, d, s);
      const Vec3 w = closure.velocity.w + s.velocity_change.w;
      const Vec6& a = s.scaled_acceleration;
      const Vec3 force = R * z.scaled_lambda;
      const Vec3 y = transposed_times(R, x);
      const Vec3 moment = cross(y, z.scaled_lambda);
      const double r[n] = {
          top::mass * a.x.x - force.x,
          top::mass * a.x.y - force.y,
          top::mass * a.x.z - h * top::weight - force.z,
          top::J1 * a.w.x + h * ((top::J3 - top::J2) * w.y * w.z) + moment.x,
          top::J2 * a.w.y + h * ((top::J1 - top::J3) * w.z * w.x) + moment.y,
          top::J3 * a.w.z + h * ((top::J2 - top::J1) * w.x * w.y) + moment.z,
          -y.x * inverse_h,
          (top::arm - y.y) * inverse_h,
          -y.z * inverse_h,
      };
      double c[n];
      lu.solve(r, c);
      const Vec6 correction{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}};
      const Vec3 of_lambda{c[6], c[7], c[8]};
      z.d = d - correction;
      z.scaled_lambda = z.scaled_lambda - of_lambda;
      const double size_of_d = max_norm(z.d);
      const double scale = fixed_scale + size_of_d;
      const double size =
          std::max(relative(max_norm(correction), scale),
                   relative(max_norm(of_lambda), max_norm(z.scaled_lambda) + kept.mass_scale * scale));
      if (!std::isfinite(size) || size_of_d * h > 1e8) return false;
      next = kept.judge(size, iteration, previous, fresh, stalled);
      if (next == Next::fail) return false;
      if (next == Next::factorize) {
        if (!factorize(h, q, closure, d, z.scaled_lambda)) return false;
        fresh = true;
      }
    }
    s.change = z.d;
    const Vec6 step = h * (closure.base + z.d);
    s.turn = step.w;
    q.x = q.x + step.x;
    s.motion = exp(step.w);
    q.R = q.R * s.motion;
    closure.evaluate(h, z.d, s);
    return true;
  }

 private:
  // [ h M dv'/dd + h C dv/dd + h^2 K T    B^T ]
  // [ B T                                  0  ]
  template <class Closure>
  [[gnu::noinline]] bool factorize(double h, const Configuration& q, const Closure& closure, const Vec6& d,
                                   const Vec3& scaled_lambda) {
    Solution s;
    closure.evaluate(h, d, s);
    const Vec3 w = closure.velocity.w + s.velocity_change.w;
    const Vec6 step = h * (closure.base + d);
    const Mat3 R = q.R * exp(step.w);
    const Vec3 y = transposed_times(R, q.x + step.x);
    const Mat3 T = tangent(step.w);
    const Mat3 L = skew(scaled_lambda), Rt = transposed(R), Y = skew(y);
    const Mat3 inertial = top::rotational_inertia(h, w, closure, d);
    const double translational = top::mass * closure.acceleration_slope;
    const Mat3 upper = h * (R * L * T), lower = -h * (L * Rt), rotational = inertial - h * (L * Y * T);
    lu.set(0, 0, diagonal(translational, translational, translational));
    lu.set(0, 3, upper);
    lu.set(3, 0, lower);
    lu.set(3, 3, rotational);
    lu.set(0, 6, -1.0 * R);
    lu.set(3, 6, Y);
    lu.set(6, 0, -1.0 * Rt);
    lu.set(6, 3, -1.0 * (Y * T));
    lu.set(6, 6, diagonal(0.0, 0.0, 0.0));
    kept.renewed(std::max({std::abs(translational), max_norm(upper), max_norm(lower), max_norm(rotational)}));
    return kept.factorized = lu.factorize();
  }
};

}  // namespace liebench::floors
