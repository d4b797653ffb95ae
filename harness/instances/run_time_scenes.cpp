#include "harness/instances/run_time_scenes.h"

#include <memory>

#include "groups/counted.h"
#include "groups/extended.h"
#include "integrators/erased_block_system.h"
#include "problems/scene_model.h"

namespace liebench {

template <class T>
RunTimeSystem<T> run_time_scene(const SceneDescription& scene, const std::vector<bool>& implied) {
  using L = LinearScalar<T>;
  return RunTimeSystem<T>(std::make_shared<ErasedBlockSystem<SceneSystem<T>>>(
      SceneSystem<T>(make_scene_model<T>(scene, implied)),
      SceneSystem<L>(make_scene_model<L>(scene, implied))));
}

template RunTimeSystem<double> run_time_scene(const SceneDescription&, const std::vector<bool>&);
template RunTimeSystem<Extended> run_time_scene(const SceneDescription&, const std::vector<bool>&);
template RunTimeSystem<Counted> run_time_scene(const SceneDescription&, const std::vector<bool>&);

}  // namespace liebench
