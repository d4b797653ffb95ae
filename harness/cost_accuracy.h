#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/select.h"
#include "harness/table.h"

// What a given accuracy costs: for each target error and each curve the largest step size that reaches it and
// what the run then costs, interpolated between the runs that were made. Rules in docs/tables.md.

namespace liebench {

// What one curve needs for a target error; absent where the curve does not reach it or its records do not say.
struct CostEntry {
  std::string curve{}, remark{};
  bool reached = false, extrapolated = false;
  std::optional<double> step_size{}, steps{}, residuals{}, flops{}, time_ms{};
  // Errors of the component there: relative, and mixed, |e| / (1 + |y|).
  std::optional<double> relative{}, mixed{};
};
CostEntry cost_of_error(const Curve& curve, const Quantity& quantity, double target);

inline const std::vector<double> default_targets{1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10};

// Rows by falling target, then by rising cost. The cheapest of a target is marked: by time where all curves
// that reach it are timed, else by flops where all have them, else by residuals. Columns that no row fills
// are left out.
Table cost_accuracy_table(const std::vector<RecordRow>& records, const Quantity& quantity,
                          const std::vector<double>& targets = default_targets);

}  // namespace liebench
