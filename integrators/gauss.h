#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "groups/entrywise.h"
#include "integrators/audit.h"
#include "integrators/dense_inverse.h"
#include "integrators/fits.h"
#include "integrators/gauss_coefficients.h"
#include "integrators/inlining.h"
#include "integrators/mass_solver.h"
#include "integrators/option.h"
#include "integrators/outcome.h"
#include "integrators/runge_kutta_munthe_kaas.h"
#include "integrators/starting_values.h"
#include "problems/system.h"

namespace liebench {

// Gauss collocation on the group, of order 2 s with s stages, in canonical coordinates about the middle of the step: with
// m = q_n o exp(Y~), for q' = DL_q(e) v~ and v' = F(t, q, v) = -M^{-1} g,
//
//   Y = h/2 sum_j b_j K_j,  Theta_i = h sum_j (a_ij - b_j / 2) K_j,  Q_i = m o exp(Theta_i~),  K_i = T^{-1}(Theta_i) V_i
//   V_i = v_n + h sum_j a_ij F_j,  F_i = F(t_n + c_i h, Q_i, V_i)
//   q_{n+1} = q_n o exp(2 Y~),  v_{n+1} = v_n + h sum_j b_j F_j
//
// q_n and q_{n+1} are exp(-Y) and exp(Y) of these coordinates: the method is symmetric, which that in coordinates about q_n is for s = 1
// only (both are the implicit midpoint rule then), and the angles are half as large, which T^{-1} converges by [Zanna, Engo &
// Munthe-Kaas 2001, Adjoint and selfadjoint Lie-group methods, BIT 41].
struct Gauss {
  static constexpr std::string_view name = "gauss";
  static constexpr std::string_view summary =
      "Gauss collocation in canonical coordinates about the middle of the step: implicit, symmetric, order 2 "
      "s";
  static constexpr Fits fits = Fits::without_constraints;
  static constexpr auto option_list = std::to_array<OptionInfo>({
      {.name = "stages",
       .kind = OptionKind::integer,
       .fallback = 4,
       .least = 1,
       .most = double(GaussCoefficients<double>::most_stages),
       .meaning = "number of stages s; the order is 2 s"},
  });

  static std::string title(const OptionValues& values) {
    return "Gauss, s = " + std::to_string(values.integer("stages"));
  }
  static ConvergenceOrders orders(const OptionValues& values) {
    return same_order(2 * values.integer("stages"));
  }
  static bool symmetric(const OptionValues&) { return true; }

  struct Options {
    int stages = 4;
  };
  static Options options(const OptionValues& values) { return {values.integer("stages")}; }

  template <MechanicalSystem S, class Audit>
  class Stepper;

  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options& options, const S& system, Visitor&& visit) {
    return visit(Stepper<S, Audit>(system, options));
  }
};

// The stage equations are solved by an iteration that takes the velocities and the kinematics in turn. F is solved for by the
// simplified Newton iteration of the matrix I - h A (x) J - h^2 A^2 (x) C, J = dF/dv and C = dF/dq at t_n, with K = V in the
// configurations that follow F: the last term is what is stiff in springs. With V_i kept, K is solved for by that of
// I + h A_centred (x) dT^{-1}, T^{-1}(Theta) V = V - 1/2 [V, Theta] - tau/12 [V, [V, Theta]] for Theta = tau v_n; then Q_i follow. A fast
// rotation is nearly all in the two matrices: on the fast top, in steps of one radian, errors fall by 1e-4 in each turn, by 1e-1
// without them. The inverses serve as many steps as they are worth. A system of more than one body has none: there it is the
// fixed-point iteration.
//
// Stopping rule, that of integrators/newton.h: changes of K_i and h F_i in units of round-off of the largest velocity; rate, the
// contraction seen. The iteration ends
//   - converged, when the change or the predicted next one is below 1/20;
//   - converged at the round-off floor, when changes no longer shrink by a factor of 2 and are below 32 units, or below 32 times what the
//     rounding of q makes of h F_i: h |C| eps (|q| + h^2 |F|), or 1 / h in place of h |C|, where the inverse takes the rest;
//   - newton_diverged, when above that floor, with matrices formed in this step, a change grows after one that did not shrink by a
//     factor of 2; and after 100 turns.
template <MechanicalSystem S, class Audit>
class Gauss::Stepper {
 public:
  using System = S;
  using T = typename S::Scalar;

  Stepper(const S& system, const Options& options)
      : system_(system),
        coefficients_(options.stages),
        q_(group_of(system).identity()),
        velocity_(zero_velocity(system)),
        rounding_(velocity_),
        lambda_(zero_multipliers(system)),
        turn_(velocity_) {
    for (Stages* stages : {&K_, &F_, &V_, &Theta_, &last_F_}) stages->fill(velocity_);
    Q_.fill(q_);
    if (newton()) {
      velocity_inverse_.resize(unknowns(), unknowns());
      kinematic_inverse_.resize(unknowns(), unknowns());
      residual_.resize(unknowns());
      correction_.resize(unknowns());
    }
  }

  int steps() const { return 1; }
  int starting_points() const { return 1; }
  const T& time() const { return t_; }
  const Configuration<S>& configuration() const { return q_; }
  const Velocity<S>& velocity() const { return velocity_; }
  const Multipliers<S>& multipliers() const { return lambda_; }
  const S& system() const { return system_; }
  const Audit& audit() const { return audit_; }
  Audit& audit() { return audit_; }

  // From q_0, v_0 and v'_0.
  StepResult start(const T& h, std::span<const SolutionPoint<S>> points) {
    h_ = h;
    t_ = points[0].t;
    q_ = points[0].q;
    velocity_ = points[0].v;
    rounding_.setConstant(T(0.0));
    mass_.prepare(system_, audit_);
    for (std::size_t i = 0; i < stages(); ++i) {
      last_F_[i] = points[0].acceleration;
      for (std::size_t j = 0; j < stages(); ++j) {
        step_a_[i][j] = h * coefficients_.a[i][j];
        step_centred_[i][j] = h * coefficients_.centred[i][j];
      }
    }
    for (std::size_t i = 0; i < stages(); ++i)
      for (std::size_t j = 0; j < stages(); ++j) {
        step_squared_[i][j] = T(0.0);
        for (std::size_t l = 0; l < stages(); ++l) step_squared_[i][j] += step_a_[i][l] * step_a_[l][j];
      }
    first_ = true;
    formed_ = false;
    return {};
  }

  StepResult step() {
    return inlined_step<S>([this] { return take_step(); });
  }

 private:
  using Linear = LinearScalar<T>;
  using Stages = std::array<Velocity<S>, std::size_t(GaussCoefficients<T>::most_stages)>;
  using Weights = typename GaussCoefficients<T>::Matrix;
  // Of the matrices, in velocities: one body.
  static constexpr int most_velocities = 6;
  static constexpr int m = S::Group::dimension;
  static constexpr int most_unknowns = GaussCoefficients<T>::most_stages *
                                       (m == run_time_size ? most_velocities : std::min(m, most_velocities));
  using Inverse = Eigen::Matrix<Linear, Eigen::Dynamic, Eigen::Dynamic, 0, most_unknowns, most_unknowns>;
  using Column = Eigen::Matrix<Linear, Eigen::Dynamic, 1, 0, most_unknowns, 1>;

  static constexpr int max_iterations = 100;
  static constexpr double unit = 0.05;
  static constexpr double noise = 32.0;
  static constexpr double slowest_rate = 0.5;
  static constexpr double safety = 2.0;

  std::size_t stages() const { return std::size_t(coefficients_.stages); }
  std::size_t velocities() const { return std::size_t(velocity_size(system_)); }
  Eigen::Index unknowns() const { return coefficients_.stages * velocity_size(system_); }
  bool newton() const { return velocity_size(system_) <= most_velocities; }

  // The number of stages, known to the compiler where a step is so short that loops are a part of its time.
  StepResult take_step() {
    if constexpr (m != run_time_size)
      if (stages() == 2) return take_step(std::integral_constant<std::size_t, 2>());
    return take_step(stages());
  }
  template <class Count>
  StepResult take_step(Count s) {
    if (Outcome turned = outcome_of_turn(system_, Velocity<S>(h_ * velocity_)); turned != Outcome::ok)
      return {turned};
    bool fresh = !formed_ || marginal_cost_exceeds_average();
    if (fresh)
      if (const Outcome formed = form(); formed != Outcome::ok) return {formed};
    StepResult result = iterate(s);
    if (result.outcome == Outcome::newton_diverged && newton() && !fresh) {
      if (const Outcome formed = form(); formed != Outcome::ok) return {formed};
      result = iterate(s);
    }
    if (result.outcome != Outcome::ok) {
      formed_ = false;
      return result;
    }
    const Velocity<S> step = T(2.0) * turn_;
    if (const Outcome turned = outcome_of_turn(system_, step); turned != Outcome::ok) return {turned};
    Velocity<S> change = coefficients_.b[0] * F_[0];
    add_weighted(s, coefficients_.b, 1, F_, change);
    // Summed with what the sum rounded away before [Kahan 1965; Hairer, Lubich & Wanner 2006, VIII.5].
    const Velocity<S> corrected = h_ * change + rounding_;
    Velocity<S> sum = velocity_;
    sum += corrected;
    if (!std::isfinite(to_double(T(sum.squaredNorm())))) return {Outcome::non_finite};
    const auto group = group_of(system_);
    q_ = group.compose(q_, group.exp(step));
    const Velocity<S> added = sum - velocity_;
    rounding_ = corrected - added;
    velocity_ = sum;
    t_ = t_ + h_;
    for (std::size_t i = 0; i < s; ++i) last_F_[i] = F_[i];
    first_ = false;
    return result;
  }

  // F_i as the collocation polynomial of the last step goes on, V_i, and K_i from V_i.
  template <class Count>
  void predict(Count s) {
    for (std::size_t i = 0; i < s; ++i) {
      if (first_) {
        F_[i] = last_F_[i];
        continue;
      }
      const auto& weights = coefficients_.extrapolation[i];
      F_[i] = weights[0] * last_F_[0];
      add_weighted(s, weights, 1, last_F_, F_[i]);
    }
    put_velocities(s);
    for (std::size_t i = 0; i < s; ++i) K_[i] = V_[i];
    put_angles(s);
  }

  template <class Count>
  StepResult iterate(Count s) {
    const auto group = group_of(system_);
    predict(s);
    correct_kinematics(s);
    Linear previous(0.0);
    bool stalled = false;
    for (int iteration = 1;; ++iteration) {
      const Configuration<S> middle = group.compose(q_, group.exp(turn_));
      for (std::size_t i = 0; i < s; ++i) Q_[i] = group.compose(middle, group.exp(Theta_[i]));
      Linear change(0.0);
      if (!correct_velocities(s, change)) return {Outcome::singular_matrix};
      change = change * abs_of(to_linear(h_));
      // Twice: it takes little, and the first change is that of V_i.
      correct_kinematics(s);
      const Linear kinematic_change = correct_kinematics(s);
      if (change < kinematic_change) change = kinematic_change;

      if (!std::isfinite(to_double(change))) return {Outcome::non_finite};
      const Linear size = in_units(change);
      const Linear rate = iteration > 1 ? std::max(size, Linear(1.0)) / previous : rate_;
      if (size <= Linear(unit) || rate * size <= Linear(unit)) {
        // The step that the matrices were formed in says nothing of the next.
        rate_ = steps_ == 0 ? Linear(1.0) : std::min(Linear(1.0), rate * Linear(safety));
        finish(iteration);
        return {};
      }
      if (iteration > 1 && rate > Linear(slowest_rate)) {
        if (size <= Linear(noise) || change <= Linear(noise) * configuration_rounding()) {
          finish(iteration);
          return {};
        }
        if ((stalled && rate > Linear(1.0)) || iteration >= max_iterations)
          return {Outcome::newton_diverged, to_double(change)};
        stalled = true;
      } else {
        stalled = false;
      }
      previous = size;
    }
  }

  // One simplified Newton step for F with Q_i kept, and V of it. `change` of F_i; false where M is singular.
  template <class Count>
  bool correct_velocities(Count s, Linear& change) {
    const std::size_t n = velocities();
    Velocity<S> F;
    for (std::size_t i = 0; i < s; ++i) {
      if (!acceleration(T(t_ + coefficients_.c[i] * h_), Q_[i], V_[i], F)) return false;
      const Velocity<S> residual = F - F_[i];
      if (newton())
        put(residual, i * n);
      else
        F_[i] += take(residual, change);
    }
    if (newton()) add_correction(s, velocity_inverse_, F_, change);
    put_velocities(s);
    return true;
  }

  // The same for K with V_i kept, and Theta_i and Y of it.
  template <class Count>
  Linear correct_kinematics(Count s) {
    const auto group = group_of(system_);
    const std::size_t n = velocities();
    Linear change(0.0);
    const bool solves = newton() && has_commutators(system_);
    for (std::size_t i = 0; i < s; ++i) {
      const Velocity<S> residual = group.tangent_inverse_times(Theta_[i], V_[i]) - K_[i];
      if (solves)
        put(residual, i * n);
      else
        K_[i] += take(residual, change);
    }
    if (solves) add_correction(s, kinematic_inverse_, K_, change);
    put_angles(s);
    return change;
  }

  template <class Count>
  void put_velocities(Count s) {
    for (std::size_t i = 0; i < s; ++i) {
      V_[i] = velocity_;
      add_weighted(s, step_a_[i], 0, F_, V_[i]);
    }
  }
  template <class Count>
  void put_angles(Count s) {
    turn_ = coefficients_.b[0] * K_[0];
    add_weighted(s, coefficients_.b, 1, K_, turn_);
    turn_ *= h_ * T(0.5);
    for (std::size_t i = 0; i < s; ++i) {
      Theta_[i] = step_centred_[i][0] * K_[0];
      add_weighted(s, step_centred_[i], 1, K_, Theta_[i]);
    }
  }
  // sum += sum_j weights[j] x[j], j = first, ...; in registers where the size is known.
  template <class Count>
  void add_weighted(Count s, const typename GaussCoefficients<T>::Row& weights, std::size_t first,
                    const Stages& x, Velocity<S>& sum) const {
    if constexpr (m == run_time_size) {
      for (std::size_t j = first; j < s; ++j) sum += weights[j] * x[j];
    } else {
      Velocity<S> local = sum;
      for (std::size_t j = first; j < s; ++j) local += weights[j] * x[j];
      sum = local;
    }
  }

  void put(const Velocity<S>& residual, std::size_t place) {
    for (std::size_t d = 0; d < velocities(); ++d)
      residual_.data()[place + d] = to_linear(residual(Eigen::Index(d)));
  }
  // x += inverse residual. Sums of rows in registers: in memory each waits for what was stored of it just before.
  template <class Count>
  void add_correction(Count s, const Inverse& inverse, Stages& x, Linear& change) {
    const std::size_t n = s * velocities();
    Linear* const to = correction_.data();
    std::size_t row = 0;
    for (; row + 6 <= n; row += 6) put_rows<6>(inverse.data() + row, n, to + row);
    for (; row + 3 <= n; row += 3) put_rows<3>(inverse.data() + row, n, to + row);
    for (; row < n; ++row) put_rows<1>(inverse.data() + row, n, to + row);
    std::size_t next = 0;
    for (std::size_t i = 0; i < s; ++i)
      for (std::size_t d = 0; d < velocities(); ++d, ++next) {
        x[i](Eigen::Index(d)) += T(to[next]);
        take_size(abs_of(to[next]), change);
      }
  }
  template <std::size_t rows>
  [[gnu::always_inline]] void put_rows(const Linear* column, std::size_t n, Linear* to) const {
    std::array<Linear, rows> sums;
    for (std::size_t i = 0; i < rows; ++i) sums[i] = Linear(0.0);
    for (std::size_t j = 0; j < n; ++j, column += n) {
      const Linear factor = residual_.data()[j];
      for (std::size_t i = 0; i < rows; ++i) sums[i] += column[i] * factor;
    }
    for (std::size_t i = 0; i < rows; ++i) to[i] = sums[i];
  }
  static const Velocity<S>& take(const Velocity<S>& residual, Linear& change) {
    for (Eigen::Index d = 0; d < residual.size(); ++d) take_size(abs_of(to_linear(residual(d))), change);
    return residual;
  }
  // The larger one; a NaN stays.
  static void take_size(const Linear& size, Linear& largest) {
    if (!(size <= largest)) largest = size;
  }

  bool acceleration(const T& t, const Configuration<S>& q, const Velocity<S>& v, Velocity<S>& F) {
    const Velocity<S> force = -system_.force(t, q, v);
    return mass_.solve(system_, q, force, F, audit_);
  }

  // Of h F_i, by the rounding of q_n and of h V_i, a sum of h^2 F_j.
  Linear configuration_rounding() const {
    const Linear h = abs_of(to_linear(h_));
    Linear force(0.0);
    for (std::size_t i = 0; i < stages(); ++i) take(F_[i], force);
    const Linear q = to_linear(T(S::Group::stacked(q_).template lpNorm<Eigen::Infinity>())) + h * h * force;
    return Linear(to_double(Eigen::NumTraits<T>::epsilon())) * q * std::min(h * stiffness_, Linear(1.0) / h);
  }
  // In units of round-off of the largest velocity.
  Linear in_units(const Linear& change) const {
    Linear scale(0.0);
    for (std::size_t i = 0; i < stages(); ++i) take(K_[i], scale);
    const double eps = to_double(Eigen::NumTraits<T>::epsilon());
    return change / (Linear(eps) * scale + Linear(std::numeric_limits<double>::min()));
  }

  // The two matrices at t_n.
  [[gnu::noinline, gnu::cold]] Outcome form() {
    formed_ = true;
    rate_ = Linear(1.0);
    sweeps_ = formation_cost();
    steps_ = 0;
    last_ = 0;
    if (!newton()) return Outcome::ok;
    // J and C column by column in central differences, exact in J for the inertial forces, quadratic in v: no system is asked for more
    // than its force. As wide as the cube root of round-off, where the error of others is least.
    Linear speed(0.0);
    take(velocity_, speed);
    const Linear root(std::cbrt(to_double(Eigen::NumTraits<Linear>::epsilon())));
    const Linear width = root * (speed + Linear(1.0) / abs_of(to_linear(h_)));
    Velocity<S> forth, back;
    const bool turns = has_commutators(system_);
    const auto group = group_of(system_);
    set_identity(velocity_inverse_);
    if (turns) set_identity(kinematic_inverse_);
    stiffness_ = Linear(0.0);
    for (std::size_t e = 0; e < velocities(); ++e) {
      Velocity<S> direction = zero_velocity(system_);
      direction(Eigen::Index(e)) = T(width);
      if (!acceleration(t_, q_, Velocity<S>(velocity_ + direction), forth) ||
          !acceleration(t_, q_, Velocity<S>(velocity_ - direction), back))
        return Outcome::singular_matrix;
      const Velocity<S> J = (forth - back) / T(Linear(2.0) * width);
      subtract_column(velocity_inverse_, step_a_, e, [&](std::size_t) -> const Velocity<S>& { return J; });
      direction(Eigen::Index(e)) = T(root);
      if (!acceleration(t_, group.compose(q_, group.exp(direction)), velocity_, forth) ||
          !acceleration(t_, group.compose(q_, group.exp(Velocity<S>(-direction))), velocity_, back))
        return Outcome::singular_matrix;
      const Velocity<S> C = (forth - back) / T(Linear(2.0) * root);
      take(C, stiffness_);
      subtract_column(velocity_inverse_, step_squared_, e,
                      [&](std::size_t) -> const Velocity<S>& { return C; });
      if (!turns) continue;
      direction(Eigen::Index(e)) = T(1.0);
      const Velocity<S> once = group.commutator(velocity_, direction);
      const Velocity<S> twice = group.commutator(velocity_, once);
      subtract_column(kinematic_inverse_, step_centred_, e, [&](std::size_t i) {
        const T tau = (coefficients_.c[i] - T(0.5)) * h_;
        return Velocity<S>(T(-0.5) * once - (tau / T(12.0)) * twice);
      });
    }
    const auto inverted = [&](Inverse& inverse) {
      if (!inverse.allFinite()) return Outcome::non_finite;
      audit_.factorization(first_ ? FactorizationCause::first : FactorizationCause::refresh);
      return invert<std::size_t(most_unknowns)>(inverse.data(), std::size_t(unknowns()))
                 ? Outcome::ok
                 : Outcome::singular_matrix;
    };
    const Outcome outcome = inverted(velocity_inverse_);
    return outcome == Outcome::ok && turns ? inverted(kinematic_inverse_) : outcome;
  }
  void set_identity(Inverse& matrix) const {
    matrix.setConstant(Linear(0.0));
    for (Eigen::Index i = 0; i < unknowns(); ++i) matrix(i, i) = Linear(1.0);
  }
  // weights (x) J, its columns of the direction e; J may differ from row to row of stages.
  template <class Column>
  void subtract_column(Inverse& matrix, const Weights& weights, std::size_t e, const Column& column) const {
    const std::size_t n = velocities();
    for (std::size_t i = 0; i < stages(); ++i) {
      const Velocity<S> J = column(i);
      for (std::size_t j = 0; j < stages(); ++j)
        for (std::size_t d = 0; d < n; ++d)
          matrix(Eigen::Index(i * n + d), Eigen::Index(j * n + e)) -=
              to_linear(T(weights[i][j] * J(Eigen::Index(d))));
    }
  }

  // Of form(), in turns of the iteration, measured for one body.
  double formation_cost() const { return 0.5 * double(unknowns()); }
  void finish(int iterations) {
    sweeps_ += iterations;
    ++steps_;
    last_ = iterations;
  }
  // As in integrators/newton.h: kept while one more step with it costs less than those since it was formed did on average.
  bool marginal_cost_exceeds_average() const { return newton() && steps_ > 0 && last_ * steps_ > sweeps_; }

  S system_;
  [[no_unique_address]] Audit audit_;
  MassSolver<S> mass_;
  GaussCoefficients<T> coefficients_;
  Weights step_a_{}, step_centred_{};  // h a_ij, h (a_ij - b_j / 2)
  Weights step_squared_{};             // h^2 sum_l a_il a_lj
  T h_ = T(0.0);
  T t_ = T(0.0);
  Configuration<S> q_;
  Velocity<S> velocity_;
  Velocity<S> rounding_;   // what velocity_ lacks of the sum of all changes
  Multipliers<S> lambda_;  // none
  bool first_ = true;
  Stages last_F_;  // F_i of the step before; v'_0 in the first
  // Of the step:
  Stages K_, F_, V_, Theta_;
  Velocity<S> turn_;  // Y
  std::array<Configuration<S>, std::size_t(GaussCoefficients<T>::most_stages)> Q_;
  Inverse velocity_inverse_, kinematic_inverse_;
  Column residual_, correction_;
  bool formed_ = false;
  Linear stiffness_ = Linear(0.0);  // the largest entry of C
  Linear rate_ = Linear(1.0);
  double sweeps_ = 0.0;
  int steps_ = 0;  // since the matrices were formed
  int last_ = 0;   // turns of the last one
};

}  // namespace liebench
