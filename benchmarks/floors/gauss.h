#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "benchmarks/floors/explicit_methods.h"
#include "benchmarks/floors/kept_matrix.h"
#include "integrators/dense_inverse.h"
#include "integrators/gauss_coefficients.h"

namespace liebench::floors {

// Gauss collocation with `stages` stages for the top on SO(3), by hand: integrators/gauss.h has the equations, the iteration and the
// rules by which it ends. The two matrices are those of that iteration, dF/dv written out.
template <int stages>
class Gauss : public SO3Floor {
 public:
  void start(double h, std::span<const SolutionPoint<System>> points) {
    SO3Floor::start(h, points);
    const GaussCoefficients<double> all(stages);
    for (std::size_t i = 0; i < s; ++i) {
      b_[i] = all.b[i];
      delay_[i] = (all.c[i] - 0.5) * h;
      for (std::size_t j = 0; j < s; ++j) {
        a_[i][j] = h * all.a[i][j];
        centred_[i][j] = h * all.centred[i][j];
        next_[i][j] = all.extrapolation[i][j];
      }
      F_[i] = from_eigen(points[0].acceleration);
    }
  }

  [[gnu::flatten]] bool step() {
    if (turns_too_far(h_ * v_)) return false;
    bool fresh = !formed_ || (steps_ > 0 && last_ * steps_ > turns_);
    if (fresh && !form()) return false;
    const Stages before = F_;
    for (bool converged = false; !converged;) {
      predict(before);
      converged = iterate();
      if (!converged) {
        if (fresh || !form()) return false;
        fresh = true;
      }
    }
    const Vec3 turn = 2.0 * turn_;
    if (turns_too_far(turn)) return false;
    // Summed with what the sum rounded away before.
    const Vec3 corrected = h_ * sum(b_, F_) + rounding_;
    const Vec3 v = v_ + corrected;
    rounding_ = corrected - (v - v_);
    v_ = v;
    q_.R = q_.R * exp(turn);
    t_ += h_;
    first_ = false;
    return true;
  }

  // The general stepper counts the matrices, and no turns of the iteration.
  const KeptMatrix& kept() const { return count_; }

 private:
  static constexpr std::size_t s = std::size_t(stages), n = 3 * s;
  using Stages = std::array<Vec3, s>;
  using Row = std::array<double, s>;
  using Matrix = std::array<double, n * n>;  // column by column

  static Vec3 sum(const Row& weights, const Stages& x) {
    Vec3 result = weights[0] * x[0];
#pragma GCC unroll 8
    for (std::size_t j = 1; j < s; ++j) result = result + weights[j] * x[j];
    return result;
  }

  // F_i as the collocation polynomial of the last step goes on, V_i, and K_i from V_i.
  void predict(const Stages& before) {
    F_ = before;
    if (!first_)
      for (std::size_t i = 0; i < s; ++i) F_[i] = sum(next_[i], before);
    put_velocities();
    K_ = V_;
    put_angles();
  }
  void put_velocities() {
    for (std::size_t i = 0; i < s; ++i) V_[i] = v_ + sum(a_[i], F_);
  }
  void put_angles() {
    turn_ = (0.5 * h_) * sum(b_, K_);
    for (std::size_t i = 0; i < s; ++i) Theta_[i] = sum(centred_[i], K_);
  }

  bool iterate() {
    correct_kinematics();
    double previous = 0.0;
    bool stalled = false;
    for (int turn = 1; turn <= 100; ++turn) {
      const Mat3 middle = q_.R * exp(turn_);
      Stages residual;
      for (std::size_t i = 0; i < s; ++i)
        residual[i] = top_acceleration(middle * exp(Theta_[i]), V_[i]) - F_[i];
      double change = h_ * add_correction(velocity_inverse_, residual, F_);
      put_velocities();
      correct_kinematics();
      change = std::max(change, correct_kinematics());

      double scale = 0.0;
      for (const Vec3& K : K_) scale = std::max(scale, max_norm(K));
      if (!std::isfinite(change) || !std::isfinite(scale)) return false;
      const double size = relative(change, scale);
      const double rate = turn > 1 ? std::max(size, 1.0) / previous : rate_;
      if (size <= 0.05 || rate * size <= 0.05) {
        rate_ = steps_ == 0 ? 1.0 : std::min(1.0, 2.0 * rate);
        return finish(turn);
      }
      if (turn > 1 && rate > 0.5) {
        if (size <= 32.0) return finish(turn);
        if (stalled && rate > 1.0) return false;
        stalled = true;
      } else {
        stalled = false;
      }
      previous = size;
    }
    return false;
  }
  double correct_kinematics() {
    Stages residual;
    for (std::size_t i = 0; i < s; ++i) residual[i] = tangent_inverse_times(Theta_[i], V_[i]) - K_[i];
    const double change = add_correction(kinematic_inverse_, residual, K_);
    put_angles();
    return change;
  }
  // x += inverse residual; the largest entry of it.
  static double add_correction(const Matrix& inverse, const Stages& residual, Stages& x) {
    double r[n], to[n] = {};
    for (std::size_t i = 0; i < s; ++i) {
      r[3 * i] = residual[i].x;
      r[3 * i + 1] = residual[i].y;
      r[3 * i + 2] = residual[i].z;
    }
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i) to[i] += inverse[j * n + i] * r[j];
    double largest = 0.0;
    for (std::size_t i = 0; i < s; ++i) {
      const Vec3 correction{to[3 * i], to[3 * i + 1], to[3 * i + 2]};
      largest = std::max(largest, max_norm(correction));
      x[i] = x[i] + correction;
    }
    return largest;
  }
  bool finish(int turn) {
    turns_ += turn;
    ++steps_;
    last_ = turn;
    return true;
  }

  // I - h A (x) dF/dv, and I + h A_centred (x) (skew(v) / 2 + tau skew(v)^2 / 12), inverted.
  [[gnu::noinline, gnu::cold]] bool form() {
    formed_ = true;
    rate_ = 1.0;
    turns_ = 0.5 * double(n);
    steps_ = 0;
    last_ = 0;
    constexpr double k1 = (top::tip2 - top::tip3) / top::tip1, k2 = (top::tip3 - top::tip1) / top::tip2,
                     k3 = (top::tip1 - top::tip2) / top::tip3;
    const Mat3 J{0.0, k1 * v_.z, k1 * v_.y, k2 * v_.z, 0.0, k2 * v_.x, k3 * v_.y, k3 * v_.x, 0.0};
    const Mat3 once = skew(v_), twice = once * once;
    for (std::size_t i = 0; i < s; ++i)
      for (std::size_t j = 0; j < s; ++j) {
        const double own = i == j ? 1.0 : 0.0;
        const Mat3 identity = diagonal(own, own, own);
        put(velocity_inverse_, i, j, identity - a_[i][j] * J);
        put(kinematic_inverse_, i, j, identity + centred_[i][j] * (0.5 * once + (delay_[i] / 12.0) * twice));
      }
    count_.factorizations += 2;
    return invert<n>(velocity_inverse_.data(), n) && invert<n>(kinematic_inverse_.data(), n);
  }
  static void put(Matrix& A, std::size_t i, std::size_t j, const Mat3& block) {
    double* const at = A.data() + 3 * j * n + 3 * i;
    at[0] = block.xx, at[n] = block.xy, at[2 * n] = block.xz;
    at[1] = block.yx, at[n + 1] = block.yy, at[2 * n + 1] = block.yz;
    at[2] = block.zx, at[n + 2] = block.zy, at[2 * n + 2] = block.zz;
  }

  Row b_{}, delay_{};                            // (c_i - 1/2) h
  std::array<Row, s> a_{}, centred_{}, next_{};  // h a_ij, h (a_ij - b_j / 2)
  Stages F_{}, K_{}, V_{}, Theta_{};
  Vec3 turn_{}, rounding_{};
  Matrix velocity_inverse_{}, kinematic_inverse_{};
  KeptMatrix count_;
  bool first_ = true, formed_ = false;
  double rate_ = 1.0, turns_ = 0.0;
  int steps_ = 0, last_ = 0;
};

}  // namespace liebench::floors
