#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "benchmarks/floors/explicit_methods.h"
#include "benchmarks/floors/floor.h"
#include "benchmarks/floors/kept_matrix.h"
#include "benchmarks/floors/lu.h"
#include "benchmarks/floors/tip_force.h"
#include "benchmarks/floors/top.h"
#include "integrators/radau_coefficients.h"

// Radau IIA with 3 stages for the top by hand: integrators/radau.h, radau_equation.h and radau_matrix.h have the method, its
// equations and their matrix.

namespace liebench::floors {

inline constexpr std::size_t radau_stages = 3;
template <class Vector>
using RadauStages = std::array<Vector, radau_stages>;
// Of the formation of a matrix, in iterations.
inline constexpr double radau_matrix_cost = 6.0;

template <class Vector>
Vector weighted(const std::array<double, radau_stages>& weights, const RadauStages<Vector>& x) {
  return weights[0] * x[0] + weights[1] * x[1] + weights[2] * x[2];
}
// (T(u) - I) w
inline Vec3 tangent_change(const Vec3& u, const Vec3& w) {
  const Vec3 once = cross(u, w);
  const double s = squared_norm(u);
  return tangent_coefficient(s) * cross(u, once) - exp_coefficients(s).versine * once;
}
// h C
inline Mat3 gyroscopic(double h, const Vec3& w, double J1, double J2, double J3) {
  return h * Mat3{0.0, (J3 - J2) * w.z, (J3 - J2) * w.y, (J1 - J3) * w.z,
                  0.0, (J1 - J3) * w.x, (J2 - J1) * w.y, (J2 - J1) * w.x,
                  0.0};
}

// What its matrix has of T(Theta_i): D_ij = [i = j] T_i + a_ij / c_i (I - T_i), sum_k d_ik D_kj.
class RadauTangents {
 public:
  RadauTangents(const RadauCoefficients<double>& coefficients, const RadauStages<Mat3>& T)
      : coefficients_(coefficients), T_(T) {}
  Mat3 change(std::size_t i, std::size_t j) const {
    const double factor = coefficients_.a[i][j] / coefficients_.c[i];
    const Mat3 D = factor * (diagonal(1.0, 1.0, 1.0) - T_[i]);
    return i == j ? D + T_[i] : D;
  }
  Mat3 acceleration(std::size_t i, std::size_t j) const {
    const auto& d = coefficients_.inverse[i];
    return d[0] * change(0, j) + d[1] * change(1, j) + d[2] * change(2, j);
  }

 private:
  const RadauCoefficients<double>& coefficients_;
  const RadauStages<Mat3>& T_;
};

class SO3Radau : public SO3Floor {
 public:
  void start(double h, std::span<const SolutionPoint<System>> points) {
    SO3Floor::start(h, points);
    for (std::size_t i = 0; i < radau_stages; ++i)
      predicted_[i] = (coefficients_.c[i] * h) * from_eigen(points[0].acceleration);
  }

  bool step() {
    RadauStages<Vec3> z = predicted_;
    Point p;
    if (!solve(z, p) || turns_too_far(p.angle[2])) return false;
    t_ += h_;
    q_.R = q_.R * exp(p.angle[2]);
    v_ = v_ + p.change[2];
    for (std::size_t i = 0; i < radau_stages; ++i)
      predicted_[i] = z[i] - p.change[i] + weighted(coefficients_.next_change[i], p.change);
    return true;
  }
  const KeptMatrix& kept() const { return kept_; }

 private:
  static constexpr int n = 9;
  struct Point {
    RadauStages<Vec3> angle, change;  // Theta_i, V_i - v_n
  };

  void evaluate(const RadauStages<Vec3>& z, Point& p) const {
    const RadauStages<Vec3> K{v_ + z[0], v_ + z[1], v_ + z[2]};
    for (std::size_t i = 0; i < radau_stages; ++i) {
      p.angle[i] = h_ * weighted(coefficients_.a[i], K);
      p.change[i] = z[i] + tangent_change(p.angle[i], K[i]);
    }
  }

  bool solve(RadauStages<Vec3>& z, Point& p) {
    double previous = 0.0;
    bool fresh = false, stalled = false;
    const double fixed_scale = 0.01 * max_norm(v_);
    if (kept_.wants_refresh()) {
      if (!factorize(z)) return false;
      fresh = true;
    }
    constexpr double g = top::weight * top::arm;
    Next next = Next::iterate;
    for (int iteration = 1; next != Next::done; ++iteration) {
      const RadauStages<Vec3> before = z;
      evaluate(z, p);
      double r[n], c[n];
#pragma GCC unroll 3
      for (std::size_t i = 0; i < radau_stages; ++i) {
        const Vec3 a = weighted(coefficients_.inverse[i], p.change), w = v_ + p.change[i];
        const Mat3 R = q_.R * exp(p.angle[i]);
        r[3 * i] = top::tip1 * a.x + h_ * ((top::tip3 - top::tip2) * w.y * w.z - g * R.zz);
        r[3 * i + 1] = top::tip2 * a.y + h_ * ((top::tip1 - top::tip3) * w.z * w.x);
        r[3 * i + 2] = top::tip3 * a.z + h_ * ((top::tip2 - top::tip1) * w.x * w.y + g * R.zx);
      }
      lu_.solve(r, c);
      double largest = 0.0, size_of_z = 0.0;
      for (std::size_t i = 0; i < radau_stages; ++i) {
        const Vec3 correction{c[3 * i], c[3 * i + 1], c[3 * i + 2]};
        z[i] = z[i] - correction;
        largest = std::max(largest, max_norm(correction));
        size_of_z = std::max(size_of_z, max_norm(z[i]));
      }
      const double size = relative(largest, fixed_scale + size_of_z);
      if (!std::isfinite(size) || size_of_z * h_ > 1e8) return false;
      next = kept_.judge(size, iteration, previous, fresh, stalled);
      if (next == Next::fail) return false;
      if (next == Next::factorize) {
        if (!factorize(before)) return false;
        fresh = true;
      }
    }
    evaluate(z, p);
    return true;
  }

  // M sum_k d_ik D_kj + h C_i D_ij + h^2 a_ij K_i T_i
  [[gnu::noinline]] bool factorize(const RadauStages<Vec3>& z) {
    Point p;
    evaluate(z, p);
    const RadauStages<Mat3> T{tangent(p.angle[0]), tangent(p.angle[1]), tangent(p.angle[2])};
    const RadauTangents tangents(coefficients_, T);
    constexpr double g = top::weight * top::arm;
    double largest = 0.0;
    for (std::size_t i = 0; i < radau_stages; ++i) {
      const Mat3 R = q_.R * exp(p.angle[i]);
      const Mat3 C = gyroscopic(h_, v_ + p.change[i], top::tip1, top::tip2, top::tip3);
      const Mat3 K{g * R.zy, -g * R.zx, 0.0, 0.0, 0.0, 0.0, 0.0, -g * R.zz, g * R.zy};
      const Mat3 stiffness = (h_ * h_) * (K * T[i]);
      for (std::size_t j = 0; j < radau_stages; ++j) {
        const Mat3 A = diagonal(top::tip1, top::tip2, top::tip3) * tangents.acceleration(i, j) +
                       C * tangents.change(i, j) + coefficients_.a[i][j] * stiffness;
        largest = std::max(largest, max_norm(A));
        lu_.set(int(3 * i), int(3 * j), A);
      }
    }
    kept_.renewed(largest);
    kept_.spent = radau_matrix_cost;
    return kept_.factorized = lu_.factorize();
  }

  RadauCoefficients<double> coefficients_;
  KeptMatrix kept_;
  Lu<n> lu_;
  RadauStages<Vec3> predicted_{};
};

// The constrained top: unknowns (z, h Lambda), and eta in the stabilized index-2 form.
template <bool stabilized>
class R3xSO3Radau : public TipFloor {
 public:
  void start(double h, std::span<const SolutionPoint<System>> points) {
    TipFloor::start(h, points);
    for (std::size_t i = 0; i < radau_stages; ++i) {
      predicted_.z[i] = (coefficients_.c[i] * h) * from_eigen(points[0].acceleration);
      predicted_.lambda[i] = h * from_eigen(points[0].lambda);
    }
  }

  bool step() {
    Unknowns z = predicted_;
    Point p;
    if (!solve(z, p) || turns_too_far(p.angle[2].w)) return false;
    t_ += h_;
    q_ = p.q[2];
    v_ = v_ + p.change[2];
    lambda_ = (1.0 / h_) * z.lambda[2];
    for (std::size_t i = 0; i < radau_stages; ++i) {
      Vec6 known = z.z[i] - p.change[i];
      if constexpr (stabilized) known = known + p.stabilization[i];
      predicted_.z[i] = known + weighted(coefficients_.next_change[i], p.change);
      predicted_.lambda[i] = weighted(coefficients_.next_value[i], z.lambda);
    }
    return true;
  }

  const KeptMatrix& kept() const { return kept_; }

 private:
  static constexpr int n = stabilized ? 36 : 27, lambda_begin = 18, eta_begin = 27;
  struct Unknowns {
    RadauStages<Vec6> z{};
    RadauStages<Vec3> lambda{}, eta{};
  };
  struct Point {
    RadauStages<Vec6> angle, change, stabilization;  // Theta_i, V_i - v_n, B(Q_i)^T eta_i
    RadauStages<TipPoint> q;
  };

  void evaluate(const Unknowns& u, Point& p) const {
    const RadauStages<Vec6> K{v_ + u.z[0], v_ + u.z[1], v_ + u.z[2]};
    for (std::size_t i = 0; i < radau_stages; ++i) {
      const Vec6 angle = h_ * weighted(coefficients_.a[i], K);
      p.angle[i] = angle;
      p.q[i] = at(q_.x + angle.x, q_.R * exp(angle.w));
      p.change[i] = {u.z[i].x, u.z[i].w + tangent_change(angle.w, K[i].w)};
      if constexpr (stabilized) {
        p.stabilization[i] = {-1.0 * (p.q[i].R * u.eta[i]), cross(p.q[i].y, u.eta[i])};
        p.change[i] = p.change[i] + p.stabilization[i];
      }
    }
  }

  bool solve(Unknowns& u, Point& p) {
    double previous = 0.0;
    bool fresh = false, stalled = false;
    const double inverse_h = 1.0 / h_;
    const double fixed_scale = 0.01 * max_norm(v_) + std::max(max_norm(q_.x), max_norm(q_.R)) * inverse_h;
    if (kept_.wants_refresh()) {
      if (!factorize(u, u.lambda)) return false;
      fresh = true;
    }
    Next next = Next::iterate;
    for (int iteration = 1; next != Next::done; ++iteration) {
      const Unknowns before = u;
      evaluate(u, p);
      double r[n], c[n];
#pragma GCC unroll 3
      for (std::size_t i = 0; i < radau_stages; ++i) {
        const Vec6 a = weighted(coefficients_.inverse[i], p.change), v = v_ + p.change[i];
        const TipPoint& q = p.q[i];
        const Vec3 force = q.R * u.lambda[i], moment = cross(q.y, u.lambda[i]);
        double* const row = r + 6 * i;
        row[0] = top::mass * a.x.x - force.x;
        row[1] = top::mass * a.x.y - force.y;
        row[2] = top::mass * a.x.z - h_ * top::weight - force.z;
        row[3] = top::J1 * a.w.x + h_ * ((top::J3 - top::J2) * v.w.y * v.w.z) + moment.x;
        row[4] = top::J2 * a.w.y + h_ * ((top::J1 - top::J3) * v.w.z * v.w.x) + moment.y;
        row[5] = top::J3 * a.w.z + h_ * ((top::J2 - top::J1) * v.w.x * v.w.y) + moment.z;
        put(r + lambda_begin + 3 * i, inverse_h * violation(q));
        if constexpr (stabilized) put(r + eta_begin + 3 * i, rate(q, v));
      }
      lu_.solve(r, c);
      double largest = 0.0, of_lambda = 0.0, size_of_z = 0.0, size_of_lambda = 0.0;
      for (std::size_t i = 0; i < radau_stages; ++i) {
        const Vec6 correction{from(c + 6 * i), from(c + 6 * i + 3)};
        const Vec3 of_this = from(c + lambda_begin + 3 * i);
        u.z[i] = u.z[i] - correction;
        u.lambda[i] = u.lambda[i] - of_this;
        largest = std::max(largest, max_norm(correction));
        of_lambda = std::max(of_lambda, max_norm(of_this));
        size_of_z = std::max(size_of_z, max_norm(u.z[i]));
        size_of_lambda = std::max(size_of_lambda, max_norm(u.lambda[i]));
        if constexpr (stabilized) {
          const Vec3 of_eta = from(c + eta_begin + 3 * i);
          u.eta[i] = u.eta[i] - of_eta;
          largest = std::max(largest, max_norm(of_eta));
        }
      }
      const double scale = fixed_scale + size_of_z;
      const double size =
          std::max(relative(largest, scale), relative(of_lambda, size_of_lambda + kept_.mass_scale * scale));
      if (!std::isfinite(size) || size_of_z * h_ > 1e8) return false;
      next = kept_.judge(size, iteration, previous, fresh, stalled);
      if (next == Next::fail) return false;
      if (next == Next::factorize) {
        if (!factorize(before, u.lambda)) return false;
        fresh = true;
      }
    }
    evaluate(u, p);
    return true;
  }
  static void put(double* to, const Vec3& v) {
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
  }
  static Vec3 from(const double* c) {
    return {c[0], c[1], c[2]};
  }

  [[gnu::noinline]] bool factorize(const Unknowns& u, const RadauStages<Vec3>& lambda) {
    Point p;
    evaluate(u, p);
    const RadauStages<Mat3> T{tangent(p.angle[0].w), tangent(p.angle[1].w), tangent(p.angle[2].w)};
    const RadauTangents tangents(coefficients_, T);
    for (auto& column : lu_.a) std::fill(column, column + n, 0.0);
    double largest = 0.0;
    for (std::size_t i = 0; i < radau_stages; ++i) {
      const TipPoint& q = p.q[i];
      const Vec6 v = v_ + p.change[i];
      const Mat3 C = gyroscopic(h_, v.w, top::J1, top::J2, top::J3);
      const Mat3 L = skew(lambda[i]), Rt = transposed(q.R), Y = skew(q.y), W = skew(v.w);
      const Mat3 upper = h_ * (q.R * L * T[i]), lower = -h_ * (L * Rt), stiffness = -h_ * (L * Y * T[i]);
      const Mat3 turned = Y * T[i], swept = (W * Y - skew(transposed_times(q.R, v.x))) * T[i];
      const int row = int(6 * i), of_lambda = lambda_begin + int(3 * i), of_eta = eta_begin + int(3 * i);
      lu_.set(row, of_lambda, -1.0 * q.R);
      lu_.set(row + 3, of_lambda, Y);
      if constexpr (stabilized) lu_.set(of_eta, of_eta, Rt * q.R - Y * Y);
      for (std::size_t j = 0; j < radau_stages; ++j) {
        const int column = int(6 * j);
        const double a = coefficients_.a[i][j], d = coefficients_.inverse[i][j], own = i == j ? 1.0 : 0.0;
        const double translational = top::mass * d;
        const Mat3 D = tangents.change(i, j);
        const Mat3 rotational =
            diagonal(top::J1, top::J2, top::J3) * tangents.acceleration(i, j) + C * D + a * stiffness;
        largest = std::max({largest, std::abs(translational), max_norm(rotational), max_norm(a * upper),
                            max_norm(a * lower)});
        lu_.set(row, column, diagonal(translational, translational, translational));
        lu_.set(row, column + 3, a * upper);
        lu_.set(row + 3, column, a * lower);
        lu_.set(row + 3, column + 3, rotational);
        lu_.set(of_lambda, column, -a * Rt);
        lu_.set(of_lambda, column + 3, -a * turned);
        if constexpr (stabilized) {
          const Mat3 Y_j = skew(p.q[j].y);
          const int column_of_eta = eta_begin + int(3 * j);
          lu_.set(of_eta, column, (h_ * a) * (W * Rt) - own * Rt);
          lu_.set(of_eta, column + 3, (h_ * a) * swept - Y * D);
          lu_.set(row, column_of_eta, -translational * p.q[j].R);
          lu_.set(row + 3, column_of_eta, d * (diagonal(top::J1, top::J2, top::J3) * Y_j) + own * (C * Y));
        }
      }
    }
    kept_.renewed(largest);
    kept_.spent = radau_matrix_cost;
    return kept_.factorized = lu_.factorize();
  }

  RadauCoefficients<double> coefficients_;
  KeptMatrix kept_;
  Lu<n> lu_;
  Vec3 lambda_{};
  Unknowns predicted_;
};

}  // namespace liebench::floors
