#pragma once

#include <array>
#include <cstddef>

#include "benchmarks/floors/one_step.h"
#include "benchmarks/floors/top.h"
#include "integrators/runge_kutta_tableau.h"

// Steps of the top on SO(3), eq. (57), by explicit methods, by hand.

namespace liebench::floors {

// Omega' of the attitude R and the angular velocity w; only the third row of R is in it.
inline Vec3 top_acceleration(const Mat3& R, const Vec3& w) {
  constexpr double g = top::weight * top::arm;
  return {((top::tip2 - top::tip3) * w.y * w.z + g * R.zz) * (1.0 / top::tip1),
          (top::tip3 - top::tip1) * w.z * w.x * (1.0 / top::tip2),
          ((top::tip1 - top::tip2) * w.x * w.y - g * R.zx) * (1.0 / top::tip3)};
}

// RKMK with Kutta's tableau of order 4.
class Rk4 : public SO3Floor {
 public:
  bool step() {
    const double half = 0.5 * h_;
    const Vec3 F1 = top_acceleration(q_.R, v_);
    const Vec3 theta2 = half * v_, V2 = v_ + half * F1;
    if (turns_too_far(theta2)) return false;
    const Vec3 F2 = top_acceleration(q_.R * exp(theta2), V2), K2 = tangent_inverse_times(theta2, V2);
    const Vec3 theta3 = half * K2, V3 = v_ + half * F2;
    if (turns_too_far(theta3)) return false;
    const Vec3 F3 = top_acceleration(q_.R * exp(theta3), V3), K3 = tangent_inverse_times(theta3, V3);
    const Vec3 theta4 = h_ * K3, V4 = v_ + h_ * F3;
    if (turns_too_far(theta4)) return false;
    const Vec3 F4 = top_acceleration(q_.R * exp(theta4), V4), K4 = tangent_inverse_times(theta4, V4);
    const Vec3 theta = (h_ / 6.0) * (v_ + 2.0 * (K2 + K3) + K4);
    if (turns_too_far(theta)) return false;
    q_.R = q_.R * exp(theta);
    v_ = v_ + (h_ / 6.0) * (F1 + 2.0 * (F2 + F3) + F4);
    t_ += h_;
    return true;
  }
};

// RKMK with any tableau: loops over its stages, which the compiler unrolls.
template <const auto& tableau>
class MuntheKaas : public SO3Floor {
 public:
  [[gnu::flatten]] bool step() {
    constexpr std::size_t s = tableau.stages;
    std::array<Vec3, s> K, F;
    K[0] = v_;
    F[0] = top_acceleration(q_.R, v_);
#pragma GCC unroll 8
    for (std::size_t i = 1; i < s; ++i) {
      const Vec3 theta = sum(i, i, K), V = v_ + sum(i, i, F);
      if (turns_too_far(theta)) return false;
      F[i] = top_acceleration(q_.R * exp(theta), V);
      K[i] = tangent_inverse_times(theta, V);
    }
    const Vec3 theta = sum(s, s, K);
    if (turns_too_far(theta)) return false;
    q_.R = q_.R * exp(theta);
    v_ = v_ + sum(s, s, F);
    t_ += h_;
    return true;
  }

 private:
  [[gnu::always_inline]] Vec3 sum(std::size_t row, std::size_t count,
                                  const std::array<Vec3, tableau.stages>& slopes) const {
    Vec3 result{0.0, 0.0, 0.0};
#pragma GCC unroll 8
    for (std::size_t j = 0; j < count; ++j)
      if (const Fraction& w = tableau.row(row)[j]; w.numerator != 0)
        result = result + (double(w.numerator) / double(w.denominator)) * slopes[j];
    return h_ * result;
  }
};

// Commutator-free CF4.
class Cf4 : public SO3Floor {
 public:
  bool step() {
    const double half = 0.5 * h_;
    const Vec3 F1 = top_acceleration(q_.R, v_);
    const Vec3 theta2 = half * v_, v2 = v_ + half * F1;
    if (turns_too_far(theta2)) return false;
    const Mat3 R2 = q_.R * exp(theta2);
    const Vec3 F2 = top_acceleration(R2, v2);
    const Vec3 theta3 = half * v2, v3 = v_ + half * F2;
    if (turns_too_far(theta3)) return false;
    const Vec3 F3 = top_acceleration(q_.R * exp(theta3), v3);
    const Vec3 theta4 = h_ * v3 - theta2, v4 = v_ + h_ * F3;
    if (turns_too_far(theta4)) return false;
    const Vec3 F4 = top_acceleration(R2 * exp(theta4), v4);
    const Vec3 middle = 2.0 * (v2 + v3);
    const Vec3 first = (h_ / 12.0) * (3.0 * v_ + middle - v4);
    const Vec3 second = (h_ / 12.0) * (middle - v_ + 3.0 * v4);
    if (turns_too_far(first + second)) return false;
    q_.R = (q_.R * exp(first)) * exp(second);
    v_ = v_ + (h_ / 6.0) * (F1 + 2.0 * (F2 + F3) + F4);
    t_ += h_;
    return true;
  }
};

// Crouch & Grossman's method of order 3.
class Cg3 : public SO3Floor {
 public:
  bool step() {
    const Vec3 F1 = top_acceleration(q_.R, v_);
    const Vec3 turn2 = (3.0 / 4 * h_) * v_;
    if (turns_too_far(turn2)) return false;
    const Vec3 v2 = v_ + (3.0 / 4 * h_) * F1;
    const Vec3 F2 = top_acceleration(q_.R * exp(turn2), v2);
    const Vec3 turn31 = (119.0 / 216 * h_) * v_, turn32 = (17.0 / 108 * h_) * v2;
    if (turns_too_far(turn31) || turns_too_far(turn32)) return false;
    const Vec3 v3 = v_ + h_ * (119.0 / 216 * F1 + 17.0 / 108 * F2);
    const Vec3 F3 = top_acceleration((q_.R * exp(turn31)) * exp(turn32), v3);
    const Vec3 a = (13.0 / 51 * h_) * v_, b = (-2.0 / 3 * h_) * v2, c = (24.0 / 17 * h_) * v3;
    if (turns_too_far(a + b + c) || turns_too_far(a) || turns_too_far(b) || turns_too_far(c)) return false;
    q_.R = ((q_.R * exp(a)) * exp(b)) * exp(c);
    v_ = v_ + h_ * (13.0 / 51 * F1 + -2.0 / 3 * F2 + 24.0 / 17 * F3);
    t_ += h_;
    return true;
  }
};

}  // namespace liebench::floors
