#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "harness/scene_assembly.h"
#include "harness/simulate.h"

// What each effect of a scene costs and changes: the scene is run without it.

namespace liebench {

struct Ablation {
  std::string left_out;  // empty: the whole scene
  std::optional<RunFailure> failure;
  double ns_per_step = 0.0;     // median
  double flops_per_step = 0.0;  // counted exactly
  double shift = 0.0;  // largest distance of a centre of mass from that of the whole scene at the end, m
  double turn = 0.0;   // largest rotation between the same bodies, rad
};

// The whole scene first, then without each type of effect that it has, in the order of the list of effects; the gyroscopic torque is
// one of them. `advance(done)` hears of each run, from 0 to 1.
std::vector<Ablation> ablations(const AssembledScene& scene, const SimulationPlan& plan,
                                const std::function<void(double)>& advance);

}  // namespace liebench
