#include "harness/instances/scene_steppers.h"

namespace liebench {

template StepperMaker<SmallScene> any_stepper;

}  // namespace liebench
