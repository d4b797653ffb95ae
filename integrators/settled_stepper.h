#pragma once

#include <any>
#include <concepts>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "integrators/audit.h"
#include "integrators/erased_system.h"
#include "integrators/fits.h"
#include "integrators/outcome.h"
#include "integrators/run_time_system.h"
#include "integrators/self_start.h"
#include "integrators/settled_list.h"
#include "integrators/starting_values.h"
#include "problems/audited_system.h"
#include "problems/system.h"

// The steppers of all methods for one system behind one interface: what lies above (runs, tests) is compiled once for a
// system, and not once for each stepper. Loops that are timed lie below it, in advance().
//
// This header knows the settled methods only, so that what it is compiled into, which takes minutes, is not compiled again for each
// method that is added. integrators/any_stepper.h has all.

namespace liebench {

template <MechanicalSystem S>
class AnyStepper {
 public:
  using System = S;
  using T = typename S::Scalar;

  virtual ~AnyStepper() = default;
  virtual int steps() const = 0;
  virtual int starting_points() const = 0;
  // h: the step size, or the length of the interval of a method that chooses its steps.
  virtual StepResult start(const T& h, std::span<const SolutionPoint<S>> points) = 0;
  // From the initial values of the system at t = 0 alone: integrators/self_start.h. Leaves the points that it found in
  // `points`, of which there are starting_points().
  virtual StepResult start_itself(const T& h, std::span<SolutionPoint<S>> points) = 0;
  virtual StepResult step() = 0;
  // At most so many steps, in one loop; ends with the first that fails, and at the end of the interval.
  virtual StepResult advance(std::uint64_t steps) = 0;
  virtual std::unique_ptr<AnyStepper> clone() const = 0;
  // Becomes what `other` is, a stepper of the same type; allocates nothing.
  virtual void assign(const AnyStepper& other) = 0;
  // At the end of its interval, of a method that chooses its steps (integrators/step_control.h); never of another.
  virtual bool finished() const = 0;
  virtual const T& time() const = 0;
  virtual const Configuration<S>& configuration() const = 0;
  virtual const Velocity<S>& velocity() const = 0;
  virtual const Multipliers<S>& multipliers() const = 0;
  // Of a stepper that counts; zeros of one that does not.
  virtual KernelAudit audit() const = 0;
};

template <class Stepper>
class HeldStepper final : public AnyStepper<typename Stepper::System> {
 public:
  using S = typename Stepper::System;
  using T = typename S::Scalar;
  static constexpr bool fixed_size = !SizedLieGroup<typename S::Group>;
  // No pointer, no vector: all that a step of a system of fixed size needs is in the stepper itself.
  static_assert(!fixed_size || std::is_trivially_destructible_v<Stepper>);

  explicit HeldStepper(const Stepper& stepper) : stepper_(stepper) {}
  // Several kB, member by member: cold, so that the compiler does not unroll it.
  [[gnu::noinline, gnu::cold]] static std::unique_ptr<AnyStepper<S>> holding(const Stepper& stepper) {
    return std::unique_ptr<AnyStepper<S>>(new HeldStepper(stepper));
  }
  int steps() const override { return stepper_.steps(); }
  int starting_points() const override { return stepper_.starting_points(); }
  StepResult start(const T& h, std::span<const SolutionPoint<S>> points) override {
    return stepper_.start(h, points);
  }
  StepResult start_itself(const T& h, std::span<SolutionPoint<S>> points) override {
    if (const StepResult found = self_start(stepper_.system(), T(0.0), h, points, stepper_.audit());
        found.outcome != Outcome::ok)
      return found;
    return stepper_.start(h, points);
  }
  StepResult step() override { return stepper_.step(); }
  StepResult advance(std::uint64_t steps) override {
    StepResult result{};
    for (std::uint64_t i = 0; i < steps && result.outcome == Outcome::ok && !finished(); ++i)
      result = stepper_.step();
    return result;
  }
  std::unique_ptr<AnyStepper<S>> clone() const override {
    if constexpr (fixed_size) {
      return holding(stepper_);
    } else {
      return std::make_unique<HeldStepper>(*this);
    }
  }
  void assign(const AnyStepper<S>& other) override {
    const auto& same = static_cast<const HeldStepper&>(other);
    if constexpr (fixed_size) {
      copy(same.stepper_, stepper_);
    } else {
      *this = same;
    }
  }
  bool finished() const override {
    if constexpr (requires { stepper_.finished(); }) {
      return stepper_.finished();
    } else {
      return false;
    }
  }
  const T& time() const override { return stepper_.time(); }
  const Configuration<S>& configuration() const override { return stepper_.configuration(); }
  const Velocity<S>& velocity() const override { return stepper_.velocity(); }
  const Multipliers<S>& multipliers() const override { return stepper_.multipliers(); }
  KernelAudit audit() const override {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(stepper_.audit())>, KernelAudit>) {
      return stepper_.audit();
    } else {
      return {};
    }
  }

 private:
  [[gnu::noinline, gnu::cold]] static void copy(const Stepper& from, Stepper& to) { to = from; }

  Stepper stepper_;
};

// What the kernel of a stepper for S counts: all of an audited system, nothing of another.
template <MechanicalSystem S>
struct AuditOf {
  using type = NoAudit;
};
template <MechanicalSystem S>
struct AuditOf<Audited<S>> {
  using type = KernelAudit;
};
template <class T>
struct AuditOf<RunTimeSystem<T>> {
  using type = KernelAudit;
};

// The stepper of a method that its options ask for.
template <class Method, MechanicalSystem S>
std::unique_ptr<AnyStepper<S>> held_stepper(const typename Method::Options& options, const S& system) {
  return Method::template with_stepper<S, typename AuditOf<S>::type>(
      options, system, []<class Stepper>(const Stepper& stepper) -> std::unique_ptr<AnyStepper<S>> {
        if constexpr (HeldStepper<Stepper>::fixed_size) {
          return HeldStepper<Stepper>::holding(stepper);
        } else {
          return std::make_unique<HeldStepper<Stepper>>(stepper);
        }
      });
}

// The options of any method: they say which method it is.
class MethodOptions {
 public:
  template <class Options>
  requires(!std::same_as<Options, MethodOptions>) MethodOptions(const Options& options) : value_(options) {}

  // Null where they are those of another one.
  template <class Method>
  const typename Method::Options* of() const {
    return std::any_cast<typename Method::Options>(&value_);
  }

 private:
  std::any value_;
};

// The stepper of a method of this list, null where it is none of these or does not fit the system.
template <MechanicalSystem S, class... Methods>
std::unique_ptr<AnyStepper<S>> stepper_of(IntegratorList<Methods...>, const MethodOptions& options,
                                          const S& system) {
  std::unique_ptr<AnyStepper<S>> stepper;
  const auto attempt = [&]<class Method>(IntegratorList<Method>) {
    if constexpr (may_fit<Method, S>())
      if (const auto* own = options.of<Method>()) stepper = held_stepper<Method, S>(*own, system);
  };
  (attempt(IntegratorList<Methods>{}), ...);
  return stepper;
}

// The same of the list of new methods; defined in integrators/any_stepper.h, and for the systems of the program in
// harness/instances/new_methods.cpp alone.
template <MechanicalSystem S>
std::unique_ptr<AnyStepper<S>> new_stepper(const MethodOptions& options, const S& system);

// The stepper of any method, null where it does not fit the system; explicitly instantiated where it is compiled once for all (harness/instances). What is not in
// double is stepped as a RunTimeSystem: one compilation of all methods serves all systems.
template <MechanicalSystem S>
std::unique_ptr<AnyStepper<S>> any_stepper(const MethodOptions& options, const S& system);

// A stepper of a RunTimeSystem as one of the system S that it stands for.
template <DenseSystem S>
class RunTimeStepper final : public AnyStepper<S> {
 public:
  using T = typename S::Scalar;
  using Run = RunTimeSystem<T>;

  RunTimeStepper(const MethodOptions& options, const S& system)
      : stepper_(any_stepper(options, Run(std::make_shared<ErasedSystem<S>>(system)))) {}
  RunTimeStepper(const RunTimeStepper& other)
      : stepper_(other.stepper_->clone()), q_(other.q_), velocity_(other.velocity_), lambda_(other.lambda_) {}
  RunTimeStepper& operator=(const RunTimeStepper&) = delete;

  int steps() const override { return stepper_->steps(); }
  int starting_points() const override { return stepper_->starting_points(); }
  StepResult start(const T& h, std::span<const SolutionPoint<S>> points) override {
    std::vector<SolutionPoint<Run>> run_time;
    for (const SolutionPoint<S>& p : points)
      run_time.push_back({p.t, S::Group::stacked(p.q), p.v, p.acceleration, p.lambda});
    return after(stepper_->start(h, run_time));
  }
  StepResult start_itself(const T& h, std::span<SolutionPoint<S>> points) override {
    std::vector<SolutionPoint<Run>> run_time(points.size());
    const StepResult result = stepper_->start_itself(h, run_time);
    for (std::size_t j = 0; j < points.size() && result.outcome == Outcome::ok; ++j) {
      const SolutionPoint<Run>& p = run_time[j];
      points[j] = {p.t, S::Group::unstacked(p.q), p.v, p.acceleration, p.lambda};
    }
    return after(result);
  }
  StepResult step() override { return after(stepper_->step()); }
  StepResult advance(std::uint64_t steps) override { return after(stepper_->advance(steps)); }
  std::unique_ptr<AnyStepper<S>> clone() const override { return std::make_unique<RunTimeStepper>(*this); }
  void assign(const AnyStepper<S>& other) override {
    const auto& same = static_cast<const RunTimeStepper&>(other);
    stepper_->assign(*same.stepper_);
    take_state();
  }
  bool finished() const override { return stepper_->finished(); }
  const T& time() const override { return stepper_->time(); }
  const Configuration<S>& configuration() const override { return q_; }
  const Velocity<S>& velocity() const override { return velocity_; }
  const Multipliers<S>& multipliers() const override { return lambda_; }
  KernelAudit audit() const override { return stepper_->audit(); }

 private:
  StepResult after(const StepResult& result) {
    take_state();
    return result;
  }
  void take_state() {
    q_ = S::Group::unstacked(stepper_->configuration());
    velocity_ = stepper_->velocity();
    lambda_ = stepper_->multipliers();
  }

  std::unique_ptr<AnyStepper<Run>> stepper_;
  Configuration<S> q_ = S::Group::identity();
  Velocity<S> velocity_ = Velocity<S>::Constant(T(0.0));
  Multipliers<S> lambda_ = Multipliers<S>::Constant(T(0.0));
};

template <MechanicalSystem S>
std::unique_ptr<AnyStepper<S>> any_stepper(const MethodOptions& options, const S& system) {
  if constexpr (DenseSystem<S> && !std::is_same_v<typename S::Scalar, double>) {
    return std::make_unique<RunTimeStepper<S>>(options, system);
  } else {
    std::unique_ptr<AnyStepper<S>> stepper = stepper_of(SettledIntegrators{}, options, system);
    return stepper ? std::move(stepper) : new_stepper(options, system);
  }
}

}  // namespace liebench
