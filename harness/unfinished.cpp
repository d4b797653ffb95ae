#include "harness/unfinished.h"

#include <fmt/format.h>

#include <utility>

#include "harness/provenance.h"

namespace liebench {

namespace {

std::filesystem::path part_file(const std::filesystem::path& folder, const std::string& study) {
  return folder / fmt::format("{}.unfinished.jsonl", study);
}

Json without_date(Json provenance) {
  provenance.erase("date");
  return provenance;
}

// The commit says nothing of sources that differ from it.
bool is_newer_than_program(const std::filesystem::path& file) {
  std::error_code code;
  const auto written = std::filesystem::last_write_time(file, code);
  if (code) return false;
  const auto built = std::filesystem::last_write_time("/proc/self/exe", code);
  return !code && built <= written;
}

}  // namespace

UnfinishedRecords::UnfinishedRecords(std::filesystem::path folder, const std::vector<RunSpec>& runs)
    : folder_(std::move(folder)), provenance_(without_date(provenance())) {
  for (const RunSpec& run : runs) {
    if (parts_.contains(run.study)) continue;
    const std::filesystem::path file = part_file(folder_, run.study);
    if (!is_newer_than_program(file)) std::filesystem::remove(file);
    parts_.emplace(run.study, RecordFile(file));
  }
}

std::optional<Json> UnfinishedRecords::record(const RunSpec& run) const {
  const RecordFile& part = parts_.at(run.study);
  const std::string key = run.key();
  if (!part.has(key)) return std::nullopt;
  Json record = part.record(key);
  if (without_date(record.at("provenance")) != provenance_) return std::nullopt;
  return record;
}

void UnfinishedRecords::append(const RunSpec& run, const Json& record) {
  parts_.at(run.study).append(record);
}

void UnfinishedRecords::remove() {
  for (const auto& [study, part] : parts_) std::filesystem::remove(part_file(folder_, study));
  parts_.clear();
}

}  // namespace liebench
