#pragma once

#include <string>
#include <vector>

#include "harness/record_row.h"

// What changed between two sets of records; rules in docs/records.md.

namespace liebench {

inline constexpr double default_band = 10.0;

struct Comparison {
  std::size_t matched = 0;
  // One line a change, in the order of the old records; `added` in that of the new ones.
  std::vector<std::string> outcomes, counts, errors, missing, added, times;

  bool differs(bool times_count) const {
    return !(outcomes.empty() && counts.empty() && errors.empty() && missing.empty() && added.empty()) ||
           (times_count && !times.empty());
  }
};

// Rows belong together by key, else by the identity of their curve, step size and steps. Counts and outcomes must be equal.
// Two errors are equal where they differ by no more than 1e-6 of the larger plus
// band * eps * steps * size: eps is the unit round-off of the row's precision; size is 1 for a relative error
// and the size of the solution, at least 1, for an absolute one. Times differ where the repetitions say so
// by rank_test at 1 % and the medians by more than 10 %.
Comparison compare_records(const std::vector<RecordRow>& before, const std::vector<RecordRow>& after,
                           double band = default_band);

// A line of summary and the changes by kind, twenty of each.
std::string report(const Comparison& comparison);

}  // namespace liebench
