#include "harness/instances/scene_steppers.h"

namespace liebench {

template StepperMaker<Scene> any_stepper;

}  // namespace liebench
