#pragma once

#include "benchmarks/floors/kept_matrix.h"
#include "benchmarks/floors/lu.h"
#include "benchmarks/floors/rotation.h"
#include "benchmarks/floors/top.h"
#include "problems/heavy_top.h"

// One step of the constrained top on R^3 x SO(3) in stabilized index-2 form by hand: unknowns (d, h lambda, eta), residual
// (h r, Phi / h, B v).

namespace liebench::floors {

struct StabilizedTop {
  using System = HeavyTopR3xSO3<double>;
  using Vector = Vec6;
  static constexpr int l = 3;
  static constexpr int n = 12;

  struct Configuration {
    Vec3 x;
    Mat3 R;
  };
  struct Unknowns {
    Vec6 d;
    Vec3 scaled_lambda, eta;
  };
  struct Solution {
    Vec6 change;  // d + B(q_n)^T eta
    Vec6 velocity_change, scaled_acceleration;
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
    const Vec3 y_n = transposed_times(q.R, q.x);
    const double fixed_scale =
        0.01 * max_norm(closure.base) + std::max(max_norm(q.x), max_norm(q.R)) * inverse_h;
    if (kept.wants_refresh()) {
      if (!factorize(h, q, y_n, closure, z.d, z.scaled_lambda, z.eta)) return false;
      fresh = true;
    }
    Next next = Next::iterate;
    for (int iteration = 1; next != Next::done; ++iteration) {
      const Vec6 d = z.d;
      const Vec3 eta = z.eta;
      const Vec6 step = h * (closure.base + d);
      const Vec3 x = q.x + step.x;
      const Mat3 R = q.R * exp(step.w);
      closure.evaluate(h, stabilized(q.R, y_n, d, eta), s);
      const Vec6 v = closure.velocity + s.velocity_change;
      const Vec3& w = v.w;
      const Vec6& a = s.scaled_acceleration;
      const Vec3 force = R * z.scaled_lambda;
      const Vec3 y = transposed_times(R, x);
      const Vec3 moment = cross(y, z.scaled_lambda);
      const Vec3 u_B = transposed_times(R, v.x), swept = cross(y, w);
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
          -u_B.x - swept.x,
          -u_B.y - swept.y,
          -u_B.z - swept.z,
      };
      double c[n];
      lu.solve(r, c);
      const Vec6 correction{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}};
      const Vec3 of_lambda{c[6], c[7], c[8]}, of_eta{c[9], c[10], c[11]};
      z.d = d - correction;
      z.scaled_lambda = z.scaled_lambda - of_lambda;
      z.eta = eta - of_eta;
      const double size_of_d = max_norm(z.d);
      const double scale = fixed_scale + size_of_d;
      const double size =
          std::max(relative(std::max(max_norm(correction), max_norm(of_eta)), scale),
                   relative(max_norm(of_lambda), max_norm(z.scaled_lambda) + kept.mass_scale * scale));
      if (!std::isfinite(size) || size_of_d * h > 1e8) return false;
      next = kept.judge(size, iteration, previous, fresh, stalled);
      if (next == Next::fail) return false;
      if (next == Next::factorize) {
        if (!factorize(h, q, y_n, closure, d, z.scaled_lambda, eta)) return false;
        fresh = true;
      }
    }
    s.change = stabilized(q.R, y_n, z.d, z.eta);
    const Vec6 step = h * (closure.base + z.d);
    s.turn = step.w;
    q.x = q.x + step.x;
    s.motion = exp(step.w);
    q.R = q.R * s.motion;
    closure.evaluate(h, s.change, s);
    return true;
  }

 private:
  // d + B(q_n)^T eta
  static Vec6 stabilized(const Mat3& R_n, const Vec3& y_n, const Vec6& d, const Vec3& eta) {
    return {d.x - R_n * eta, d.w + cross(y_n, eta)};
  }

  // [ M* + h^2 K T      B^T   M* B_n^T      ]    M* = h M dv'/dd + h C dv/dd
  // [ B T                0     0            ]
  // [ dv/dd B + h Z T    0    dv/dd B B_n^T ]
  template <class Closure>
  [[gnu::noinline]] bool factorize(double h, const Configuration& q, const Vec3& y_n, const Closure& closure,
                                   const Vec6& d, const Vec3& scaled_lambda, const Vec3& eta) {
    Solution s;
    const Vec6 change = stabilized(q.R, y_n, d, eta);
    closure.evaluate(h, change, s);
    const Vec6 v = closure.velocity + s.velocity_change;
    const Vec6 step = h * (closure.base + d);
    const Mat3 R = q.R * exp(step.w);
    const Vec3 y = transposed_times(R, q.x + step.x);
    const Mat3 T = tangent(step.w);
    const Mat3 L = skew(scaled_lambda), Rt = transposed(R), Y = skew(y), Y_n = skew(y_n), W = skew(v.w);
    const Mat3 inertial = top::rotational_inertia(h, v.w, closure, change);
    const double slope = closure.velocity_slope;
    const double translational = top::mass * closure.acceleration_slope;
    const Mat3 upper = h * (R * L * T), lower = -h * (L * Rt), rotational = inertial - h * (L * Y * T);
    const Mat3 swept = -1.0 * (Y * closure.velocity_derivative(h, change));
    const Mat3 nothing = diagonal(0.0, 0.0, 0.0);
    lu.set(0, 0, diagonal(translational, translational, translational));
    lu.set(0, 3, upper);
    lu.set(3, 0, lower);
    lu.set(3, 3, rotational);
    lu.set(0, 6, -1.0 * R);
    lu.set(3, 6, Y);
    lu.set(6, 0, -1.0 * Rt);
    lu.set(6, 3, -1.0 * (Y * T));
    lu.set(6, 6, nothing);
    lu.set(0, 9, -translational * q.R);
    lu.set(3, 9, inertial * Y_n);
    lu.set(6, 9, nothing);
    lu.set(9, 6, nothing);
    lu.set(9, 0, h * (W * Rt) - slope * Rt);
    lu.set(9, 3, swept + h * ((W * Y - skew(transposed_times(R, v.x))) * T));
    lu.set(9, 9, slope * (Rt * q.R) + swept * Y_n);
    kept.renewed(std::max({std::abs(translational), max_norm(upper), max_norm(lower), max_norm(rotational)}));
    return kept.factorized = lu.factorize();
  }
};

}  // namespace liebench::floors
