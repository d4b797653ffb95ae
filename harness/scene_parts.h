#pragma once

#include "harness/scene_values.h"

// The readers of the parts of a scene, called in this order: each finds in the scene what those before it have read.

namespace liebench {

BodyDescription read_body(const JsonView& view);

// `names`: of the bodies.
JointDescription read_joint(const JsonView& view, const SceneDescription& scene, const SceneNames& names);

// Adds one entry of "effects" to the scene.
void read_effect(const JsonView& view, const SceneNames& bodies, const SceneNames& joints,
                 SceneDescription& scene);

}  // namespace liebench
