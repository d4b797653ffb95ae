#pragma once

#include <string>
#include <vector>

#include "harness/record_row.h"

// The formulations of the heavy top against each other: docs/formulations.md is this text.

namespace liebench {

// Tables of the error at equal step and of the operations at equal error, a row a method, a column a formulation.
std::string formulations_report(const std::vector<RecordRow>& records);

}  // namespace liebench
