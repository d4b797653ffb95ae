#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/study.h"

// Records: what happened, one JSON object a run; format in record.schema.json, words in docs/records.md.

namespace liebench {

inline constexpr int record_schema = 1;

// The record of a run. `provenance` is the object of harness/provenance.h.
Json make_record(const RunSpec& run, const RunResult& result, const PreparedProblem& problem,
                 const Json& provenance);

// The record with the times of its run. Where it was made by another build or on another machine than the times, its
// provenance becomes theirs: errors and counts are the same for all of them.
Json with_time(Json record, const RunTimes& times);

// The record on one line of a file, `place`. Throws InputError where it is none of this schema.
Json parse_record(std::string_view line, const std::string& place);

// All records of a JSON Lines file in the order of its lines. Throws InputError that names file and line
// where one is not a record of this schema.
std::vector<Json> read_records(const std::filesystem::path& file);

}  // namespace liebench
