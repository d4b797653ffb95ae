#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/record_file.h"
#include "harness/study.h"

namespace liebench {

// What a job of several studies has of its records so far: a file for each study, `<study>.unfinished.jsonl`, in the job's
// folder. A job that is killed goes on from there; one that ends removes them.
class UnfinishedRecords {
 public:
  // Opens or creates the files; one that is older than the program is made anew. Throws as RecordFile does.
  UnfinishedRecords(std::filesystem::path folder, const std::vector<RunSpec>& runs);

  // The record of a run, if this program made it: one of another commit, compiler or machine is no part of this job.
  std::optional<Json> record(const RunSpec& run) const;
  // Appends a record, or a new version of one that is there.
  void append(const RunSpec& run, const Json& record);
  void remove();

 private:
  std::filesystem::path folder_;
  Json provenance_;
  std::map<std::string, RecordFile> parts_;  // by study
};

}  // namespace liebench
