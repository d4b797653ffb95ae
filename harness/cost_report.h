#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/cost_accuracy.h"
#include "harness/record_row.h"
#include "plots/figure.h"

// What accuracy costs in time: the study cost_accuracy in a picture and a page (docs/cost_accuracy.md is this text).

namespace liebench {

// Error of q against computing time (operations, where no run was timed): without constraints on SO(3), index 3 and
// stabilized index 2 on R^3 x SO(3).
Figure cost_accuracy_figure(const std::vector<RecordRow>& records);

// A row a method, a column an error of q at the end: what `cost` needs for it; the least of each column in bold.
using Cost = std::optional<double> CostEntry::*;
std::string cost_table(const std::vector<RecordRow>& rows, Cost cost);
// Whether every run that ended well was timed.
bool all_timed(const std::vector<RecordRow>& records);

// For each of these, the time and the operations that every method needs for some errors of q; and the cheapest pair of method
// and formulation for each error.
std::string cost_report(const std::vector<RecordRow>& records);

}  // namespace liebench
