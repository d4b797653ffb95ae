#pragma once

#include <memory>
#include <string>

#include "groups/extended.h"
#include "harness/references/integrated_reference.h"
#include "harness/scene_assembly.h"
#include "problems/scene_system.h"

namespace liebench {

// The motion of a scene in extended precision.
class SceneReference {
 public:
  using System = IntegratedReference::System;
  using Point = IntegratedReference::Point;

  // In at most 40,000 steps of a body; see IntegratedReference for what it throws.
  SceneReference(const AssembledScene& scene, double duration);

  // The solution at t in [0, duration].
  Point at(const Extended& t) const { return motion_.at(t); }
  double error_estimate() const { return motion_.error_estimate(); }
  double agreement_time() const { return motion_.agreement_time(); }
  static constexpr double agreement = IntegratedReference::agreement;
  std::string method() const { return motion_.method(); }
  const SceneModel<Extended>& model() const { return *model_; }
  SceneGroup<Extended> group() const { return SceneGroup<Extended>(model_->bodies); }

 private:
  std::shared_ptr<const SceneModel<Extended>> model_;
  IntegratedReference motion_;
};

}  // namespace liebench
