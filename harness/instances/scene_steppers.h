#pragma once

#include "harness/instances/run_time_steppers.h"
#include "integrators/sparse_stage_solver.h"
#include "integrators/sparse_step_matrix.h"
#include "problems/scene_model.h"

// The steppers of scenes: in double small ones, whose vectors need no heap, and those of any size; others by the run-time system.

namespace liebench {

inline constexpr int small_scene = 3;
using SmallScene = SceneSystem<double, small_scene>;
using Scene = SceneSystem<double>;

extern template StepperMaker<SmallScene> any_stepper;
extern template StepperMaker<Scene> any_stepper;

}  // namespace liebench
