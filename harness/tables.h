#pragma once

#include <vector>

#include "harness/strict_json.h"
#include "harness/table.h"

namespace liebench {

// Observed order of every curve of the records, in q, v and lambda, at the end and as maximum over all steps.
Table orders_table(const std::vector<Json>& records);

// How many runs of every curve ended how, and where the first of them failed.
Table outcomes_table(const std::vector<Json>& records);

}  // namespace liebench
