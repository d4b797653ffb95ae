#pragma once

#include <algorithm>
#include <cmath>

#include "groups/rotation_coefficients.h"

// What the floors are made of: plain numbers in plain structs, and the few operations on them that a hand-written
// simulation of the heavy top needs.

namespace liebench::floors {

struct Vec3 {
  double x, y, z;
};

inline Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3 operator*(double s, const Vec3& a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline double max_norm(const Vec3& a) {
  return std::max(std::max(std::abs(a.x), std::abs(a.y)), std::abs(a.z));
}
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double squared_norm(const Vec3& a) {
  return a.x * a.x + a.y * a.y + a.z * a.z;
}

// A tangent vector of R^3 x SO(3): translation and rotation.
struct Vec6 {
  Vec3 x, w;
};

inline Vec6 operator+(const Vec6& a, const Vec6& b) {
  return {a.x + b.x, a.w + b.w};
}
inline Vec6 operator-(const Vec6& a, const Vec6& b) {
  return {a.x - b.x, a.w - b.w};
}
inline Vec6 operator*(double s, const Vec6& a) {
  return {s * a.x, s * a.w};
}
inline double max_norm(const Vec6& a) {
  return std::max(max_norm(a.x), max_norm(a.w));
}

struct Mat3 {
  double xx, xy, xz, yx, yy, yz, zx, zy, zz;
};

inline Mat3 operator+(const Mat3& a, const Mat3& b) {
  return {a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yx + b.yx, a.yy + b.yy,
          a.yz + b.yz, a.zx + b.zx, a.zy + b.zy, a.zz + b.zz};
}
inline Mat3 operator*(double s, const Mat3& a) {
  return {s * a.xx, s * a.xy, s * a.xz, s * a.yx, s * a.yy, s * a.yz, s * a.zx, s * a.zy, s * a.zz};
}
inline Mat3 operator*(const Mat3& a, double s) {
  return s * a;
}
inline Mat3 operator-(const Mat3& a, const Mat3& b) {
  return a + -1.0 * b;
}
inline Vec3 operator*(const Mat3& a, const Vec3& v) {
  return {a.xx * v.x + a.xy * v.y + a.xz * v.z, a.yx * v.x + a.yy * v.y + a.yz * v.z,
          a.zx * v.x + a.zy * v.y + a.zz * v.z};
}
[[gnu::always_inline]] inline Mat3 operator*(const Mat3& a, const Mat3& b) {
  return {a.xx * b.xx + a.xy * b.yx + a.xz * b.zx, a.xx * b.xy + a.xy * b.yy + a.xz * b.zy,
          a.xx * b.xz + a.xy * b.yz + a.xz * b.zz,  //
          a.yx * b.xx + a.yy * b.yx + a.yz * b.zx, a.yx * b.xy + a.yy * b.yy + a.yz * b.zy,
          a.yx * b.xz + a.yy * b.yz + a.yz * b.zz,  //
          a.zx * b.xx + a.zy * b.yx + a.zz * b.zx, a.zx * b.xy + a.zy * b.yy + a.zz * b.zy,
          a.zx * b.xz + a.zy * b.yz + a.zz * b.zz};
}
inline Mat3 transposed(const Mat3& a) {
  return {a.xx, a.yx, a.zx, a.xy, a.yy, a.zy, a.xz, a.yz, a.zz};
}
// a^T v
inline Vec3 transposed_times(const Mat3& a, const Vec3& v) {
  return {a.xx * v.x + a.yx * v.y + a.zx * v.z, a.xy * v.x + a.yy * v.y + a.zy * v.z,
          a.xz * v.x + a.yz * v.y + a.zz * v.z};
}
inline double max_norm(const Mat3& a) {
  return std::max({std::abs(a.xx), std::abs(a.xy), std::abs(a.xz), std::abs(a.yx), std::abs(a.yy),
                   std::abs(a.yz), std::abs(a.zx), std::abs(a.zy), std::abs(a.zz)});
}
// skew(v) w = v x w
inline Mat3 skew(const Vec3& v) {
  return {0.0, -v.z, v.y, v.z, 0.0, -v.x, -v.y, v.x, 0.0};
}
inline Mat3 diagonal(double a, double b, double c) {
  return {a, 0.0, 0.0, 0.0, b, 0.0, 0.0, 0.0, c};
}

// I + f skew(v) + g skew(v)^2
inline Mat3 skew_polynomial(const Vec3& v, double f, double g) {
  const double xx = v.x * v.x, yy = v.y * v.y, zz = v.z * v.z;
  const double gx = g * v.x, gy = g * v.y;
  const double xy = gx * v.y, xz = gx * v.z, yz = gy * v.z;
  const Vec3 s = f * v;
  return {1.0 - g * (yy + zz), xy - s.z, xz + s.y, xy + s.z,
          1.0 - g * (xx + zz), yz - s.x, xz - s.y, yz + s.x,
          1.0 - g * (xx + yy)};
}

// The coefficients of exp and T as functions of x^2: sin x / x, (1 - cos x) / x^2, (x - sin x) / x^3. The first nine
// terms of their series up to x = 1/2, as the groups have them; larger angles, which the benchmark never meets, by the
// groups' own functions.
struct Coefficients {
  double sinc, versine;
};

inline Coefficients exp_coefficients(double s) {
  if (!(s < 0.25)) {
    const auto [sinc, versine] = sinc_versine(s);
    return {sinc, versine};
  }
  constexpr double a[9] = {1.0,
                           -1.0 / 6,
                           1.0 / 120,
                           -1.0 / 5040,
                           1.0 / 362880,
                           -1.0 / 39916800,
                           1.0 / 6227020800,
                           -1.0 / 1307674368000,
                           1.0 / 355687428096000};
  constexpr double b[9] = {1.0 / 2,
                           -1.0 / 24,
                           1.0 / 720,
                           -1.0 / 40320,
                           1.0 / 3628800,
                           -1.0 / 479001600,
                           1.0 / 87178291200,
                           -1.0 / 20922789888000,
                           1.0 / 6402373705728000};
  double p = a[8], q = b[8];
  for (int i = 7; i >= 0; --i) {
    p = p * s + a[i];
    q = q * s + b[i];
  }
  return {p, q};
}

inline double tangent_coefficient(double s) {
  if (!(s < 0.25)) return sine_defect(s);
  constexpr double c[9] = {1.0 / 6,
                           -1.0 / 120,
                           1.0 / 5040,
                           -1.0 / 362880,
                           1.0 / 39916800,
                           -1.0 / 6227020800,
                           1.0 / 1307674368000,
                           -1.0 / 355687428096000,
                           1.0 / 121645100408832000};
  double p = c[8];
  for (int i = 7; i >= 0; --i) p = p * s + c[i];
  return p;
}

[[gnu::always_inline]] inline Mat3 exp(const Vec3& v) {
  const auto [sinc, versine] = exp_coefficients(squared_norm(v));
  return skew_polynomial(v, sinc, versine);
}

// T(v) = I - b skew(v) + c skew(v)^2
inline Mat3 tangent(const Vec3& v) {
  const double s = squared_norm(v);
  return skew_polynomial(v, -exp_coefficients(s).versine, tangent_coefficient(s));
}

// T^{-1}(v) w
inline Vec3 tangent_inverse_times(const Vec3& v, const Vec3& w) {
  const Vec3 once = cross(v, w);
  return w + 0.5 * once + cotangent_defect(squared_norm(v)) * cross(v, once);
}

}  // namespace liebench::floors
