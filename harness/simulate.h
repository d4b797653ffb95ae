#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/run.h"
#include "harness/scene_assembly.h"
#include "integrators/option.h"
#include "integrators/settled_stepper.h"

// One trajectory of a scene, from its own initial values.

namespace liebench {

// What is known of a body at a time: centre of mass, unit quaternion (w, x, y, z) and velocity in the inertial frame, angular
// velocity in the body frame; of a point mass without rotation.
struct BodySample {
  std::array<double, 3> position, velocity, angular_velocity;
  std::array<double, 4> orientation;
  bool rotates = true;
};

struct Sample {
  double time = 0.0;
  std::vector<BodySample> bodies;
  std::vector<double> multipliers;
  double energy = 0.0;
  double position_constraint = 0.0, velocity_constraint = 0.0;  // largest residuals
};

struct SimulationPlan {
  MethodOptions method = BLieDF2nd::Options{};
  // Of a method that chooses its steps the length of the interval, and the most steps that it may choose (harness/run.h).
  double step_size = 0.0;
  std::uint64_t steps = 0;
  bool chooses_steps = false;
  std::uint64_t every = 1;  // samples: every n-th step, the initial state and the last
  double length() const { return chooses_steps ? step_size : step_size * double(steps); }
};

// Runs the plan and hands each sample on as soon as it is there. The failure of the run, if it failed.
std::optional<RunFailure> simulate(const AssembledScene& scene, const SimulationPlan& plan,
                                   const std::function<void(const Sample&)>& take);

// Names of the multipliers, "joint[0]", ..., in their order.
std::vector<std::string> multiplier_names(const AssembledScene& scene);

}  // namespace liebench
