#include "harness/problem_checks.h"

#include <string_view>

#include "groups/extended.h"
#include "problems/check_system.h"
#include "problems/heavy_top.h"
#include "problems/scene_model.h"
#include "problems/scene_with_power.h"

namespace liebench {

template <template <class> class System>
SystemCheck check_heavy_top(const HeavyTopParameters& parameters) {
  CheckOptions options;
  if constexpr (System<double>::constraints > 0) {
    const bool inertial = std::string_view(System<double>::formulation).starts_with("R3x");
    for (const char* axis : {"x", "y", "z"}) {
      options.names.velocities.push_back((inertial ? "v" : "U") + std::string(axis));
      options.names.multipliers.push_back("lambda_" + std::string(axis));
    }
  }
  for (const char* axis : {"x", "y", "z"}) options.names.velocities.push_back("omega_" + std::string(axis));
  return check_system(System<double>(parameters), options);
}

template SystemCheck check_heavy_top<HeavyTopSO3>(const HeavyTopParameters&);
template SystemCheck check_heavy_top<HeavyTopS3>(const HeavyTopParameters&);
template SystemCheck check_heavy_top<HeavyTopR3xSO3>(const HeavyTopParameters&);
template SystemCheck check_heavy_top<HeavyTopR3xS3>(const HeavyTopParameters&);
template SystemCheck check_heavy_top<HeavyTopSE3>(const HeavyTopParameters&);
template SystemCheck check_heavy_top<HeavyTopS3R3>(const HeavyTopParameters&);
template SystemCheck check_heavy_top<HeavyTopUDQ>(const HeavyTopParameters&);

SystemCheck check_scene(const SceneDescription& scene, const std::vector<bool>& implied,
                        const CheckOptions& options) {
  return check_system(SceneWithPower<double>(make_scene_model<double>(scene, implied)),
                      SceneWithPower<Extended>(make_scene_model<Extended>(scene, implied)), options);
}

}  // namespace liebench
