#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/record_row.h"

// What the paper claims and what was measured: docs/verification.md is this text.

namespace liebench {

struct Verification {
  std::string markdown;
  std::string
      csv;  // of the order matrix: every curve and error with its window; empty where its studies are missing
  int claims = 0;
  int confirmed = 0;
};

// Judges every claim by the records of the figures' studies in extended precision. `note` is a sentence about
// the run that made them, such as that it was the short form.
Verification verify(const std::map<std::string, std::vector<RecordRow>>& records_by_study,
                    const std::string& note);

}  // namespace liebench
