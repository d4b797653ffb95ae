#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "benchmarks/floors/explicit_methods.h"
#include "integrators/faltinsen_adams.h"

namespace liebench::floors {

// The k-step Adams-Bashforth method of Faltinsen, Marthinsen & Munthe-Kaas, k >= 3: integrators/faltinsen_adams.h has the equations.
template <int k>
class FaltinsenAdams : public SO3Floor {
 public:
  static constexpr int starting_points = k;

  void start(double h, std::span<const SolutionPoint<System>> points) {
    SO3Floor::start(h, points.subspan(k - 1));
    for (std::size_t j = 0; j + 1 < std::size_t(k); ++j) {
      const Mat3 R = from_eigen(points[j].q);
      const Mat3 motion = transposed(R) * from_eigen(points[j + 1].q);
      const Vec3 v = from_eigen(points[j].v);
      keep(v, top_acceleration(R, v), log(motion), motion);
    }
  }

  [[gnu::flatten]] bool step() {
    const Vec3 F = top_acceleration(q_.R, v_);
    double turned = 0.0;
    for (const double angle : angles_) turned += angle;
    if (!(turned < std::numbers::pi)) return false;
    Vec3 u = weight(0) * v_ + weight(1) * tangent_inverse_times(-1.0 * last_step_, velocities_[0]);
    Vec3 change = weight(0) * F + weight(1) * accelerations_[0];
#pragma GCC unroll 8
    for (std::size_t i = 2; i < std::size_t(k); ++i) {
      u = u + weight(i) * tangent_inverse_times(-1.0 * log(motions_[i - 1]), velocities_[i - 1]);
      change = change + weight(i) * accelerations_[i - 1];
    }
    u = h_ * u;
    if (turns_too_far(u)) return false;
    const Mat3 motion = exp(u);
    const Vec3 v = v_;
    q_.R = q_.R * motion;
    v_ = v + h_ * change;
    if (!std::isfinite(max_norm(v_))) return false;
    t_ += h_;
    keep(v, F, u, motion);
    return true;
  }

 private:
  static constexpr std::size_t kept = std::size_t(k) - 1;

  static constexpr double weight(std::size_t i) {
    const Fraction& b = adams_bashforth[std::size_t(k) - 1][i];
    return double(b.numerator) / double(b.denominator);
  }
  void keep(const Vec3& v, const Vec3& F, const Vec3& step, const Mat3& motion) {
#pragma GCC unroll 8
    for (std::size_t i = kept - 1; i > 0; --i) {
      velocities_[i] = velocities_[i - 1];
      accelerations_[i] = accelerations_[i - 1];
      motions_[i] = motions_[i - 1] * motion;
      angles_[i] = angles_[i - 1];
    }
    velocities_[0] = v;
    accelerations_[0] = F;
    motions_[0] = motion;
    angles_[0] = std::sqrt(squared_norm(step));
    last_step_ = step;
  }

  std::array<Vec3, kept> velocities_{}, accelerations_{};
  std::array<Mat3, kept> motions_{};  // of the last i + 1 steps together
  std::array<double, kept> angles_{};
  Vec3 last_step_{};
};

}  // namespace liebench::floors
