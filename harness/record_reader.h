#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
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

// What is kept of the sections errors, cost, time and drift: entries ("cost/flops") and whole sections ("drift"). A table that
// needs three numbers of a row is made in half the time without the others.
class RecordNeeds {
 public:
  static RecordNeeds all_but_drift() {
    return RecordNeeds({"errors", "cost", "time"}).with_shared_parameters();
  }
  explicit RecordNeeds(std::vector<std::string> paths) : paths_(std::move(paths)) {}
  RecordNeeds with_shared_parameters() const {
    RecordNeeds needs = *this;
    needs.shared_parameters_ = true;
    return needs;
  }

  // False: parameters that all records share are an empty object in each, for they tell no two curves apart.
  bool shared_parameters() const { return shared_parameters_; }

  bool whole(std::string_view section) const;
  bool part_of(std::string_view section) const;  // of it at least an entry
  bool entry(std::string_view section, std::string_view entry) const;

 private:
  std::vector<std::string> paths_;
  bool shared_parameters_ = false;
};

// The records of JSON Lines files in the order of their lines, as tables, plots and comparisons need them:
// every line is checked as JSON and as a record, but `provenance`, `reference.method`, `requested_step_size` and what is not
// among `needs` are not kept.
// Of rows with the same key the last one counts, in the place of the first: a timed row replaces the untimed
// one. Throws InputError that names file and line where one is not a record of this schema, and where a file
// cannot be read.
std::vector<Json> read_records(const std::vector<std::filesystem::path>& files,
                               BadLines bad_lines = BadLines::reject,
                               const RecordNeeds& needs = RecordNeeds::all_but_drift());
std::vector<Json> read_records(const std::filesystem::path& file);

}  // namespace liebench
