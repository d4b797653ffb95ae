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
// watched at every n-th step. A method that chooses its steps goes by them from t = 0 to the time where the others end, to the last
// bit.

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
  // How much a step whose local error is the tolerance changes the energy by, at most and to first order, divided by the tolerance, J:
  // harness/stability/tolerance.h. Of a method that chooses its steps alone.
  double energy_of_tolerance = 0.0;
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
  // Of a method that chooses its steps: how many it may choose, with more the run ends (step_limit); and whether `watch` sees all of
  // them, or the first that ends at or behind each time that `every` names.
  std::uint64_t most_own_steps = 1'000'000;
  bool watch_own_steps = false;
};

struct SceneRunEnd {
  Outcome outcome = Outcome::ok;
  std::optional<RunFailure> failure;
  std::uint64_t reached = 0;  // the last step that ended well
  bool finite = true;         // no infinity and no NaN in the last state
  double time = 0.0;          // of that step, s
  // Of a method that chooses its steps: their sizes, s. Those at the end of the interval, which are cut to fit, do not count as the
  // shortest.
  double shortest_step = 0.0, longest_step = 0.0;
};

SceneRunEnd run_scene(const SceneRun& run);

// Of a description that is made to fit, with redundant constraints found.
std::shared_ptr<const AssembledScene> assembled(const SceneDescription& scene);

}  // namespace liebench
