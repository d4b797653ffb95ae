#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/stability/case.h"

namespace liebench {

class Progress;

// A trial with its case and its place in the suite.
struct SuiteTrial {
  const StabilityCase* owner = nullptr;
  Trial trial;
  // Version of the suite, case, method and parameters in canonical form, hashed.
  std::string key() const;
};

// Raised whenever a change of the suite alters its records.
inline constexpr int stability_version = 1;

// The trials of these cases, or of all where none is named; `quick`: the fast half alone. Throws InputError for an unknown name.
std::vector<SuiteTrial> suite(const std::vector<std::string>& only, bool quick);

// Its line in the file of records (docs/stability.md).
Json stability_record(const SuiteTrial& trial, const Finding& finding, const Json& provenance);

// Runs all on `jobs` threads, longest first, and hands each record to `take(index, record)`, one call at a time. The records do not
// depend on `jobs`.
void run_suite(const std::vector<SuiteTrial>& trials, int jobs, Progress& progress,
               const std::function<void(std::size_t, const Json&)>& take);

}  // namespace liebench
