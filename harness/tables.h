#pragma once

#include <optional>
#include <vector>

#include "harness/record_row.h"
#include "harness/table.h"

namespace liebench {

// Observed order of every curve of the records, in q, v and lambda, at the end and as maximum over all steps.
Table orders_table(const std::vector<RecordRow>& records);

// How many runs of every curve ended how, and where the first of them failed.
Table outcomes_table(const std::vector<RecordRow>& records);

// What every run that ended well kept of what its exact solution keeps; of chaotic scenes up to when it is right.
Table invariants_table(const std::vector<RecordRow>& records);

// Counts and time of one step of every curve, at its finest run that ended well or at the step size given.
// Columns that no record fills are left out.
Table costs_table(const std::vector<RecordRow>& records, std::optional<double> step_size = {});

}  // namespace liebench
