#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "harness/strict_json.h"

// Reading records: JSON Lines, format in record.schema.json, words in docs/records.md.

namespace liebench {

// The record on one line of a file, `place`. Throws InputError where it is none of this schema.
Json parse_record(std::string_view line, const std::string& place);

enum class BadLines {
  reject,  // the first one ends the reading by an InputError
  skip     // each is named on standard error, the first twenty with their fault, and counted
};

// The records of JSON Lines files in the order of their lines, as tables, plots and comparisons need them:
// every line is checked as JSON and as a record, but `provenance`, `reference.method`, `requested_step_size` and, unless asked
// for, `drift` are not kept: they are half of a file.
// Of rows with the same key the last one counts, in the place of the first: a timed row replaces the untimed
// one. Throws InputError that names file and line where one is not a record of this schema, and where a file
// cannot be read.
enum class DriftOfRuns { leave_out, keep };
std::vector<Json> read_records(const std::vector<std::filesystem::path>& files,
                               BadLines bad_lines = BadLines::reject,
                               DriftOfRuns drift = DriftOfRuns::leave_out);
std::vector<Json> read_records(const std::filesystem::path& file);

}  // namespace liebench
