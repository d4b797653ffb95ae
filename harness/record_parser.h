#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "harness/record_row.h"

// One line of a file of records into a row.

namespace liebench {

// Throws InputError unless the record has what tables, plots and comparisons rely on. `place` names it.
void require_record(const Json& record, const std::string& place);

// The record on one line of a file, `place`. Throws InputError where it is none of this schema.
Json parse_record(std::string_view line, const std::string& place);

// Parses lines one after the other: rows with the same text of their identity share it.
class RecordParser {
 public:
  RecordParser();
  RecordParser(RecordParser&&) noexcept;
  ~RecordParser();

  // Checks the whole line as JSON and as a record and fills the row, which is a new one. False where it is no record, and for
  // a few lines that parse_record takes (with a byte order mark): why, that one says. The row is then of no use.
  bool parse(std::string_view line, RecordRow& row);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace liebench
