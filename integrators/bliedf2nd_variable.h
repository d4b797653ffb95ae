#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "groups/entrywise.h"
#include "integrators/affine_closure.h"
#include "integrators/audit.h"
#include "integrators/basic_stepper.h"
#include "integrators/bdf_stability.h"
#include "integrators/fits.h"
#include "integrators/form.h"
#include "integrators/history.h"
#include "integrators/inlining.h"
#include "integrators/option.h"
#include "integrators/order_control.h"
#include "integrators/starting_values.h"
#include "integrators/step_control.h"
#include "integrators/step_differences.h"

// BLieDF2nd with variable steps h_1 = t_{n+1} - t_n, h_2 = t_n - t_{n-1}, ..., with middles m_i, and with variable
// order k <= 4:
//
//   q_{n+1} = q_n o exp(h_1 Dq_n~)
//   sum_{i=1}^k gamma_i Dq_{n+1-i} = v_{n+1} + (S_0 [v, v'] + S_1 [v, v'']) / 12           v, v', v'' at t_{n+1}
//   v'_{n+1} = sum_{i=1}^k gamma_i (v_{n+2-i} - v_{n+1-i}) / h_i = -M^{-1} (g + B^T lambda)
//
// with the gamma_i of integrators/step_differences.h and
//
//   S_0 = sum_{i=1}^k gamma_i h_i^2,   S_1 = sum_{i=1}^k gamma_i h_i^2 (m_i - t_{n+1})
//
// for by the Magnus expansion an increment is the mean of v over its step and h_i^2 / 12 [v, v'](m_i), to O(h_i^4).
// In constant steps S_0 = h^2 for k >= 2, and S_1 = 0 for k >= 3, which is eq. (22); in others S_1 is of O(h^3), and
// order 4 needs it.
//
// [v, v'] and [v, v''] are explicit as in eq. (22): v_n, and the line through the mean accelerations of the last step
// and, for k >= 3, of that two before it; for k <= 2 that of the last step.
//
// The Newton iteration is that of the other methods, down to round-off, whatever the tolerance is. In double, and
// with a constraint, the velocity of a step is known to some eps |q| / h: a tolerance below 1e-11 is below that.

namespace liebench {

struct BLieDF2ndVariable {
  static constexpr std::string_view name = "bliedf2nd_variable";
  static constexpr std::string_view summary =
      "BLieDF2nd of Wieloch & Arnold with steps and orders 1, ..., 4 by a tolerance";
  static constexpr Fits fits = Fits::every_system;
  static constexpr int most_order = 4;
  static constexpr auto option_list = std::to_array<OptionInfo>({
      tolerance_option,
      {.name = "max_order",
       .kind = OptionKind::integer,
       .fallback = most_order,
       .least = 1,
       .most = most_order,
       .meaning = "the highest order that the method may choose"},
      form_option,
  });

  static std::string title(const OptionValues& values) {
    return "BLieDF2nd, variable step, order up to " + std::to_string(values.integer("max_order"));
  }
  static ConvergenceOrders orders(const OptionValues& values) {
    const int k = values.integer("max_order");
    return {.q = k, .v = k, .lambda = k, .estimate = k + 1, .first_steps = 1};
  }

  struct Options {
    double tolerance = 1e-6;
    int max_order = most_order;
    Form form = Form::index3;
  };
  static Options options(const OptionValues& values) {
    return {.tolerance = values.real("tolerance"),
            .max_order = values.integer("max_order"),
            .form = form_of(values.choice_or("form", ""))};
  }

  template <MechanicalSystem S, Form form, class Audit>
  class Stepper;

  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options& options, const S& system, Visitor&& visit) {
    return with_form<S>(options.form, [&]<Form form>(FormConstant<form>) {
      return visit(Stepper<S, form, Audit>(system, options));
    });
  }
};

template <MechanicalSystem S, Form form, class Audit>
class BLieDF2ndVariable::Stepper : public BasicStepper<S, form, Audit> {
  using Base = BasicStepper<S, form, Audit>;

 public:
  using Base::system;
  using typename Base::T;
  int steps() const { return 1; }
  int starting_points() const { return 1; }

  Stepper(const S& system, const Options& options)
      : Base(system, true),
        tolerance_(options.tolerance),
        max_order_(options.max_order),
        control_(options.max_order),
        differences_(std::span<const T>()),
        zero_(zero_velocity(system)),
        increment_(zero_),
        lag_(zero_),
        correction_(zero_),
        error_of_v_(zero_),
        mean_accelerations_(most_past, zero_),
        increment_changes_(most_past - 1, zero_),
        lambda_slopes_(most_past, zero_multipliers(system)) {}

  // The interval [t_0, t_0 + length], from q_0, v_0 and v'_0. The history begins with the tangent: a step before t_0
  // with the constant acceleration v'_0, which predictions and estimates of errors take, and no formula of a step.
  StepResult start(const T& length, std::span<const SolutionPoint<S>> points) {
    const SolutionPoint<S>& first = points[0];
    t_ = first.t;
    t_end_ = t_ + length;
    shortest_ = shortest_part * std::abs(to_double(length));
    q_ = first.q;
    velocity_ = first.v;
    lambda_ = first.lambda;
    control_ = OrderControl(max_order_);
    if (length == T(0.0)) return {};
    const double h = first_step(to_double(length), first.acceleration);
    if (!(std::abs(h) > 0.0)) return {Outcome::non_finite};
    h_ = dividing(h);
    past_steps_.fill(h_);
    mean_accelerations_ = {most_past, zero_};
    increment_changes_ = {most_past - 1, zero_};
    lambda_slopes_ = {most_past, zero_multipliers(system())};
    mean_accelerations_.push(first.acceleration);
    set(lag_, (h_ / T(-2.0)) * first.acceleration);
    set(increment_, velocity_ + lag_);
    return {};
  }
  bool finished() const { return t_ == t_end_; }
  // k of the last step.
  int order() const { return order_; }

  // One step that is accepted.
  StepResult step() {
    return inlined_step<S>([this] { return take_step(); });
  }

 private:
  StepResult take_step() {
    const T t = t_;
    const Configuration<S> q = q_;
    const Velocity<S> v = velocity_;
    const Multipliers<S> lambda = lambda_;
    keep_below_half_a_turn();
    for (;;) {
      const bool last = !(abs_of(t_end_ - t_) > T(1.5) * abs_of(h_));
      if (last) h_ = t_end_ - t_;
      // No time passes any more.
      if (!last && t_ + h_ == t_) return {Outcome::step_limit};
      order_ = control_.order();
      prepare_formula();
      const AffineClosure<S> closure = next_closure();
      renew_matrix(closure.velocity_slope);
      Velocity<S> change = predicted_slope(order_, mean_accelerations_);
      set(change, (h_ * change - closure.velocity_change) / closure.velocity_slope);
      Multipliers<S> scaled_lambda;
      if constexpr (S::constraints != 0) {
        set(scaled_lambda, h_ * lambda_);
        if (const int degree = std::min(order_, lambda_slopes_.size()); degree > 0)
          set(scaled_lambda, scaled_lambda + (h_ * h_) * predicted_slope(degree, lambda_slopes_));
      }
      typename Base::Point point;
      const StepResult result = Base::advance(closure, change, scaled_lambda, point);
      double factor = 0.0;
      if (result.outcome == Outcome::ok) {
        OrderControl::Errors errors = errors_of(point, change);
        if (errors.same <= 1.0) {
          if (order_ >= a_stable_order && control_.would_raise(errors) &&
              unstable_though_damped(order_ + 1, OrderControl::most * to_double(h_)))
            errors.higher = OrderControl::Errors{}.higher;
          if (last) t_ = t_end_;
          remember(point, change, lambda);
          lengthen(control_.accept(errors));
          return result;
        }
        t_ = t;
        q_ = q;
        set(velocity_, v);
        set(lambda_, lambda);
        factor =
            control_.reject(errors, order_ > a_stable_order && unstable_though_damped(order_, to_double(h_)));
      } else {
        // A shorter step may do, if there is one to speak of.
        if (std::abs(to_double(h_)) < shortest_) return result;
        factor = control_.fail();
      }
      Base::audit().rejection();
      h_ = dividing(factor * to_double(h_));
    }
  }

  using Base::h_;
  using Base::lambda_;
  using Base::newton_;
  using Base::q_;
  using Base::t_;
  using Base::velocity_;
  using Differences = StepDifferences<T>;
  template <class Value>
  using PerSlope = std::array<Value, Differences::most>;

  static constexpr int most_past = int(Differences::most) - 1;
  // The highest one.
  static constexpr int a_stable_order = 2;
  static constexpr double shortest_part = 1e-12;
  static constexpr double longest_turn = 0.9 * std::numbers::pi;

  // The longest step up to h that divides what is left of the interval: so no step is cut at its end, which in the
  // index-3 form would cost the digits of lambda.
  T dividing(double h) const {
    const T left = t_end_ - t_;
    return left / T(std::max(std::ceil(to_double(left) / h - 1e-6), 1.0));
  }

  // In proportion to the square root of the tolerance, as the error of order 1 asks for, of the time in which the
  // velocity changes by itself, or the body turns by a radian [Hairer, Norsett & Wanner, II.4]. Zero, or no number,
  // for values that are none.
  double first_step(double length, const Velocity<S>& acceleration) const {
    const double v = to_double(largest_entry(velocity_)), a = to_double(largest_entry(acceleration));
    const double rate = v + a / (1.0 + v);
    const double h = 0.1 * std::sqrt(std::min(tolerance_, 1e-2)) / std::max(rate, 1e-6);
    return std::copysign(std::min(h, std::abs(length)), length);
  }

  double longest_step() const {
    const double rate = to_double(T(group_of(system()).rotation_angle(velocity_)));
    return rate > 0.0 ? longest_turn / rate : std::numeric_limits<double>::infinity();
  }
  void keep_below_half_a_turn() {
    const double h = to_double(h_), longest = longest_step();
    if (!(std::abs(h) > 1.05 * longest)) return;
    h_ = dividing(std::copysign(longest, h));
    control_.step_changed();
  }
  void lengthen(double factor) {
    if (factor <= 1.0 || finished()) return;
    const double h = to_double(h_);
    const T longer = dividing(std::copysign(std::min(factor * std::abs(h), longest_step()), h));
    if (to_double(longer) / h < OrderControl::worthwhile) return;
    h_ = longer;
    control_.step_changed();
  }

  // The coefficients of the step, unless they are those of the last one.
  void prepare_formula() {
    PerSlope<T> steps;
    steps[0] = h_;
    std::copy(past_steps_.begin(), past_steps_.end(), steps.begin() + 1);
    if (order_ == prepared_order_ && steps == prepared_steps_) return;
    differences_ = Differences(steps);
    prepared_order_ = order_;
    prepared_steps_ = steps;
    gamma_.fill(T(0.0));
    S_0_ = S_1_ = T(0.0);
    for (std::size_t l = 0; l < std::size_t(order_); ++l) {
      for (std::size_t i = 0; i <= l; ++i) gamma_[i] = gamma_[i] + differences_.D[l][i];
      S_0_ = S_0_ + differences_.square_moment[l];
      S_1_ = S_1_ + differences_.cubic_moment[l];
    }
    gammas_less_one_ = sums(gamma_, T(-1.0));
  }
  // start + x_1, start + x_1 + x_2, ...
  static PerSlope<T> sums(const PerSlope<T>& x, const T& start) {
    PerSlope<T> all;
    T sum = start;
    for (std::size_t i = 0; i < x.size(); ++i) {
      sum = sum + x[i];
      all[i] = sum;
    }
    return all;
  }
  static auto from(const PerSlope<T>& weights, std::size_t i) {
    return [&weights, i](int j) -> const T& { return weights[i + std::size_t(j)]; };
  }

  // The Newton matrix is that of a step size and of a gamma_1. With one of others the iteration would take more
  // corrections than a new matrix costs.
  void renew_matrix(const T& slope) {
    const auto differs = [](const T& x, const T& y) {
      return !(std::abs(to_double(x) - to_double(y)) < 0.02 * std::abs(to_double(y)));
    };
    if (!differs(h_, matrix_step_) && !differs(slope, matrix_slope_)) return;
    newton_.outdate();
    matrix_step_ = h_;
    matrix_slope_ = slope;
  }

  // x_1 of a sequence by its x_2, ..., x_{l+1} and phi_l = 0.
  template <class Slopes>
  auto predicted_slope(int l, const Slopes& past) const {
    const auto& D = differences_.D[std::size_t(l)];
    std::remove_cvref_t<decltype(past[0])> sum;
    set(sum, D[1] * past[0]);
    past.add_weighted(1, l, from(D, 1), sum);
    set(sum, sum / T(-D[0]));
    return sum;
  }

  // v' and v'' at t_{n+1} by the line through the mean accelerations of the i-th and the j-th step.
  struct Accelerations {
    Velocity<S> first, second;
  };
  Accelerations line(const Velocity<S>& x_i, std::size_t i, const Velocity<S>& x_j, std::size_t j) const {
    const auto& m = differences_.middle;
    Accelerations a;
    set(a.second, (x_i - x_j) / T(m[i - 1] - m[j - 1]));
    set(a.first, x_i - m[i - 1] * a.second);
    return a;
  }

  // In differences: with d = Dq_n - Dq_{n-1} and sum gamma_i = 1,
  //   v_{n+1} - v_n = gamma_1 d + (Dq_{n-1} - v_n)
  //                   + sum_{i>=2} (gamma_1 + ... + gamma_i - 1) (Dq_{n+1-i} - Dq_{n-i}) - correction
  AffineClosure<S> next_closure() {
    AffineClosure<S> closure;
    closure.velocity_slope = gamma_[0];
    closure.acceleration_slope = gamma_[0] * gamma_[0];
    set(closure.base_increment, increment_);
    set(closure.velocity, velocity_);
    Velocity<S>& change = closure.velocity_change;
    set(change, lag_);
    increment_changes_.add_weighted(0, order_ - 2, from(gammas_less_one_, 1), change);
    if constexpr (may_have_commutators<S>()) {
      if (has_commutators(system())) {
        const auto& x = mean_accelerations_;
        Velocity<S> weighted;
        if (order_ < 3) {
          set(weighted, S_0_ * x[0]);
        } else {
          const Accelerations a = line(x[0], 2, x[2], 4);
          set(weighted, S_0_ * a.first + S_1_ * a.second);
        }
        const Velocity<S> commutator = group_of(system()).commutator(velocity_, weighted);
        set(correction_, commutator / T(12.0));
        set(change, change - correction_);
      }
    }
    Velocity<S>& acceleration = closure.scaled_acceleration;
    set(acceleration, (gamma_[0] / h_) * change);
    mean_accelerations_.add_weighted(0, order_ - 1, from(gamma_, 1), acceleration);
    set(acceleration, h_ * acceleration);
    return closure;
  }

  // The errors of a step of order k are those of its formulas by the formulas of order k + 1, over alpha_0, which is
  // gamma_1 / h_1:
  //
  //   of v    phi_k of the mean accelerations
  //   of q    h_1 (phi_k of the increments without their h_i^2 / 12 [v, v'](m_i), and the error of the correction)
  //
  // with [v, v'] and [v, v''] by v_{n+1}.
  //
  // In the index-3 form the constraint fixes Dq_n, and so, whatever v was before, the part of v_{n+1} that is normal
  // to it, with an error of O(h^k) that changes where the steps do. It is one of the formula, not of a motion that
  // goes astray: the prediction misses it in any step, however short. What is controlled is the tangential part.
  OrderControl::Errors errors_of(const typename Base::Point& point, const Velocity<S>& change) {
    const Velocity<S>& v = point.values.velocity;
    Velocity<S> x;
    set(x, point.values.velocity_change / h_);
    Velocity<S> first, second, of_correction;  // [v, v'] / 12, [v, v''] / 12
    bool commutators = false;
    if constexpr (may_have_commutators<S>()) {
      commutators = has_commutators(system());
      if (commutators) {
        const std::size_t other = order_ < 3 ? 2 : 3;
        const Accelerations a = line(x, 1, mean_accelerations_[int(other) - 2], other);
        const auto group = group_of(system());
        first = group.commutator(v, a.first);
        second = group.commutator(v, a.second);
        set(first, first / T(12.0));
        set(second, second / T(12.0));
        set(of_correction, S_0_ * first + S_1_ * second - correction_);
      }
    }
    const auto error = [&](int order) {
      const auto l = std::size_t(order);
      const auto& weights = differences_.D[l];
      const PerSlope<T> partial_sums = sums(weights, T(0.0));
      T gamma_1(0.0);
      for (std::size_t i = 0; i < l; ++i) gamma_1 = gamma_1 + differences_.D[i][0];
      const T factor = h_ / gamma_1;
      Velocity<S> of_q, of_v;
      set(of_q, partial_sums[0] * change);
      increment_changes_.add_weighted(0, order - 1, from(partial_sums, 1), of_q);
      if (commutators)
        set(of_q, of_q - differences_.square_moment[l] * first - differences_.cubic_moment[l] * second -
                      of_correction);
      set(of_q, (factor * h_) * of_q);
      set(of_v, weights[0] * x);
      mean_accelerations_.add_weighted(0, order, from(weights, 1), of_v);
      set(of_v, factor * of_v);
      if constexpr (S::constraints != 0 && !Base::stabilized)
        if (multiplier_size(system()) != 0)
          of_v = newton_.tangential_part(q_, of_v, T(gamma_[0] * gamma_[0]));
      if (order == order_) set(error_of_v_, of_v);
      return scaled_error<S>(of_q, of_v, v, tolerance_);
    };
    OrderControl::Errors errors{.same = error(order_)};
    const bool accepted = errors.same <= 1.0;
    if (order_ > 1 && (!accepted || control_.may_change())) errors.lower = error(order_ - 1);
    // phi_{k+1} takes k + 1 slopes before this one.
    if (order_ < max_order_ && accepted && control_.may_change() && increment_changes_.size() >= order_)
      errors.higher = error(order_ + 1);
    return errors;
  }

  // Orders above 2 are not stable for motions that are hardly damped: their error estimate then is the amplitude that the instability
  // keeps up, in steps that this amplitude bounds, and neither asks for the order that would let it die out (docs/theory.md, "Stiff
  // motions that are hardly damped"). The motion that an error is made of goes along it: x'' + 2 sigma x' + omega^2 x = 0 with
  //
  //   omega^2 = e . K e / e . M e,   2 sigma = e . D e / e . M e,   K e and D e by differences of forces
  //
  // Whether order k lets it grow in steps h, though by its own damping it would die out in what is left of the interval; for then
  // order 2 pays, whose steps are shorter until it has.
  [[gnu::noinline, gnu::cold]] bool unstable_though_damped(int k, double h) {
    const auto group = group_of(system());
    const Velocity<S>& e = error_of_v_;
    const double size = to_double(largest_entry(e));
    if (!(size > 0.0)) return false;
    const T difference(1e-6 / size);
    Velocity<S> along;
    set(along, difference * e);
    const Configuration<S> q = group.compose(q_, group.exp(along));
    const Velocity<S> force = system().force(t_, q_, velocity_);
    Velocity<S> of_stiffness = system().force(t_, q, velocity_);
    if constexpr (S::constraints != 0)
      if (multiplier_size(system()) != 0)
        of_stiffness += system().constraint_force(q, lambda_) - system().constraint_force(q_, lambda_);
    const Velocity<S> faster = velocity_ + along;
    const Velocity<S> of_damping = system().force(t_, q_, faster);
    const double mass = to_double(T(e.dot(system().momentum(q_, e))));
    const double square = to_double(T(e.dot(of_stiffness - force) / difference)) / mass;
    const double sigma = 0.5 * to_double(T(e.dot(of_damping - force) / difference)) / mass;
    const double left = std::abs(to_double(T(t_end_ - t_)));
    // Of its amplitude e^-5 would be left. Without a frequency it is no oscillation.
    if (!(sigma * left > 5.0 && square > sigma * sigma)) return false;
    return !bdf_is_stable(k, std::abs(h) * std::complex(-sigma, std::sqrt(square - sigma * sigma)));
  }

  void remember(const typename Base::Point& point, const Velocity<S>& change, const Multipliers<S>& lambda) {
    const Velocity<S>& velocity_change = point.values.velocity_change;
    set(lag_, lag_ + (change - velocity_change));
    set(increment_, increment_ + change);
    increment_changes_.push(change);
    Velocity<S> x;
    set(x, velocity_change / h_);
    mean_accelerations_.push(x);
    if constexpr (S::constraints != 0) {
      Multipliers<S> slope;
      set(slope, (lambda_ - lambda) / h_);
      lambda_slopes_.push(slope);
    }
    std::copy_backward(past_steps_.begin(), past_steps_.end() - 1, past_steps_.end());
    past_steps_[0] = h_;
  }

  double tolerance_;
  int max_order_;
  OrderControl control_;
  T t_end_ = T(0.0);
  double shortest_ = 0.0;
  int order_ = 1;
  // Of the formula: for which order and steps it was prepared, gamma_1 + ... + gamma_i - 1.
  int prepared_order_ = 0;
  PerSlope<T> prepared_steps_{};
  Differences differences_;
  PerSlope<T> gamma_{}, gammas_less_one_{};
  T S_0_ = T(0.0), S_1_ = T(0.0);
  T matrix_step_ = T(0.0), matrix_slope_ = T(0.0);  // of the step that the Newton matrix was formed for
  Velocity<S> zero_;
  std::array<T, std::size_t(most_past)> past_steps_{};     // h_2, h_3, ...
  Velocity<S> increment_;                                  // Dq_{n-1}
  Velocity<S> lag_;                                        // Dq_{n-1} - v_n
  Velocity<S> correction_;                                 // of the step, (S_0 [v, v'] + S_1 [v, v'']) / 12
  Velocity<S> error_of_v_;                                 // of the last step, by its own order
  History<Velocity<S>, most_past> mean_accelerations_;     // (v_n - v_{n-1}) / h_2, ...
  History<Velocity<S>, most_past - 1> increment_changes_;  // Dq_{n-1} - Dq_{n-2}, ...
  History<Multipliers<S>, most_past> lambda_slopes_;       // (lambda_n - lambda_{n-1}) / h_2, ...
};

}  // namespace liebench
