#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <type_traits>

#include "benchmarks/floors/faltinsen_bdf.h"
#include "benchmarks/floors/floor.h"

namespace liebench::floors {

// v in canonical coordinates about q_{n+1}, from the logarithms L_2 and L_3 of the motions of the last steps and the new one, at a point
// next to d and by their derivatives there: integrators/centred_kinematics.h gives the reasons. Only rotations are curved: the
// translation is that of BDF, affine in d.
template <class Vector>
struct CentredClosure {
  // alpha_1, alpha_2, alpha_3
  static constexpr double alpha1 = -3.0, alpha2 = 3.0 / 2.0, alpha3 = -1.0 / 3.0;

  struct Expansion {
    Vec3 change, turn, second, third;  // d, h Dq, L_2, L_3
    Vec3 velocity_change;
  };

  Vector base;
  Vector velocity;
  Vector velocity_change;  // at d = 0, of a translation
  Vector memory;           // h v' without v_{n+1} - v_n
  double velocity_slope, acceleration_slope;
  const std::array<Mat3, 2>& motions;
  Expansion predicted{};

  Expansion expansion_at(double h, const Vec3& d) const {
    const Vec3 Dq = rotation(base) + d;
    Expansion here;
    here.change = d;
    here.turn = h * Dq;
    const Mat3 motion = exp(here.turn);
    here.second = log(motions[0] * motion);
    here.third = log(motions[1] * motion);
    const Vec3 bent = alpha2 * here.second + alpha3 * here.third;
    here.velocity_change = -1.0 * (alpha1 * Dq + (1.0 / h) * bent) - rotation(velocity);
    return here;
  }

  template <class Solution>
  void evaluate(double h, const Vector& d, Solution& s) const {
    Vec3 e = rotation(d) - predicted.change;
    const double farthest = max_norm(e), b = h * farthest;
    Vec3 curved;
    if (b * b < std::numeric_limits<double>::epsilon()) {
      curved = velocity_change_at(predicted, e);
    } else {
      // To half of the digits of the largest entry.
      const double origin = leading_half(2.0 * farthest);
      const auto leading = [&](double x) { return leading_half(x + origin) - origin; };
      const Vec3 near{leading(e.x), leading(e.y), leading(e.z)};
      const Expansion next = expansion_at(h, predicted.change + near);
      curved = velocity_change_at(next, rotation(d) - next.change);
    }
    s.velocity_change = with_rotation(velocity_slope * d + velocity_change, curved);
    s.scaled_acceleration = velocity_slope * s.velocity_change + memory;
  }
  Mat3 velocity_derivative(double h, const Vector& d) const {
    const Expansion here = expansion_at(h, rotation(d));
    return diagonal(-alpha1, -alpha1, -alpha1) -
           (alpha2 * tangent_inverse(here.second) + alpha3 * tangent_inverse(here.third)) *
               tangent(here.turn);
  }
  Mat3 acceleration_derivative(double h, const Vector& d) const {
    return velocity_slope * velocity_derivative(h, d);
  }

 private:
  static double leading_half(double x) {
    const double scaled = 0x1.00000008p29 * x;
    return scaled - (scaled - x);
  }
  static Mat3 tangent_inverse(const Vec3& v) {
    return skew_polynomial(v, 0.5, cotangent_defect(squared_norm(v)));
  }
  static Vec3 tangent_times(const Vec3& u, const Vec3& w) {
    const Vec3 once = cross(u, w);
    const double s = squared_norm(u);
    return w - exp_coefficients(s).versine * once + tangent_coefficient(s) * cross(u, once);
  }
  // For d + e.
  static Vec3 velocity_change_at(const Expansion& at, const Vec3& e) {
    const Vec3 moved = tangent_times(at.turn, e);
    return at.velocity_change - (alpha1 * e + alpha2 * tangent_inverse_times(at.second, moved) +
                                 alpha3 * tangent_inverse_times(at.third, moved));
  }
};

// The BDF method with k = 3 in canonical coordinates about the new point, for one of the tops.
template <class Top>
class CentredBdf {
 public:
  using System = typename Top::System;
  using Vector = typename Top::Vector;
  static constexpr int starting_points = 4;

  void start(double h, std::span<const SolutionPoint<System>> points) {
    h_ = h;
    t_ = points[2].t;
    q_ = configuration_from<typename Top::Configuration>(points[2].q);
    v_ = from_eigen(points[2].v);
    const Vector older = increment_from<System>(h, points, 0);
    increment_ = increment_from<System>(h, points, 1);
    for (const Vector& Dq : {older, increment_}) accept(h * rotation(Dq), exp(h * rotation(Dq)));
    increment_changes_[0] = increment_ - older;
    count_ = 1;
    velocity_changes_[0] = v_ - from_eigen(points[1].v);
    velocity_changes_[1] = from_eigen(points[1].v) - from_eigen(points[0].v);
    if constexpr (Top::l > 0) {
      scaled_lambdas_[0] = h * from_eigen(points[2].lambda);
      lambda_count_ = 1;
    }
    first_change_ = gamma1 * increment_ + gamma2 * increment_ + gamma3 * older - v_;
  }

  bool step() {
    const auto& dd = increment_changes_;
    const auto& dv = velocity_changes_;
    Vector change = first_ ? first_change_ : gamma2 * dd[0] + gamma3 * dd[1];
    if constexpr (stabilized) change = change - gamma1 * stabilization_;
    CentredClosure<Vector> closure{.base = increment_,
                                   .velocity = v_,
                                   .velocity_change = change,
                                   .memory = gamma2 * dv[0] + gamma3 * dv[1],
                                   .velocity_slope = gamma1,
                                   .acceleration_slope = gamma1 * gamma1,
                                   .motions = motions_};
    const double* c = extrapolation[count_];
    typename Top::Unknowns z;
    z.d = c[0] * dd[0] + c[1] * dd[1] + c[2] * dd[2] + c[3] * dd[3];
    closure.predicted = closure.expansion_at(h_, rotation(z.d));
    if constexpr (Top::l > 0) {
      const double* b = extrapolation[lambda_count_];
      const auto& hl = scaled_lambdas_;
      z.scaled_lambda = b[0] * hl[0] + b[1] * hl[1] + b[2] * hl[2] + b[3] * hl[3] + b[4] * hl[4];
    }
    if constexpr (stabilized) z.eta = {0.0, 0.0, 0.0};

    typename Top::Solution s;
    if (!top_.solve(h_, q_, closure, z, s)) return false;
    const double angle = std::sqrt(squared_norm(s.turn));
    if (!(angles_[0] + angles_[1] + angle < std::numbers::pi)) return false;

    t_ += h_;
    v_ = v_ + s.velocity_change;
    velocity_changes_[1] = velocity_changes_[0];
    velocity_changes_[0] = s.velocity_change;
    if constexpr (stabilized) stabilization_ = s.change - z.d;
    increment_ = increment_ + z.d;
    increment_changes_[3] = increment_changes_[2];
    increment_changes_[2] = increment_changes_[1];
    increment_changes_[1] = increment_changes_[0];
    increment_changes_[0] = z.d;
    if (count_ < 4) ++count_;
    accept(s.turn, s.motion);
    first_ = false;
    if constexpr (Top::l > 0) {
      lambda_ = (1.0 / h_) * z.scaled_lambda;
      for (int i = 4; i > 0; --i) scaled_lambdas_[i] = scaled_lambdas_[i - 1];
      scaled_lambdas_[0] = z.scaled_lambda;
      if (lambda_count_ < 5) ++lambda_count_;
    }
    return true;
  }

  double time() const { return t_; }
  const typename Top::Configuration& configuration() const { return q_; }
  const Vector& velocity() const { return v_; }
  const KeptMatrix& kept() const { return top_.kept; }

 private:
  static constexpr double gamma1 = 11.0 / 6.0, gamma2 = -7.0 / 6.0, gamma3 = 1.0 / 3.0;
  static constexpr bool stabilized = std::is_same_v<Top, StabilizedTop>;

  void accept(const Vec3& turn, const Mat3& motion) {
    motions_[1] = motions_[0] * motion;
    motions_[0] = motion;
    angles_[1] = angles_[0];
    angles_[0] = std::sqrt(squared_norm(turn));
  }

  Top top_;
  double h_ = 0.0, t_ = 0.0;
  typename Top::Configuration q_{};
  Vector v_{}, increment_{}, first_change_{}, stabilization_{};
  std::array<Mat3, 2> motions_{};   // of the last step, and of the last two together
  std::array<double, 2> angles_{};  // of the last steps
  Vector velocity_changes_[2]{}, increment_changes_[4]{};
  Vec3 lambda_{}, scaled_lambdas_[5]{};
  int count_ = 0, lambda_count_ = 0;
  bool first_ = true;
};

}  // namespace liebench::floors
