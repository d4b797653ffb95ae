#pragma once

#include <concepts>
#include <memory>

#include "integrators/list.h"
#include "integrators/settled_stepper.h"

// The steppers of all methods: for what makes them of systems of its own.

namespace liebench {

template <MechanicalSystem S>
std::unique_ptr<AnyStepper<S>> new_stepper(const MethodOptions& options, const S& system) {
  if constexpr (std::same_as<NewIntegrators, IntegratorList<>>)
    return nullptr;
  else
    return stepper_of(NewIntegrators{}, options, system);
}

}  // namespace liebench
