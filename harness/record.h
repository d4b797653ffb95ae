#pragma once

#include "harness/study.h"

// Records: what happened, one JSON object a run; format in record.schema.json, words in docs/records.md.

namespace liebench {

inline constexpr int record_schema = 1;

// The record of a run. `provenance` is the object of harness/provenance.h.
Json make_record(const RunSpec& run, const RunResult& result, const PreparedProblem& problem,
                 const Json& provenance);

// The record with the times of its run, and with the provenance of these: errors and counts are the same for every build of
// one numerical version, which is part of the key.
Json with_time(Json record, const RunTimes& times);

}  // namespace liebench
