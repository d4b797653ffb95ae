#pragma once

#include "benchmarks/floors/floor.h"
#include "integrators/audit.h"
#include "integrators/consistent_projection.h"

namespace liebench::floors {

// Generalized-alpha with rho_inf = 0.9 for one of the tops.
template <class Top>
class GeneralizedAlpha {
 public:
  using System = typename Top::System;
  using Vector = typename Top::Vector;
  static constexpr int starting_points = 1;

  // h v''_0 from consistent accelerations on both sides of t_0, as the general stepper has it.
  void start(double h, std::span<const SolutionPoint<System>> points) {
    using Group = typename System::Group;
    const System system{HeavyTopParameters{}};
    h_ = h;
    t_ = points[0].t;
    q_ = configuration_from<typename Top::Configuration>(points[0].q);
    v_ = from_eigen(points[0].v);
    acceleration_ = from_eigen(points[0].acceleration);
    // The first prediction takes the consistent value, the second one the first solution alone.
    if constexpr (Top::l > 0) scaled_lambdas_[0] = h * from_eigen(points[0].lambda);
    const auto acceleration_at = [&](double s) {
      const auto& p = points[0];
      const Velocity<System> step = s * p.v + (s * s / 2.0) * p.acceleration;
      const Velocity<System> v = p.v + s * p.acceleration;
      NoAudit audit;
      return from_eigen(consistent_dynamics(system, p.t + s, Group::compose(p.q, Group::exp(step)), v, audit)
                            ->acceleration);
    };
    a_ = acceleration_ + (0.5 * (alpha_m - alpha_f)) * (acceleration_at(h) - acceleration_at(-h));
  }

  bool step() {
    const double rest = 1.0 - alpha_f;
    const AffineClosure<Vector> closure{.base = v_ + (0.5 * h_) * a_,
                                        .velocity = v_,
                                        .velocity_change = h_ * a_,
                                        .scaled_acceleration = (h_ / rest) * (a_ - alpha_f * acceleration_),
                                        .velocity_slope = gamma / beta,
                                        .acceleration_slope = (1.0 - alpha_m) / (beta * rest)};
    const double* c = extrapolation[count_];
    typename Top::Unknowns z;
    z.d = c[0] * changes_[0] + c[1] * changes_[1] + c[2] * changes_[2];
    if constexpr (Top::l > 0) {
      const double* b = extrapolation[std::max(count_, 1)];
      z.scaled_lambda = b[0] * scaled_lambdas_[0] + b[1] * scaled_lambdas_[1] + b[2] * scaled_lambdas_[2];
    }
    if constexpr (std::is_same_v<Top, StabilizedTop>) z.eta = {0.0, 0.0, 0.0};

    typename Top::Solution s;
    if (!top_.solve(h_, q_, closure, z, s) || turns_too_far(s.turn)) return false;

    const double inverse_h = 1.0 / h_;
    t_ += h_;
    v_ = v_ + s.velocity_change;
    acceleration_ = inverse_h * s.scaled_acceleration;
    a_ = a_ + (inverse_h / beta) * s.change;
    changes_[2] = changes_[1];
    changes_[1] = changes_[0];
    changes_[0] = s.change;
    if (count_ < 3) ++count_;
    if constexpr (Top::l > 0) {
      lambda_ = inverse_h * z.scaled_lambda;
      scaled_lambdas_[2] = scaled_lambdas_[1];
      scaled_lambdas_[1] = scaled_lambdas_[0];
      scaled_lambdas_[0] = z.scaled_lambda;
    }
    return true;
  }

  double time() const { return t_; }
  const typename Top::Configuration& configuration() const { return q_; }
  const Vector& velocity() const { return v_; }
  const KeptMatrix& kept() const { return top_.kept; }

 private:
  static constexpr double rho = 0.9;
  static constexpr double alpha_m = (2.0 * rho - 1.0) / (rho + 1.0), alpha_f = rho / (rho + 1.0);
  static constexpr double beta = 1.0 / ((rho + 1.0) * (rho + 1.0)), gamma = (3.0 - rho) / (2.0 * (rho + 1.0));

  Top top_;
  double h_ = 0.0, t_ = 0.0;
  typename Top::Configuration q_{};
  Vector v_{}, acceleration_{}, a_{};
  Vector changes_[3]{};
  Vec3 lambda_{}, scaled_lambdas_[3]{};
  int count_ = 0;
};

}  // namespace liebench::floors
