#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "integrators/any_stepper.h"

// Goes `steps` steps of size h from the initial values of the stepper's system.
template <liebench::MechanicalSystem S>
void run(liebench::AnyStepper<S>& stepper, double h, std::uint64_t steps) {
  using liebench::Outcome;
  std::vector<liebench::SolutionPoint<S>> points(std::size_t(stepper.starting_points()));
  liebench::StepResult result = stepper.start_itself(h, points);
  if (result.outcome == Outcome::ok) result = stepper.advance(steps + 1 - std::uint64_t(stepper.steps()));
  if (result.outcome != Outcome::ok)
    throw std::runtime_error("the run failed: " + std::string(name(result.outcome)));
}

// A run of the method Method over [0, t_end].
template <class Method, liebench::MechanicalSystem S>
std::unique_ptr<liebench::AnyStepper<S>> run(const typename Method::Options& options, const S& system,
                                             double t_end, std::uint64_t steps) {
  auto stepper = liebench::held_stepper<Method, S>(options, system);
  run(*stepper, t_end / double(steps), steps);
  return stepper;
}
