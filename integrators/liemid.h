#pragma once

#include <array>
#include <string>
#include <string_view>

#include "integrators/fits.h"
#include "integrators/history.h"
#include "integrators/inlining.h"
#include "integrators/momentum_stepper.h"
#include "integrators/option.h"

// LIEMID [Krysl 2005, Explicit momentum-conserving integrator for dynamics of rigid bodies approximating the midpoint
// Lie algorithm], for rotations and, with Ad(exp(u~))^T = exp(ad(u)^T) where he has exp(-u~), for any group: the forces
// kick the momentum at both ends of a step, and between them a free body moves by the midpoint rule that keeps its
// spatial momentum,
//
//   P = p_n - h/2 f(q_n)
//   M w = Ad(exp(h w~ / 2))^T P,   q_{n+1} = q_n o exp(h w~)
//   p_{n+1} = Ad(exp(h w~))^T P - h/2 f(q_{n+1}),   p = M v
//
// with f of integrators/momentum_equation.h: one_step. The original, half_steps, moves the free body by two steps of
// h / 2. Both are symmetric, where f does not depend on v, and keep the spatial momentum to round-off where f = 0.

namespace liebench {

template <MechanicalSystem S, class Audit>
class LiemidStepper : public MomentumStepper<S, Audit, AdjointTransport> {
  using Base = MomentumStepper<S, Audit, AdjointTransport>;

 public:
  using Base::system;
  using typename Base::T;

  LiemidStepper(const S& system, int parts)
      : Base(system), parts_(parts), changes_{{{3, zero_velocity(system)}, {3, zero_velocity(system)}}} {}

  StepResult step() {
    return inlined_step<S>([this] { return take_step(); });
  }

 private:
  using Base::force_;
  using Base::h_;
  using Base::q_;
  using Base::t_;
  using Base::velocity_;

  StepResult take_step() {
    const T width = h_ / T(double(parts_)), t = t_ + h_, half = h_ / T(2.0);
    Configuration<S> q = q_;
    Velocity<S> turned = zero_velocity(system()), kicks = turned;
    std::array<Velocity<S>, 2> changes{turned, turned};
    Multipliers<S> none = zero_multipliers(system());
    typename Base::Closure closure{velocity_, system().momentum(q_, velocity_), half * force_};
    typename Base::Point point;
    for (int part = 0; part < parts_; ++part) {
      Velocity<S>& change = changes[std::size_t(part)];
      const auto& before = changes_[std::size_t(part)];
      if (before.size() > 0)
        set(change, before.extrapolated());
      else if (part == 0)
        set(change, Base::first_change_);
      const StepResult result = Base::solve(t, width, q, closure, change, none, point);
      if (result.outcome != Outcome::ok) return result;
      q = point.q;
      set(turned, turned + point.step);
      set(kicks, transported_change<AdjointTransport>(system(), point.step, point.momentum));
      closure = {point.values.velocity, point.momentum, -kicks};
    }
    if (!Base::turns_by_less_than_pi(turned)) return {Outcome::rotation_too_large};
    const Velocity<S> v_end = turned / half - velocity_;
    const Velocity<S> f = Base::force_without_gyroscopic_term(t, q, v_end);
    set(kicks, kicks - half * f);
    Velocity<S> v = turned;
    const StepResult result = Base::solve_mass(q, kicks, v);
    if (result.outcome != Outcome::ok) return result;
    set(v, v + closure.base_increment);
    for (int part = 0; part < parts_; ++part) changes_[std::size_t(part)].push(changes[std::size_t(part)]);
    Base::move_to(t, q, v, f);
    return result;
  }

  int parts_;
  // d of each part of the steps before: for the prediction.
  std::array<History<Velocity<S>, 3>, 2> changes_;
};

struct Liemid {
  static constexpr std::string_view name = "liemid";
  static constexpr std::string_view summary =
      "LIEMID of Krysl, order 2: keeps the spatial momentum of a free body; explicit in the forces";
  static constexpr Fits fits = Fits::without_constraints;
  static constexpr auto option_list = std::to_array<OptionInfo>({
      {.name = "variant",
       .kind = OptionKind::choice,
       .fallback = 0,
       .choices = {"one_step", "half_steps"},
       .meaning = "between two kicks of the forces one step of the midpoint rule, or two of half the size"},
  });

  static std::string title(const OptionValues& values) {
    return values.choice("variant") == "half_steps" ? "LIEMID, two half steps" : "LIEMID";
  }
  static ConvergenceOrders orders(const OptionValues&) { return same_order(2); }
  static bool symmetric(const OptionValues&) { return true; }

  enum class Variant { one_step, half_steps };
  struct Options {
    Variant variant = Variant::one_step;
  };
  static Options options(const OptionValues& values) {
    return {values.choice("variant") == "half_steps" ? Variant::half_steps : Variant::one_step};
  }

  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options& options, const S& system, Visitor&& visit) {
    const int parts = options.variant == Variant::half_steps ? 2 : 1;
    return visit(LiemidStepper<S, Audit>(system, parts));
  }
};

}  // namespace liebench
