#pragma once

#include <vector>

#include "integrators/run_time_system.h"
#include "problems/scene_description.h"

namespace liebench {

// A scene behind the interface of all systems; compiled once, for double, Extended and Counted. `implied`: see make_scene_model().
template <class T>
RunTimeSystem<T> run_time_scene(const SceneDescription& scene, const std::vector<bool>& implied = {});

}  // namespace liebench
