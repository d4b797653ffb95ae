#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "benchmarks/floors/explicit_methods.h"
#include "integrators/step_control.h"

namespace liebench::floors {

// Root mean square of the errors of theta and v in units of the tolerance, of v relative to 1 + |v_i|: 2 m of them.
inline double squared_error(const Vec3& of_theta, const Vec3& of_v, const Vec3& v, double inverse_tolerance) {
  const auto scaled = [&](double e, double value) { return e * inverse_tolerance / (1.0 + std::abs(value)); };
  return squared_norm(inverse_tolerance * of_theta) +
         squared_norm(Vec3{scaled(of_v.x, v.x), scaled(of_v.y, v.y), scaled(of_v.z, v.z)});
}
inline double scaled_error(const Vec3& of_theta, const Vec3& of_v, const Vec3& v, double inverse_tolerance) {
  return std::sqrt(squared_error(of_theta, of_v, v, inverse_tolerance) / 6.0);
}
inline double scaled_error(const Vec6& of_theta, const Vec6& of_v, const Vec6& v, double inverse_tolerance) {
  return std::sqrt((squared_error(of_theta.x, of_v.x, v.x, inverse_tolerance) +
                    squared_error(of_theta.w, of_v.w, v.w, inverse_tolerance)) /
                   12.0);
}

// The pair of Dormand & Prince with steps by a tolerance. The rules of the step size are those of the method itself
// (integrators/step_control.h), which know plain numbers only.
class RkmkVariable : public SO3Floor {
 public:
  void start(double length, std::span<const SolutionPoint<System>> points) {
    SO3Floor::start(length, points);
    t_end_ = t_ + length;
    acceleration_ = top_acceleration(q_.R, v_);
    const double v = std::sqrt(squared_norm(v_)), a = std::sqrt(squared_norm(acceleration_));
    h_ = std::min(0.1 * std::pow(tolerance, 0.2) / (v + a / (1.0 + v)), length);
  }
  bool finished() const { return t_ == t_end_; }
  long rejections() const { return rejections_; }

  [[gnu::flatten]] bool step() {
    constexpr const auto& tableau = dormand_prince_pair;
    constexpr std::size_t s = tableau.stages;
    for (;;) {
      const double left = t_end_ - t_;
      const bool last = !(h_ < left);
      const double h = last ? left : h_;
      if (!last && t_ + h == t_) return false;
      std::array<Vec3, s> K, F;
      K[0] = v_;
      F[0] = acceleration_;
      Mat3 R = q_.R;
      Vec3 V = v_;
      bool turns = false;
#pragma GCC unroll 8
      for (std::size_t i = 1; i < s && !turns; ++i) {
        const Vec3 theta = h * sum(i, i, K);
        V = v_ + h * sum(i, i, F);
        turns = turns_too_far(theta);
        R = q_.R * exp(theta);
        F[i] = top_acceleration(R, V);
        K[i] = tangent_inverse_times(theta, V);
      }
      if (turns) {
        control_.fail();
      } else if (control_.accept(scaled_error(h * sum(s, s, K), h * sum(s, s, F), V, 1.0 / tolerance))) {
        q_.R = R;
        v_ = V;
        acceleration_ = F[s - 1];
        t_ = last ? t_end_ : t_ + h;
        h_ = h * control_.factor();
        return true;
      }
      ++rejections_;
      h_ = h * control_.factor();
    }
  }

 private:
  static constexpr double tolerance = 1e-6;

  [[gnu::always_inline]] static Vec3 sum(std::size_t row, std::size_t count,
                                         const std::array<Vec3, 7>& slopes) {
    Vec3 result{0.0, 0.0, 0.0};
#pragma GCC unroll 8
    for (std::size_t j = 0; j < count; ++j)
      if (const Fraction& w = dormand_prince_pair.row(row)[j]; w.numerator != 0)
        result = result + (double(w.numerator) / double(w.denominator)) * slopes[j];
    return result;
  }

  StepControl control_{5};
  double t_end_ = 0.0;
  long rejections_ = 0;
  Vec3 acceleration_{};
};

}  // namespace liebench::floors
