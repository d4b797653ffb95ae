#pragma once

#include <vector>

#include "problems/heavy_top_parameters.h"
#include "problems/scene_description.h"
#include "problems/system_check.h"

namespace liebench {

// check_system() of the heavy top in the formulation System<T>, differences in extended precision. Instantiated in
// harness/instances/problem_checks.cpp.
template <template <class> class System>
SystemCheck check_heavy_top(const HeavyTopParameters& parameters);

// Of a scene; `implied`: see make_scene_model().
SystemCheck check_scene(const SceneDescription& scene, const std::vector<bool>& implied,
                        const CheckOptions& options);

}  // namespace liebench
