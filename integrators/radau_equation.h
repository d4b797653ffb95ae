#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "integrators/form.h"
#include "integrators/radau_coefficients.h"
#include "problems/system.h"

namespace liebench {

// A stage of Radau IIA, what its equations and their Newton matrix are evaluated at.
template <MechanicalSystem S>
struct RadauStage {
  typename S::Scalar t;
  Velocity<S> angle;                          // Theta_i
  Configuration<S> q;                         // Q_i
  Velocity<S> velocity, scaled_acceleration;  // V_i, h v'_i
  Multipliers<S> scaled_lambda;               // h Lambda_i
};
template <MechanicalSystem S>
using RadauStages = std::array<RadauStage<S>, RadauCoefficients<double>::stages>;

// The stage equations of Radau IIA on a Lie group; integrators/radau.h has the method. Unknowns (z_i, h Lambda_i, eta_i), z_i = K_i - v_n,
// all stages of a kind one after the other; eta_i in the stabilized index-2 form only. Rows, with W_i = V_i - v_n and the inverse d_ij
// of a_ij:
//
//   M(Q_i) sum_j d_ij W_j + h g(t_i, Q_i, V_i) + B(Q_i)^T h Lambda_i,   Phi(Q_i) / h,   B(Q_i) V_i
//   Theta_i = h sum_j a_ij K_j,  Q_i = q_n o exp(Theta_i~),  W_i = z_i + (T(Theta_i) K_i - K_i) + B(Q_i)^T eta_i
//
// Scaled as the step equation of the other methods (integrators/step_equation.h), and for the kernel of integrators/newton.h: it
// says here what it says there.
template <MechanicalSystem S, Form form>
class RadauEquation {
 public:
  using T = typename S::Scalar;
  using Coefficients = RadauCoefficients<T>;
  static constexpr int stages = int(Coefficients::stages);
  static constexpr int times_stages(int size) {
    return size == run_time_size ? run_time_size : stages * size;
  }
  static constexpr int m = times_stages(S::Group::dimension);
  static constexpr int l = times_stages(S::constraints);
  static constexpr bool stabilized = l != 0 && form == Form::stabilized_index2;
  static constexpr int n = m == run_time_size ? run_time_size : m + (stabilized ? 2 * l : l);
  static constexpr int most = times_stages(liebench::most_unknowns<S, stabilized>());
  using Unknowns = Eigen::Matrix<T, n, 1, 0, most, 1>;

  static Unknowns unknowns(const S& system) {
    if constexpr (n == run_time_size)
      return Unknowns(stages * (velocity_size(system) + (stabilized ? 2 : 1) * multiplier_size(system)));
    else
      return {};
  }
  template <class Vector>
  static auto change(Vector& z, const S& system) {
    return z.template head<m>(stages * velocity_size(system));
  }
  template <class Vector>
  static auto scaled_lambda(Vector& z, const S& system) {
    return z.template segment<l>(stages * velocity_size(system), stages * multiplier_size(system));
  }
  template <class Vector>
  static auto eta(Vector& z, const S& system) {
    const Eigen::Index rows = stages * multiplier_size(system);
    return z.template segment<l>(z.size() - rows, rows);
  }

  // A step from v_n.
  struct Start {
    const Coefficients& coefficients;
    const Velocity<S>& velocity;
    const Velocity<S>& base() const { return velocity; }
  };

  struct Point {
    RadauStages<S> stage;
    std::array<T, std::size_t(stages)> delay;                      // t_i - t_{n+1}
    std::array<Velocity<S>, std::size_t(stages)> velocity_change;  // W_i
    std::array<Velocity<S>, std::size_t(stages)> stabilization;    // B(Q_i)^T eta_i
  };

  static void evaluate(const S& system, const T& h, const Configuration<S>& q_n, const Start& start,
                       const Unknowns& z, Point& p) {
    const auto group = group_of(system);
    const auto& [coefficients, v_n] = start;
    std::array<Velocity<S>, std::size_t(stages)> K;
    for (int i = 0; i < stages; ++i) K[std::size_t(i)] = v_n + velocity_part(z, system, i);
    for (int i = 0; i < stages; ++i) {
      const auto s = std::size_t(i);
      RadauStage<S>& stage = p.stage[s];
      p.delay[s] = (coefficients.c[s] - T(1.0)) * h;
      stage.angle = h * weighted(coefficients.a[s], K);
      stage.q = group.compose(q_n, group.exp(stage.angle));
      p.velocity_change[s] = velocity_part(z, system, i) + (group.tangent_times(stage.angle, K[s]) - K[s]);
      if constexpr (stabilized)
        if (multiplier_size(system) != 0) {
          const Multipliers<S> own = multiplier_part(z, eta_begin(system), system, i);
          p.stabilization[s] = system.constraint_force(stage.q, own);
          p.velocity_change[s] += p.stabilization[s];
        }
      stage.velocity = v_n + p.velocity_change[s];
    }
    for (std::size_t s = 0; s < Coefficients::stages; ++s)
      p.stage[s].scaled_acceleration = weighted(coefficients.inverse[s], p.velocity_change);
  }

  // What evaluate() does not know of the stages.
  static void complete(const S& system, const T& t, const Unknowns& z, Point& p) {
    for (int i = 0; i < stages; ++i) {
      RadauStage<S>& stage = p.stage[std::size_t(i)];
      stage.t = t + p.delay[std::size_t(i)];
      if constexpr (l != 0) stage.scaled_lambda = lambda_part(z, system, i);
    }
  }

  static void residual(const S& system, const T& t, const T& h, Point& p, const Unknowns& z, Unknowns& r) {
    complete(system, t, z, p);
    for (int i = 0; i < stages; ++i) {
      const RadauStage<S>& stage = p.stage[std::size_t(i)];
      Velocity<S> balance = system.momentum(stage.q, stage.scaled_acceleration) +
                            h * system.force(stage.t, stage.q, stage.velocity);
      if constexpr (l != 0) {
        // Of a size known at run time there may be none.
        if (multiplier_size(system) != 0) {
          balance += system.constraint_force(stage.q, stage.scaled_lambda);
          lambda_part(r, system, i) = constraint_at(system, stage.t, stage.q) / h;
          if constexpr (stabilized)
            multiplier_part(r, eta_begin(system), system, i) =
                constraint_rate(system, stage.t, stage.q, stage.velocity);
        }
      }
      velocity_part(r, system, i) = balance;
    }
  }

  template <class Vector>
  static auto velocity_part(Vector& z, const S& system, int stage) {
    const Eigen::Index size = velocity_size(system);
    return z.template segment<S::Group::dimension>(stage * size, size);
  }
  template <class Vector>
  static auto lambda_part(Vector& z, const S& system, int stage) {
    return multiplier_part(z, stages * velocity_size(system), system, stage);
  }

 private:
  static Eigen::Index eta_begin(const S& system) {
    return stages * (velocity_size(system) + multiplier_size(system));
  }
  template <class Vector>
  static auto multiplier_part(Vector& z, Eigen::Index begin, const S& system, int stage) {
    const Eigen::Index size = multiplier_size(system);
    return z.template segment<S::constraints>(begin + stage * size, size);
  }
  static Velocity<S> weighted(const typename Coefficients::Row& weights,
                              const std::array<Velocity<S>, std::size_t(stages)>& x) {
    Velocity<S> sum = weights[0] * x[0];
    for (std::size_t j = 1; j < x.size(); ++j) sum += weights[j] * x[j];
    return sum;
  }
};

}  // namespace liebench
