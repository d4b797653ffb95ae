#include "harness/references/scene_reference.h"

#include <algorithm>
#include <cstdint>

#include "harness/instances/run_time_scenes.h"
#include "problems/scene_model.h"

namespace liebench {

SceneReference::SceneReference(const AssembledScene& scene, double duration)
    : model_(make_scene_model<Extended>(scene.scene, scene.implied)),
      motion_(run_time_scene<Extended>(scene.scene, scene.implied), duration,
              {.separation =
                   [this](const System::Vector& q, const System::Vector& p) {
                     return group().separation(q, p).lpNorm<Eigen::Infinity>();
                   },
               .most_steps = std::max<std::uint64_t>(
                   800, 40000 / std::max<std::uint64_t>(1, scene.scene.bodies.size())),
               .speed = 1.0,
               .chaotic = scene.scene.chaotic,
               .advice = ", or say \"chaotic\": true in the scene, to be compared by invariants"}) {}

}  // namespace liebench
