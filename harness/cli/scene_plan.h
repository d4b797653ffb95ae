#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "harness/scene_assembly.h"
#include "harness/simulate.h"

// What the commands that run a scene have in common: the scene, the method and the steps.

namespace liebench {

struct ScenePlanOptions {
  std::string scene;
  std::string integrator = "bliedf2nd";
  std::vector<std::string> options;
  std::optional<double> step_size;
  std::optional<double> tolerance;  // of a method that chooses its steps
  double t_end = 0.0;               // 0: the scene's own
};

struct ScenePlan {
  AssembledScene scene;
  SimulationPlan plan;
  bool could_be_safeguarded = false;  // the method has a safeguard, which is off
};

// Reads and assembles the scene and says on standard error what was done to it. Throws InputError.
AssembledScene assembled_scene(const std::string& file);

void add_scene_plan(CLI::App& command, ScenePlanOptions& options);

// The same, and checks method and steps.
ScenePlan plan_scene(const ScenePlanOptions& options);

}  // namespace liebench
