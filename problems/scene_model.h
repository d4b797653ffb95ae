#pragma once

#include <memory>
#include <vector>

#include "problems/scene_description.h"
#include "problems/scene_system.h"

namespace liebench {

// The description as a model in the scalar T: a double of the data means its shortest decimal (groups/decimal.h). `implied`: the
// rows, in the order in which joints make them, that other constraints imply. Compiled for double, Extended and Counted.
template <class T>
std::shared_ptr<const SceneModel<T>> make_scene_model(const SceneDescription& scene,
                                                      const std::vector<bool>& implied = {});

}  // namespace liebench
