#pragma once

#include <string>
#include <vector>

#include "problems/scene_description.h"

namespace liebench {

// A scene whose joints fit, with what was done to it.
struct AssembledScene {
  SceneDescription scene;
  // The largest residual of a joint at the poses as given, m or rad, and the joint; and after assembly.
  double gap_before = 0.0;
  std::string gap_joint;
  double gap_after = 0.0;
  // Rows of constraints, in the order in which joints make them, that the others imply, and the joints that have them.
  std::vector<bool> implied;
  std::vector<std::string> redundant_joints;

  bool moved() const { return gap_before > fits; }
  // A gap below is rounding of the data and left to the first projection of a run.
  static constexpr double fits = 1e-10;
};

// The row-th row of constraints of a joint.
struct RowOfJoint {
  std::string joint;
  int row = 0;
};

// All rows of the scene, in the order in which its joints make them.
std::vector<RowOfJoint> rows_of_joints(const SceneDescription& scene);

// Moves the bodies as little as possible (poses on their groups, by Ceres) until all joints close, and finds the constraints
// that others imply (rank of the constraint gradient there). Throws InputError that names the joint with the largest
// gap where they cannot be closed, and one that is redundant at the initial poses only.
AssembledScene assemble(const SceneDescription& scene, const std::string& place);

}  // namespace liebench
