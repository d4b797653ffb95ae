#pragma once

#include <filesystem>
#include <vector>

#include "harness/record_row.h"

// Reading files of records: JSON Lines, format in record.schema.json, words in docs/records.md.
//
// Every line is checked as JSON and as a record. Of lines with the same key the last one counts, in the place of the first:
// a timed row replaces the untimed one. Files are read by several threads; what comes out does not depend on their number.

namespace liebench {

enum class BadLines {
  reject,  // the first one ends the reading by an InputError
  skip     // each is named on standard error, the first twenty with their fault, and counted
};

// The records in the order of their lines, as tables, plots and comparisons need them. Throws InputError that names file and line where
// one is not a record of this schema, and where a file cannot be read. At most `threads` at a time; 0: as many as there are
// processors.
std::vector<RecordRow> read_records(const std::vector<std::filesystem::path>& files,
                                    BadLines bad_lines = BadLines::reject, unsigned threads = 0);

// Records that are in memory, each checked as those of a file.
std::vector<RecordRow> record_rows(const std::vector<Json>& records);

}  // namespace liebench
