#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/run.h"
#include "harness/scene_assembly.h"
#include "integrators/option.h"
#include "problems/scene_bodies.h"

// One run of a scene in double for the stability suite: with starting points of its own making, exact ones or disturbed ones,
// watched at every n-th step.

namespace liebench {

struct WatchedState {
  std::uint64_t step = 0;
  double t = 0.0;
  std::vector<RigidState<double>> bodies;
  Eigen::VectorXd multipliers;
  // What the equations of motion give for these bodies; empty where they have no solution.
  Eigen::VectorXd consistent_multipliers;
  double energy = 0.0, angular_momentum = 0.0;                  // as of MechanicalSystem
  double position_constraint = 0.0, velocity_constraint = 0.0;  // largest |Phi_i|, |(B v)_i|
  double group = 0.0;                                           // defect of the group, as of LieGroup
};

// Coordinates, velocities, accelerations and multipliers of a starting point, stacked body by body.
struct StartingPoint {
  Eigen::VectorXd q, v, acceleration, multipliers;
};

struct SceneRun {
  std::shared_ptr<const AssembledScene> scene;
  std::string integrator;
  OptionValues options;
  double step_size = 0.0;   // s; negative: backwards
  std::uint64_t steps = 0;  // from t = 0, the starting points included
  // The exact motion: the scene as it is at time t. Where it is there, the method starts from it, and not by itself.
  std::function<SceneDescription(double t)> exact = {};
  // What becomes of the starting points, t = 0, h, ..., before the method takes them.
  std::function<void(std::vector<StartingPoint>&)> disturb = {};
  // Sees every `every`-th state and the last; 0: the last alone.
  std::function<void(const WatchedState&)> watch = {};
  std::uint64_t every = 0;
};

struct SceneRunEnd {
  Outcome outcome = Outcome::ok;
  std::optional<RunFailure> failure;
  std::uint64_t reached = 0;  // the last step that ended well
  bool finite = true;         // no infinity and no NaN in the last state
};

SceneRunEnd run_scene(const SceneRun& run);

// Of a description that is made to fit, with redundant constraints found.
std::shared_ptr<const AssembledScene> assembled(const SceneDescription& scene);

}  // namespace liebench
