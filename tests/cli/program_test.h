#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "harness/strict_json.h"
#include "tests/support/run_program.h"

namespace liebench {

// Runs the program under test (compile definition LIEBENCH_PROGRAM) in a folder of its own, with a cache of
// references of its own outside that folder.
class ProgramTest : public testing::Test {
 protected:
  ProgramCall call(std::vector<std::string> arguments) const {
    return {.program = LIEBENCH_PROGRAM,
            .arguments = std::move(arguments),
            .folder = folder.path(),
            .environment = {{"LIEBENCH_CACHE", cache_.path().string()}}};
  }
  // Without timed runs, which would take a second for every few rows; those: call().
  ProgramResult run(std::vector<std::string> arguments) const {
    if (arguments.front() == "run" && arguments.back() != "--help") arguments.emplace_back("--no-timing");
    return run_program(call(std::move(arguments)));
  }

  // Writes a study in the program's folder.
  void write_study(const Json& study, std::string_view name = "study.json") const {
    folder.write(name, study.dump(2) + "\n");
  }

  TemporaryFolder folder;

 private:
  TemporaryFolder cache_;
};

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// Both formulations, double precision, in a few milliseconds: 4 runs that end well.
inline Json small_study() {
  return parse_json(
      R"({"name": "small", "problems": [{"name": "heavy_top", "formulation": ["SO3", "R3xSO3"]}],
                        "integrators": [{"name": "bliedf2nd", "k": 2}], "step_sizes": [0.01, 0.005], "t_end": 0.05})",
      "small_study");
}

// The records of a JSON Lines text.
inline std::vector<Json> records_of(const std::string& text) {
  std::vector<Json> records;
  for (const std::string& line : lines_of(text)) records.push_back(parse_json(line, "record"));
  return records;
}

// Their keys, in their order.
inline std::vector<std::string> keys_of(const std::string& text) {
  std::vector<std::string> keys;
  for (const Json& record : records_of(text)) keys.push_back(record.at("key").get<std::string>());
  return keys;
}

}  // namespace liebench
