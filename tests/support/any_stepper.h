#pragma once

#include <memory>
#include <span>
#include <type_traits>
#include <utility>

#include "integrators/audit.h"
#include "integrators/outcome.h"
#include "integrators/starting_values.h"
#include "problems/system.h"

// The steppers of all methods for one system behind one interface, so that a test is written and compiled once, and not
// once for each stepper.

namespace liebench {

template <MechanicalSystem S>
class AnyStepper {
 public:
  using System = S;
  using T = typename S::Scalar;

  virtual ~AnyStepper() = default;
  virtual int steps() const = 0;
  virtual int starting_points() const = 0;
  virtual StepResult start(const T& h, std::span<const SolutionPoint<S>> points) = 0;
  virtual StepResult step() = 0;
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
  // No pointer, no vector: all that a step needs is in the stepper itself.
  static_assert(std::is_trivially_destructible_v<Stepper>);

  explicit HeldStepper(Stepper&& stepper) : stepper_(std::move(stepper)) {}
  int steps() const override { return stepper_.steps(); }
  int starting_points() const override { return stepper_.starting_points(); }
  StepResult start(const T& h, std::span<const SolutionPoint<S>> points) override {
    return stepper_.start(h, points);
  }
  StepResult step() override { return stepper_.step(); }
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
  Stepper stepper_;
};

// The stepper that the options ask for.
template <class Method, MechanicalSystem S, class Audit = NoAudit>
std::unique_ptr<AnyStepper<S>> make_stepper(const typename Method::Options& options, const S& system) {
  return Method::template with_stepper<S, Audit>(
      options, system, []<class Stepper>(Stepper&& stepper) -> std::unique_ptr<AnyStepper<S>> {
        return std::make_unique<HeldStepper<std::remove_cvref_t<Stepper>>>(std::move(stepper));
      });
}

}  // namespace liebench
