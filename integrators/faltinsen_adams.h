#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "integrators/explicit_stepper.h"
#include "integrators/fits.h"
#include "integrators/history.h"
#include "integrators/inlining.h"
#include "integrators/option.h"
#include "integrators/recent_motions.h"
#include "integrators/runge_kutta_munthe_kaas.h"
#include "integrators/runge_kutta_tableau.h"

// The k-step Adams-Bashforth method of Faltinsen, Marthinsen & Munthe-Kaas (Applied Numerical Mathematics 39, 2001,
// 349-365), k = 1, ..., 6, of order k: the classical method in canonical coordinates about q_n, which move with every
// step. With q(t) = q_n o exp(u~(t)), u' = T^{-1}(u) v,
//
//   u_{n+1} = h sum_{i=1}^k b_i T^{-1}(u_{n+1-i}) v_{n+1-i},   u_{n+1-i} = log(q_n^{-1} o q_{n+1-i}),  u_n = 0
//   q_{n+1} = q_n o exp(u_{n+1}~),   v_{n+1} = v_n + h sum_{i=1}^k b_i v'_{n+1-i}
//
// u_{n-1} is minus the last u_{n+1}; the others are -log(q_{n+1-i}^{-1} o q_n), a product and a logarithm each, of
// which the last spans k - 1 steps: together they turn by less than pi, where k > 2. One evaluation of the force a
// step.

namespace liebench {

// b_1, ..., b_k [Hairer, Norsett & Wanner 1993, Solving ODE I, III.1, (1.5)].
inline constexpr int most_adams_steps = 6;
inline constexpr std::array<std::array<Fraction, most_adams_steps>, most_adams_steps> adams_bashforth{
    {{{{1, 1}}},
     {{{3, 2}, {-1, 2}}},
     {{{23, 12}, {-4, 3}, {5, 12}}},
     {{{55, 24}, {-59, 24}, {37, 24}, {-3, 8}}},
     {{{1901, 720}, {-1387, 360}, {109, 30}, {-637, 360}, {251, 720}}},
     {{{4277, 1440}, {-2641, 480}, {4991, 720}, {-3649, 720}, {959, 480}, {-95, 288}}}}};

template <MechanicalSystem S, class Audit>
class FaltinsenAdamsStepper : public BasicExplicitStepper<S, Audit> {
  using Base = BasicExplicitStepper<S, Audit>;

 public:
  using typename Base::T;

  FaltinsenAdamsStepper(const S& system, int k)
      : Base(system),
        k_(k),
        curved_(has_commutators(system)),
        velocities_(std::max(k - 1, 1), zero_velocity(system)),
        accelerations_(std::max(k - 1, 1), zero_velocity(system)),
        motions_(system, k - 1),
        last_step_(zero_velocity(system)) {
    for (std::size_t i = 0; i < std::size_t(k); ++i)
      weights_[i] = value_of<T>(adams_bashforth[std::size_t(k - 1)][i]);
    angles_.fill(0.0);
  }

  int steps() const { return k_; }
  int starting_points() const { return k_; }

  // From q_0, ..., q_{k-1} and v_0, ..., v_{k-1}.
  StepResult start(const T& h, std::span<const SolutionPoint<S>> points) {
    Base::begin(h, points[std::size_t(k_ - 1)]);
    if (k_ == 1) return {};
    for (const SolutionPoint<S>& p : points)
      // The logarithms below are those of the motion only while it turns by less than pi in a step.
      if (const Outcome outcome = outcome_of_turn(Base::system_, Velocity<S>(h * p.v));
          outcome != Outcome::ok)
        return {outcome};
    const auto group = group_of(Base::system_);
    for (std::size_t j = 0; j + 1 < std::size_t(k_); ++j) {
      Velocity<S> F;
      const Outcome outcome = Base::acceleration(points[j].t, points[j].q, points[j].v, F);
      if (outcome != Outcome::ok) return {outcome};
      const Configuration<S> motion = group.compose(group.inverse(points[j].q), points[j + 1].q);
      const Velocity<S> step = group.log(motion);
      keep(points[j].v, F, step, motion, to_double(group.rotation_angle(step)));
    }
    return {};
  }

  StepResult step() {
    return inlined_step<S>([this] { return take_step(); });
  }

 private:
  StepResult take_step() {
    const auto group = group_of(Base::system_);
    Velocity<S> F;
    if (const Outcome outcome = Base::acceleration(Base::t_, Base::q_, Base::velocity_, F);
        outcome != Outcome::ok)
      return {outcome};
    if (const Outcome outcome = outcome_of_angle(angle_of_logarithms()); outcome != Outcome::ok)
      return {outcome};
    Velocity<S> u, change;
    set(u, weights_[0] * Base::velocity_);
    set(change, weights_[0] * F);
    for (int i = 1; i < k_; ++i) {
      const T& b = weights_[std::size_t(i)];
      set(u, u + b * coordinate_rate(group, i));
      set(change, change + b * accelerations_[i - 1]);
    }
    set(u, Base::h_ * u);
    const double angle = to_double(group.rotation_angle(u));
    if (const Outcome outcome = outcome_of_angle(angle); outcome != Outcome::ok) return {outcome};
    const Configuration<S> motion = group.exp(u);
    const Velocity<S> before = Base::velocity_;
    set(change, before + Base::h_ * change);
    const StepResult result = Base::move_to(group.compose(Base::q_, motion), change);
    if (result.outcome == Outcome::ok) keep(before, F, u, motion, angle);
    return result;
  }

  // T^{-1}(u_{n-i}) v_{n-i}
  template <class Group>
  Velocity<S> coordinate_rate(const Group& group, int i) const {
    const Velocity<S>& v = velocities_[i - 1];
    if constexpr (may_have_commutators<S>())
      if (curved_) {
        const Velocity<S> back = i == 1 ? last_step_ : Velocity<S>(group.log(motions_.over(i)));
        return group.tangent_inverse_times(-back, v);
      }
    return v;
  }

  // By how much the steps of the longest logarithm turn together; of none, 0.
  double angle_of_logarithms() const {
    double sum = 0.0;
    if (k_ > 2)
      for (const double angle : angles_) sum += angle;
    return sum;
  }

  // v_n, v'_n, and the step from q_n.
  void keep(const Velocity<S>& v, const Velocity<S>& F, const Velocity<S>& step,
            const Configuration<S>& motion, double angle) {
    if (k_ == 1) return;
    velocities_.push(v);
    accelerations_.push(F);
    if (!curved_) return;
    set(last_step_, step);
    motions_.push(motion);
    for (std::size_t i = std::size_t(k_ - 2); i > 0; --i) angles_[i] = angles_[i - 1];
    angles_[0] = angle;
  }

  int k_;
  bool curved_;
  std::array<T, std::size_t(most_adams_steps)> weights_;
  // v_{n-1}, ... and v'_{n-1}, ...
  History<Velocity<S>, most_adams_steps - 1> velocities_, accelerations_;
  RecentMotions<S, most_adams_steps - 1> motions_;
  Velocity<S> last_step_;                                         // log(q_{n-1}^{-1} o q_n)
  std::array<double, std::size_t(most_adams_steps - 1)> angles_;  // of the last k - 1 steps
};

struct FaltinsenAdams {
  static constexpr std::string_view name = "faltinsen_adams";
  static constexpr std::string_view summary =
      "explicit k-step Adams-Bashforth method of Faltinsen, Marthinsen & Munthe-Kaas in moving coordinates";
  static constexpr Fits fits = Fits::without_constraints;
  static constexpr auto option_list = std::to_array<OptionInfo>({
      steps_option(most_adams_steps),
  });
  static std::string title(const OptionValues& values) {
    return "Faltinsen Adams, k = " + std::to_string(values.integer("k"));
  }
  static ConvergenceOrders orders(const OptionValues& values) { return same_order(values.integer("k")); }

  struct Options {
    int k = 2;
  };
  static Options options(const OptionValues& values) { return {.k = values.integer("k")}; }

  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options& options, const S& system, Visitor&& visit) {
    return visit(FaltinsenAdamsStepper<S, Audit>(system, options.k));
  }
};

}  // namespace liebench
