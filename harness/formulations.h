#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/record_row.h"

// The formulations of the heavy top against each other: docs/formulations.md is this text.

namespace liebench {

// The x at which y first falls to `target`, on the lines between the points of (x, y) in log-log coordinates, which are in
// the order of falling step size; empty where no point is at or below it.
struct CostPoint {
  double cost;
  double error;
};
std::optional<double> cost_at(const std::vector<CostPoint>& points, double target);

// Tables of the error at equal step and of the operations at equal error, a row a method, a column a formulation.
std::string formulations_report(const std::vector<RecordRow>& records);

}  // namespace liebench
