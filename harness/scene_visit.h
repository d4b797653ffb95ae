#pragma once

#include <memory>

#include "harness/instances/scene_steppers.h"
#include "harness/scene_assembly.h"
#include "problems/scene_model.h"

namespace liebench {

// Calls visit(system) with the scene in double: one without a heap where it is small enough.
template <class Visitor>
auto with_scene(const AssembledScene& scene, const Visitor& visit) {
  const auto model = make_scene_model<double>(scene.scene, scene.implied);
  if (model->bodies.size() <= std::size_t(small_scene) && model->rows <= SmallScene::most_constraints)
    return visit(SmallScene(model));
  return visit(Scene(model));
}

}  // namespace liebench
