#include "harness/instances/linear_oscillator_steppers.h"

namespace liebench {

template StepperMaker<LinearOscillator<double>> any_stepper;

}  // namespace liebench
