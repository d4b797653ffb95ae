#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "groups/decimal.h"
#include "groups/entrywise.h"
#include "integrators/affine_closure.h"
#include "integrators/audit.h"
#include "integrators/basic_stepper.h"
#include "integrators/consistent_projection.h"
#include "integrators/fits.h"
#include "integrators/form.h"
#include "integrators/history.h"
#include "integrators/inlining.h"
#include "integrators/option.h"
#include "integrators/starting_values.h"

// The Lie group generalized-alpha method [Bruels & Cardona 2010; Arnold, Bruels & Cardona 2015], of order 2, with the
// acceleration-like variable a ~ v'(t_n + (alpha_m - alpha_f) h):
//
//   q_{n+1} = q_n o exp(h Dq~),   Dq = v_n + (1/2 - beta) h a_n + beta h a_{n+1}
//   v_{n+1} = v_n + (1 - gamma) h a_n + gamma h a_{n+1}
//   (1 - alpha_m) a_{n+1} + alpha_m a_n = (1 - alpha_f) v'_{n+1} + alpha_f v'_n
//   M v'_{n+1} = -g - B^T lambda_{n+1},   Phi(q_{n+1}) = 0

namespace liebench {

// The parameters of Chung & Hulbert 1993 for the spectral radius rho_inf at infinity.
template <class T>
struct GeneralizedAlphaParameters {
  T alpha_m, alpha_f, beta, gamma;
  explicit GeneralizedAlphaParameters(const T& rho)
      : alpha_m((T(2.0) * rho - T(1.0)) / (rho + T(1.0))),
        alpha_f(rho / (rho + T(1.0))),
        beta(T(1.0) / ((rho + T(1.0)) * (rho + T(1.0)))),
        gamma((T(3.0) - rho) / (T(2.0) * (rho + T(1.0)))) {}

  // Newmark's: beta and gamma as for rho = 1, v' at t_{n+1} alone, and so a = v'.
  static GeneralizedAlphaParameters average_acceleration() {
    GeneralizedAlphaParameters p(T(1.0));
    p.alpha_m = p.alpha_f = T(0.0);
    return p;
  }
  bool takes_accelerations_for_a() const { return to_double(alpha_m) == 0.0 && to_double(alpha_f) == 0.0; }
};

struct GeneralizedAlpha {
  static constexpr std::string_view name = "generalized_alpha";
  static constexpr std::string_view summary =
      "Lie group generalized-alpha method of Bruels & Cardona, order 2, with controlled numerical damping";
  static constexpr Fits fits = Fits::every_system;
  static constexpr auto option_list = std::to_array<OptionInfo>({
      {.name = "rho_inf",
       .kind = OptionKind::real,
       .fallback = 0.9,
       .least = 0.0,
       .most = 1.0,
       .meaning = "spectral radius at infinity: 1 no damping, 0 the strongest"},
      modified_start_option,
      form_option,
      safeguard_option,
  });

  static std::string title(const OptionValues& values) {
    return "generalized-alpha, rho_inf = " + decimal_text(values.real("rho_inf"));
  }
  // Without damping an error of lambda in the first step of the index-3 form stays, whatever the step size is.
  static ConvergenceOrders orders(const OptionValues& values) {
    const bool stays = values.real("rho_inf") == 1.0 && values.choice_or("form", "") == "index3" &&
                       !values.boolean_or("modified_start", false);
    return {2, 2, stays ? 0 : 2};
  }
  static bool symmetric(const OptionValues& values) {
    return values.real("rho_inf") == 1.0 && !values.has("form");
  }

  struct Options {
    double rho_inf = 0.9;
    bool modified_start = false;
    Form form = Form::index3;
    bool safeguard = false;
  };
  static Options options(const OptionValues& values) {
    return {.rho_inf = values.real("rho_inf"),
            .modified_start = values.boolean_or("modified_start", false),
            .form = form_of(values.choice_or("form", "")),
            .safeguard = values.boolean_or("safeguard", false)};
  }

  template <MechanicalSystem S, Form form, class Audit = NoAudit>
  class Stepper;

  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options& options, const S& system, Visitor&& visit) {
    return with_form<S>(options.form, [&]<Form form>(FormConstant<form>) {
      return visit(Stepper<S, form, Audit>(system, options));
    });
  }
};

template <MechanicalSystem S, Form form, class Audit>
class GeneralizedAlpha::Stepper : public BasicStepper<S, form, Audit> {
  using Base = BasicStepper<S, form, Audit>;

 public:
  using Base::system;
  using typename Base::Group;
  using typename Base::T;
  int steps() const { return 1; }
  int starting_points() const { return 1; }

  Stepper(const S& system, const Options& options)
      : Stepper(system, GeneralizedAlphaParameters<T>(decimal<T>(options.rho_inf)), options.safeguard) {
    modified_start_ = options.modified_start;
  }
  Stepper(const S& system, const GeneralizedAlphaParameters<T>& parameters, bool safeguard)
      : Base(system, safeguard),
        parameters_(parameters),
        acceleration_(zero_velocity(system)),
        a_(acceleration_),
        changes_(3, acceleration_),
        scaled_lambdas_(3, zero_multipliers(system)) {}

  // q_0, v_0 and consistent v'_0, lambda_0; a_0 = v'_0 + (alpha_m - alpha_f) h v''_0, of second order, with h v''_0 from
  // consistent accelerations a step before and after t_0.
  StepResult start(const T& h, std::span<const SolutionPoint<S>> points) {
    h_ = h;
    t_ = points[0].t;
    q_ = points[0].q;
    velocity_ = points[0].v;
    acceleration_ = points[0].acceleration;
    lambda_ = points[0].lambda;
    a_ = acceleration_;
    if (parameters_.takes_accelerations_for_a()) return {};
    std::array<Velocity<S>, 2> around;
    const auto group = group_of(system());
    const T width = Base::safeguard_ ? width_of_start(h) : h;
    for (const int side : {0, 1}) {
      const T s = side == 0 ? T(-width) : width;
      const Velocity<S> step = s * velocity_ + (s * s / T(2.0)) * acceleration_;
      const auto a = consistent_dynamics(system(), T(t_ + s), group.compose(q_, group.exp(step)),
                                         Velocity<S>(velocity_ + s * acceleration_), newton_.audit());
      if (!a) return {Outcome::singular_matrix};
      around[std::size_t(side)] = a->acceleration;
    }
    Velocity<S> scaled_jerk = (around[1] - around[0]) / T(2.0);  // h v''_0
    if (Base::safeguard_) scaled_jerk *= h / width;
    const T shift = parameters_.alpha_m - parameters_.alpha_f;
    a_ = acceleration_ + shift * scaled_jerk;
    if constexpr (S::constraints != 0 && form == Form::index3)
      if (modified_start_) return perturb_velocity(scaled_jerk, shift);
    return {};
  }

  StepResult step() {
    return inlined_step<S>([this] { return take_step(); });
  }

 private:
  StepResult take_step() {
    Velocity<S> change = changes_.size() > 0 ? changes_.extrapolated() : zero_velocity(system());
    Multipliers<S> scaled_lambda;
    if constexpr (S::constraints != 0)
      scaled_lambda =
          scaled_lambdas_.size() > 0 ? scaled_lambdas_.extrapolated() : Multipliers<S>(h_ * lambda_);
    typename Base::Point point;
    const StepResult result = Base::advance(next_closure(), change, scaled_lambda, point);
    if (result.outcome != Outcome::ok) return result;
    set(acceleration_, point.values.scaled_acceleration / h_);
    // d = beta h (a_{n+1} - a_n)
    set(a_, a_ + point.change / (parameters_.beta * h_));
    changes_.push(point.change);
    if constexpr (S::constraints != 0) scaled_lambdas_.push(scaled_lambda);
    return result;
  }

  using Base::h_;
  using Base::lambda_;
  using Base::newton_;
  using Base::q_;
  using Base::t_;
  using Base::velocity_;

  // How far before and after t_0 the accelerations are taken: a step, unless the initial acceleration would turn a body by pi and more
  // in it (a stiff spring that is not at rest), where they would say nothing of t_0.
  T width_of_start(const T& h) const {
    T width = h;
    for (int halvings = 0; halvings < 64; ++halvings, width /= T(2.0)) {
      const Velocity<S> forth = width * velocity_ + (width * width / T(2.0)) * acceleration_;
      const Velocity<S> back = (width * width / T(2.0)) * acceleration_ - width * velocity_;
      if (Base::turns_by_less_than_pi(forth) && Base::turns_by_less_than_pi(back)) break;
    }
    return width;
  }

  // With d = Dq - v_n - h a_n / 2 = beta h (a_{n+1} - a_n):
  //   v_{n+1} = v_n + h a_n + (gamma / beta) d
  //   h v'_{n+1} = h (a_n - alpha_f v'_n) / (1 - alpha_f) + (1 - alpha_m) / (beta (1 - alpha_f)) d
  AffineClosure<S> next_closure() const {
    const auto& p = parameters_;
    const T rest = T(1.0) - p.alpha_f;
    AffineClosure<S> closure;
    closure.velocity_slope = p.gamma / p.beta;
    closure.acceleration_slope = (T(1.0) - p.alpha_m) / (p.beta * rest);
    set(closure.base_increment, velocity_ + (h_ / T(2.0)) * a_);
    set(closure.velocity, velocity_);
    set(closure.velocity_change, h_ * a_);
    set(closure.scaled_acceleration, (h_ / rest) * (a_ - p.alpha_f * acceleration_));
    return closure;
  }

  // v_0 += Dv, [M B^T; B 0] [Dv; .] = [0; B l / h] with the local error of a step,
  // l / h = (1 - 6 beta - 3 (alpha_m - alpha_f)) / 6 h^2 v''_0 + h^2 / 12 [v_0, v'_0]
  StepResult perturb_velocity(const Velocity<S>& scaled_jerk, const T& shift) requires ConstrainedSystem<S> {
    const T factor = (T(1.0) - T(6.0) * parameters_.beta - T(3.0) * shift) / T(6.0);
    const Velocity<S> local_error =
        factor * h_ * scaled_jerk +
        (h_ * h_ / T(12.0)) * group_of(system()).commutator(velocity_, acceleration_);
    const Multipliers<S> b = constraint_product(system(), q_, local_error);
    const auto solution = solve_saddle_point(system(), q_, zero_velocity(system()), b, newton_.audit());
    if (!solution) return {Outcome::singular_matrix};
    velocity_ += solution->x;
    return {};
  }

  bool modified_start_ = false;
  GeneralizedAlphaParameters<T> parameters_;
  Velocity<S> acceleration_;                   // v'_n
  Velocity<S> a_;                              // a_n
  History<Velocity<S>, 3> changes_;            // beta h (a_n - a_{n-1}), ...: for the prediction
  History<Multipliers<S>, 3> scaled_lambdas_;  // h lambda_n, ...: for the prediction
};

}  // namespace liebench
