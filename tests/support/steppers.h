#pragma once

#include <concepts>
#include <memory>

#include "harness/instances/heavy_top_steppers.h"
#include "integrators/any_stepper.h"

// The steppers of a method for any system; those of the program for the paper's formulations, and for what is not in double.

namespace liebench {

template <class S>
concept CompiledSystem = !std::same_as<typename S::Scalar, double> || std::same_as<S, HeavyTopSO3<double>> ||
                         std::same_as<S, HeavyTopR3xSO3<double>>;

template <class Method, MechanicalSystem S>
std::unique_ptr<AnyStepper<S>> make_stepper(const typename Method::Options& options, const S& system) {
  if constexpr (CompiledSystem<S>) {
    return any_stepper<S>(options, system);
  } else {
    return held_stepper<Method, S>(options, system);
  }
}

}  // namespace liebench
