#pragma once

#include <concepts>
#include <memory>

#include "harness/instances/heavy_top_steppers.h"
#include "integrators/any_stepper.h"

// The steppers of a method for any system; for the paper's formulations those of the program.

namespace liebench {

template <class S>
concept CompiledSystem = std::same_as<S, HeavyTopSO3<double>> || std::same_as<S, HeavyTopR3xSO3<double>> ||
    std::same_as<S, ExtendedSO3> || std::same_as<S, ExtendedR3xSO3> || std::same_as<S, CountedSO3> ||
    std::same_as<S, CountedR3xSO3>;

template <class Method, MechanicalSystem S>
std::unique_ptr<AnyStepper<S>> make_stepper(const typename Method::Options& options, const S& system) {
  if constexpr (CompiledSystem<S>) {
    return any_stepper<S>(options, system);
  } else {
    return held_stepper<Method, S>(options, system);
  }
}

}  // namespace liebench
