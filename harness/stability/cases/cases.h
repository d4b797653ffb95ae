#pragma once

#include "harness/stability/case.h"

// One function a case; its file has the same name.

namespace liebench {

StabilityCase long_runs();
StabilityCase small_steps();
StabilityCase large_rotations();
StabilityCase extreme_arguments();
StabilityCase correction_term();
StabilityCase stiffness();
StabilityCase singular();
StabilityCase masses();
StabilityCase bad_beginnings();
StabilityCase rough_forces();
StabilityCase unstable_motion();
StabilityCase degenerate_runs();

}  // namespace liebench
