#pragma once

#include <algorithm>
#include <cmath>

#include "benchmarks/floors/floor.h"
#include "benchmarks/floors/kept_matrix.h"
#include "benchmarks/floors/lu.h"
#include "benchmarks/floors/tip_force.h"
#include "benchmarks/floors/top.h"

// The equation of a step that balances the momentum of the top, by hand: integrators/momentum_equation.h has it,
//
//   M d + known + (W(-h Dq)^T - I) M Dq + B(q_n)^T mu = 0,   Phi(q_{n+1}) / h = 0,   Dq = base + d
//
// What is special to the top: its mass matrix is diagonal, only rotations are transported, and no force but the gyroscopic one,
// which is in the transport, depends on its velocity.

namespace liebench::floors {

// (W(u)^T - I) p = even - odd, (W(-u)^T - I) p = even + odd
struct Transported {
  Vec3 even, odd;
};
// W(u) = T(u)^{-1}
struct VariationalTransport {
  static Transported of(const Vec3& u, const Vec3& p) {
    const Vec3 once = cross(u, p);
    return {cotangent_defect(squared_norm(u)) * cross(u, once), 0.5 * once};
  }
};
// W(u) = Ad(exp(u~ / 2))
struct AdjointTransport {
  static Transported of(const Vec3& u, const Vec3& p) {
    const Vec3 half = 0.5 * u, once = cross(half, p);
    const auto [sinc, versine] = exp_coefficients(squared_norm(half));
    return {versine * cross(half, once), sinc * once};
  }
};

inline Vec3 about_tip(const Vec3& w) {
  return {top::tip1 * w.x, top::tip2 * w.y, top::tip3 * w.z};
}
inline Vec3 over_tip_inertia(const Vec3& p) {
  return {p.x * (1.0 / top::tip1), p.y * (1.0 / top::tip2), p.z * (1.0 / top::tip3)};
}
inline Vec3 about_center(const Vec3& w) {
  return {top::J1 * w.x, top::J2 * w.y, top::J3 * w.z};
}
// f, the moment of the weight about the tip with its sign turned.
inline Vec3 tip_force(const Mat3& R) {
  constexpr double g = top::weight * top::arm;
  return {-g * R.zz, 0.0, g * R.zx};
}

// On SO(3), eq. (57): unknown d. The configuration is in no equation.
template <class Transport>
struct SO3MomentumTop {
  struct Equation {
    Vec3 base, momentum, known;  // momentum: M base
  };
  struct Solution {
    Vec3 velocity, momentum, turn;  // Dq, M Dq, h Dq
    Transported transported;
  };

  KeptMatrix kept;
  Lu<3> lu;

  // `d`: the prediction, and the solution.
  bool solve(double h, const Equation& e, Vec3& d, Solution& s) {
    double previous = 0.0;
    bool fresh = false, stalled = false;
    const double fixed_scale = 0.01 * max_norm(e.base);
    if (kept.wants_refresh()) {
      if (!factorize(h, e.base + d)) return false;
      fresh = true;
    }
    Next next = Next::iterate;
    for (int iteration = 1; next != Next::done; ++iteration) {
      const Vec3 before = d, change = about_tip(d);
      const auto [even, odd] = Transport::of(h * (e.base + d), e.momentum + change);
      const Vec3 balance = change + e.known + (even + odd);
      const double r[3] = {balance.x, balance.y, balance.z};
      double c[3];
      lu.solve(r, c);
      const Vec3 correction{c[0], c[1], c[2]};
      d = d - correction;
      const double size_of_d = max_norm(d);
      const double size = relative(max_norm(correction), fixed_scale + size_of_d);
      if (!std::isfinite(size) || size_of_d * h > 1e8) return false;
      next = kept.judge(size, iteration, previous, fresh, stalled);
      if (next == Next::fail) return false;
      if (next == Next::factorize) {
        if (!factorize(h, e.base + before)) return false;
        fresh = true;
      }
    }
    s.velocity = e.base + d;
    s.momentum = e.momentum + about_tip(d);
    s.turn = h * s.velocity;
    s.transported = Transport::of(s.turn, s.momentum);
    return !turns_too_far(s.turn);
  }

 private:
  // M + h C / 2
  [[gnu::noinline]] bool factorize(double h, const Vec3& w) {
    const double s = 0.5 * h;
    const Mat3 A{top::tip1,
                 s * (top::tip3 - top::tip2) * w.z,
                 s * (top::tip3 - top::tip2) * w.y,
                 s * (top::tip1 - top::tip3) * w.z,
                 top::tip2,
                 s * (top::tip1 - top::tip3) * w.x,
                 s * (top::tip2 - top::tip1) * w.y,
                 s * (top::tip2 - top::tip1) * w.x,
                 top::tip3};
    kept.renewed(max_norm(A));
    lu.set(0, 0, A);
    return kept.factorized = lu.factorize();
  }
};

// The constrained top on R^3 x SO(3), eq. (58), variational: unknowns (d, mu).
struct R3xSO3MomentumTop {
  struct Equation {
    Vec6 base;
    Vec3 momentum;  // of the rotation: J base
    Vec6 known;
  };
  struct Unknowns {
    Vec6 d;
    Vec3 impulse;
  };
  struct Solution {
    Unknowns z;
    TipPoint q;  // q_{n+1}
    Vec6 velocity;
    Vec3 momentum;
    Transported transported;
  };

  KeptMatrix kept;
  Lu<9> lu;

  // `s.z`: the prediction, and the solution.
  bool solve(double h, const TipPoint& q, const Equation& e, Solution& s) {
    double previous = 0.0;
    bool fresh = false, stalled = false;
    const double inverse_h = 1.0 / h;
    const double fixed_scale = 0.01 * max_norm(e.base) + std::max(max_norm(q.x), max_norm(q.R)) * inverse_h;
    Unknowns& z = s.z;
    if (kept.wants_refresh()) {
      if (!factorize(h, q, e.base + z.d)) return false;
      fresh = true;
    }
    Next next = Next::iterate;
    for (int iteration = 1; next != Next::done; ++iteration) {
      const Vec6 d = z.d, step = h * (e.base + d);
      const Vec3 x = q.x + step.x, y = transposed_times(q.R * exp(step.w), x);
      const Vec3 change = about_center(d.w);
      const auto [even, odd] = VariationalTransport::of(step.w, e.momentum + change);
      const Vec3 force = q.R * z.impulse;
      const Vec3 balance = change + e.known.w + (even + odd) + cross(q.y, z.impulse);
      const double r[9] = {top::mass * d.x.x + e.known.x.x - force.x,
                           top::mass * d.x.y + e.known.x.y - force.y,
                           top::mass * d.x.z + e.known.x.z - force.z,
                           balance.x,
                           balance.y,
                           balance.z,
                           -y.x * inverse_h,
                           (top::arm - y.y) * inverse_h,
                           -y.z * inverse_h};
      double c[9];
      lu.solve(r, c);
      const Vec6 correction{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}};
      const Vec3 of_impulse{c[6], c[7], c[8]};
      z.d = d - correction;
      z.impulse = z.impulse - of_impulse;
      const double size_of_d = max_norm(z.d);
      const double scale = fixed_scale + size_of_d;
      const double size =
          std::max(relative(max_norm(correction), scale),
                   relative(max_norm(of_impulse), max_norm(z.impulse) + kept.mass_scale * scale));
      if (!std::isfinite(size) || size_of_d * h > 1e8) return false;
      next = kept.judge(size, iteration, previous, fresh, stalled);
      if (next == Next::fail) return false;
      if (next == Next::factorize) {
        if (!factorize(h, q, e.base + d)) return false;
        fresh = true;
      }
    }
    s.velocity = e.base + z.d;
    s.momentum = e.momentum + about_center(z.d.w);
    const Vec6 step = h * s.velocity;
    s.q = at(q.x + step.x, q.R * exp(step.w));
    s.transported = VariationalTransport::of(step.w, s.momentum);
    return !turns_too_far(step.w);
  }

 private:
  // [ M + h C / 2    B(q_n)^T ]
  // [ B T(h Dq)      0        ]
  [[gnu::noinline]] bool factorize(double h, const TipPoint& q, const Vec6& v) {
    const Vec6 step = h * v;
    const TipPoint end = at(q.x + step.x, q.R * exp(step.w));
    const double s = 0.5 * h;
    const Vec3& w = v.w;
    const Mat3 rotational{
        top::J1, s * (top::J3 - top::J2) * w.z, s * (top::J3 - top::J2) * w.y, s * (top::J1 - top::J3) * w.z,
        top::J2, s * (top::J1 - top::J3) * w.x, s * (top::J2 - top::J1) * w.y, s * (top::J2 - top::J1) * w.x,
        top::J3};
    const Mat3 nothing = diagonal(0.0, 0.0, 0.0);
    lu.set(0, 0, diagonal(top::mass, top::mass, top::mass));
    lu.set(0, 3, nothing);
    lu.set(3, 0, nothing);
    lu.set(3, 3, rotational);
    lu.set(0, 6, -1.0 * q.R);
    lu.set(3, 6, skew(q.y));
    lu.set(6, 0, -1.0 * transposed(end.R));
    lu.set(6, 3, -1.0 * (skew(end.y) * tangent(step.w)));
    lu.set(6, 6, nothing);
    kept.renewed(std::max(top::mass, max_norm(rotational)));
    return kept.factorized = lu.factorize();
  }
};

}  // namespace liebench::floors
