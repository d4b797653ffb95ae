#pragma once

#include <Eigen/Core>
#include <vector>

#include "problems/scene_system.h"

namespace liebench {

// Which rows of the constraint gradient B(q) the rows before them imply: those of which less than `tolerance` of their length
// stands at right angles to all of these. In the order in which joints make rows: of two joints that say the same, the one that
// the author wrote later is redundant. (Only where this order would fill the factor it is given up, and another one counts as
// many.) Takes time in proportion to the entries of the factor: of chains and windows, to the number of bodies.
std::vector<bool> implied_rows(const SceneSystem<double>& system, const Eigen::VectorXd& q, double tolerance);

}  // namespace liebench
