#pragma once

#include "groups/counted.h"
#include "groups/extended.h"
#include "integrators/settled_stepper.h"

// The steppers of everything that is not in double.

namespace liebench {

template <MechanicalSystem S>
using StepperMaker = std::unique_ptr<AnyStepper<S>>(const MethodOptions&, const S&);

extern template StepperMaker<RunTimeSystem<Extended>> any_stepper;
extern template StepperMaker<RunTimeSystem<Counted>> any_stepper;

}  // namespace liebench
