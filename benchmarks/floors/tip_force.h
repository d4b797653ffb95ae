#pragma once

#include "benchmarks/floors/lu.h"
#include "benchmarks/floors/rotation.h"
#include "benchmarks/floors/top.h"

// The force lambda that holds the tip of the constrained top on R^3 x SO(3), eq. (58), from an equation linear in it: with the
// mass matrix diagonal, one of three unknowns. B(q) = [ -R^T  -skew(y) ], y = R^T x.

namespace liebench::floors {

struct TipPoint {
  Vec3 x;
  Mat3 R;
  Vec3 y;
};
inline TipPoint at(const Vec3& x, const Mat3& R) {
  return {x, R, transposed_times(R, x)};
}

// B(q) v
inline Vec3 rate(const TipPoint& q, const Vec6& v) {
  return -1.0 * (transposed_times(q.R, v.x) + cross(q.y, v.w));
}
// Phi(q)
inline Vec3 violation(const TipPoint& q) {
  return {-q.y.x, top::arm - q.y.y, -q.y.z};
}
// -M^{-1} g: no force but gravity, and J Omega' = J Omega x Omega about the centre of mass.
inline Vec6 free_acceleration(const Vec6& v) {
  return {{0.0, 0.0, top::weight * (1.0 / top::mass)},
          {(top::J2 - top::J3) * v.w.y * v.w.z * (1.0 / top::J1),
           (top::J3 - top::J1) * v.w.z * v.w.x * (1.0 / top::J2),
           (top::J1 - top::J2) * v.w.x * v.w.y * (1.0 / top::J3)}};
}
inline Vec3 over_inertia(const Vec3& moment) {
  return {moment.x * (1.0 / top::J1), moment.y * (1.0 / top::J2), moment.z * (1.0 / top::J3)};
}
// a - M^{-1} B(q)^T lambda
inline Vec6 accelerated(const TipPoint& q, const Vec6& a, const Vec3& lambda) {
  return {a.x + (1.0 / top::mass) * (q.R * lambda), a.w - over_inertia(cross(q.y, lambda))};
}

// B(next) M^{-1} B(q)^T, factorized.
class TipForce {
 public:
  bool factorize(const TipPoint& q, const TipPoint& next) {
    const Vec3 &y = q.y, &z = next.y;
    // -skew(z) J^{-1} skew(y)
    const double a = 1.0 / top::J1, b = 1.0 / top::J2, c = 1.0 / top::J3;
    const Mat3 rotational{c * z.y * y.y + b * z.z * y.z, -c * z.y * y.x, -b * z.z * y.x, -c * z.x * y.y,
                          c * z.x * y.x + a * z.z * y.z, -a * z.z * y.y, -b * z.x * y.z, -a * z.y * y.z,
                          b * z.x * y.x + a * z.y * y.y};
    lu_.set(0, 0, (1.0 / top::mass) * (transposed(next.R) * q.R) + rotational);
    return lu_.factorize();
  }
  Vec3 solve(const Vec3& b) const {
    const double from[3] = {b.x, b.y, b.z};
    double to[3];
    lu_.solve(from, to);
    return {to[0], to[1], to[2]};
  }

 private:
  Lu<3> lu_;
};

}  // namespace liebench::floors
