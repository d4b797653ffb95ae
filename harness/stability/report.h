#pragma once

#include <string>
#include <vector>

#include "harness/stability/case.h"
#include "harness/strict_json.h"
#include "harness/table.h"
#include "plots/heat_map.h"

// What the suite found, as a picture and as tables. Records as of stability_record(), in the order of the suite.

namespace liebench {

// Trials without the option "safeguard" stand beside the others to show what it changes; they count in no verdict of a method.
bool plain(const Json& record);

// Methods against cases: each cell the verdict of its worst trial.
HeatMap stability_map(const std::vector<Json>& records);

// The picture's matrix in words for one form ("" unconstrained); and every trial that did not simply pass.
Table stability_matrix(const std::vector<Json>& records, const std::string& form, bool captioned = true);
Table stability_trials(const std::vector<Json>& records);
// All trials, with what was measured.
Table stability_list(const std::vector<Json>& records);

// The page: matrices, the cases with their questions, criteria and theory, and what did not pass.
std::string stability_report(const std::vector<Json>& records);

// A line of a file of such records. Throws InputError.
Json parse_stability_record(std::string_view line, const std::string& place);

}  // namespace liebench
