#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "integrators/fits.h"
#include "integrators/form.h"
#include "integrators/newton.h"
#include "integrators/option.h"
#include "integrators/outcome.h"
#include "integrators/radau_coefficients.h"
#include "integrators/radau_equation.h"
#include "integrators/radau_matrix.h"
#include "integrators/runge_kutta_munthe_kaas.h"
#include "integrators/starting_values.h"
#include "problems/system.h"

namespace liebench {

// Radau IIA with 3 stages in canonical coordinates about q_n, of order 5 and stiffly accurate (the step is its third stage)
// [Hairer & Wanner, Solving ODE II, IV.5, VII.4; Munthe-Kaas 1999]:
//
//   Theta_i = h sum_j a_ij K_j,  Q_i = q_n o exp(Theta_i~),  V_i = T(Theta_i) K_i + B(Q_i)^T eta_i
//   V_i = v_n + h sum_j a_ij v'_j,  M(Q_i) v'_i = -g(t_i, Q_i, V_i) - B(Q_i)^T Lambda_i,  Phi(Q_i) = 0
//   q_{n+1} = Q_3,  v_{n+1} = V_3,  lambda_{n+1} = Lambda_3
//
// with B(Q_i) V_i = 0 and the auxiliary multipliers eta_i in the stabilized index-2 form (Gear, Gupta & Leimkuhler 1985), without
// both in the index-3 form. Orders of q, v, lambda: 5, 3, 2 of index 3 [Hairer, Lubich & Roche 1989, theorem 6.4], 5, 5, 3
// stabilized.
struct Radau {
  static constexpr std::string_view name = "radau";
  static constexpr std::string_view summary =
      "Radau IIA in canonical coordinates of the step: implicit, 3 stages, order 5";
  static constexpr Fits fits = Fits::every_system;
  static constexpr auto option_list = std::to_array<OptionInfo>({form_option});

  static std::string title(const OptionValues&) { return "Radau IIA"; }
  // Without constraints there is no form.
  static ConvergenceOrders orders(const OptionValues& values) {
    if (!values.has("form")) return same_order(5);
    return options(values).form == Form::index3 ? ConvergenceOrders{5, 3, 2} : ConvergenceOrders{5, 5, 3};
  }

  struct Options {
    Form form = Form::index3;
  };
  static Options options(const OptionValues& values) { return {form_of(values.choice_or("form", ""))}; }

  template <MechanicalSystem S, Form form, class Audit>
  class Stepper;

  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options& options, const S& system, Visitor&& visit) {
    return with_form<S>(
        options.form, [&]<Form form>(FormConstant<form>) { return visit(Stepper<S, form, Audit>(system)); });
  }
};

template <MechanicalSystem S, Form form, class Audit>
class Radau::Stepper {
 public:
  using System = S;
  using T = typename S::Scalar;

  explicit Stepper(const S& system)
      : newton_(system),
        q_(group_of(system).identity()),
        velocity_(zero_velocity(system)),
        lambda_(zero_multipliers(system)),
        predicted_(Equation::unknowns(system)) {}

  int steps() const { return 1; }
  int starting_points() const { return 1; }
  const T& time() const { return t_; }
  const Configuration<S>& configuration() const { return q_; }
  const Velocity<S>& velocity() const { return velocity_; }
  const Multipliers<S>& multipliers() const { return lambda_; }
  const S& system() const { return newton_.system(); }
  const Audit& audit() const { return newton_.audit(); }
  Audit& audit() { return newton_.audit(); }

  // From q_0, v_0, v'_0 and lambda_0; the last two only predict the first step.
  StepResult start(const T& h, std::span<const SolutionPoint<S>> points) {
    h_ = h;
    t_ = points[0].t;
    q_ = points[0].q;
    velocity_ = points[0].v;
    lambda_ = points[0].lambda;
    predicted_.setConstant(T(0.0));
    for (int i = 0; i < Equation::stages; ++i) {
      Equation::velocity_part(predicted_, system(), i) =
          (coefficients_.c[std::size_t(i)] * h) * points[0].acceleration;
      if constexpr (S::constraints != 0) Equation::lambda_part(predicted_, system(), i) = h * lambda_;
    }
    return {};
  }

  StepResult step() {
    Unknowns z = predicted_;
    typename Equation::Point point;
    const T t = t_ + h_;
    const typename Equation::Start start{coefficients_, velocity_};
    const StepResult result = newton_.solve(t, h_, q_, start, z, point);
    if (result.outcome != Outcome::ok) return result;
    const auto& last = point.stage.back();
    if (const Outcome turned = outcome_of_turn(system(), last.angle); turned != Outcome::ok) return {turned};
    t_ = t;
    q_ = last.q;
    velocity_ = last.velocity;
    if constexpr (S::constraints != 0)
      lambda_ = Equation::lambda_part(z, system(), Equation::stages - 1) / h_;
    predict(z, point);
    return result;
  }

 private:
  using Equation = RadauEquation<S, form>;
  using Unknowns = typename Equation::Unknowns;
  using Kernel = NewtonKernel<S, form, Audit, Equation, typename RadauMatrixOf<S, form>::type>;

  // The next step, as the collocation polynomials of V and Lambda of this one go on; T(Theta_i) K_i - K_i, which starts from zero
  // in each step, as it was; eta = 0.
  void predict(const Unknowns& z, const typename Equation::Point& point) {
    constexpr auto stages = std::size_t(Equation::stages);
    predicted_.setConstant(T(0.0));
    for (int i = 0; i < Equation::stages; ++i) {
      const auto s = std::size_t(i);
      Velocity<S> change = Equation::velocity_part(z, system(), i) - point.velocity_change[s];
      if constexpr (Equation::stabilized)
        if (multiplier_size(system()) != 0) change += point.stabilization[s];
      for (std::size_t j = 0; j < stages; ++j)
        change += coefficients_.next_change[s][j] * point.velocity_change[j];
      Equation::velocity_part(predicted_, system(), i) = change;
      if constexpr (S::constraints != 0) {
        Multipliers<S> lambda = coefficients_.next_value[s][0] * Equation::lambda_part(z, system(), 0);
        for (std::size_t j = 1; j < stages; ++j)
          lambda += coefficients_.next_value[s][j] * Equation::lambda_part(z, system(), int(j));
        Equation::lambda_part(predicted_, system(), i) = lambda;
      }
    }
  }

  Kernel newton_;
  RadauCoefficients<T> coefficients_;
  T h_ = T(0.0);
  T t_ = T(0.0);
  Configuration<S> q_;
  Velocity<S> velocity_;
  Multipliers<S> lambda_;
  Unknowns predicted_;  // z of the next step
};

}  // namespace liebench
