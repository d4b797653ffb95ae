#include "harness/instances/run_time_steppers.h"

namespace liebench {

template StepperMaker<RunTimeSystem<Extended>> any_stepper;

}  // namespace liebench
