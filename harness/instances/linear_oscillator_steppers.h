#pragma once

#include "harness/instances/run_time_steppers.h"
#include "problems/linear_oscillator.h"

namespace liebench {

extern template StepperMaker<LinearOscillator<double>> any_stepper;

}  // namespace liebench
