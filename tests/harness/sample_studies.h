#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "harness/study.h"

// Studies of the tests: one that is accepted, and changes of it.

namespace liebench {

inline Json base_study() {
  return parse_json(R"({"name": "test", "problems": [{"name": "heavy_top", "formulation": "R3xSO3"}],
                        "integrators": [{"name": "bliedf2nd", "k": 3}], "step_sizes": [1e-2], "start": "reference", "t_end": 0.1})",
                    "test");
}

// The base study with the value at `pointer` replaced or added; an empty text removes the key there.
inline Json changed_study(const std::string& pointer, const std::string& value) {
  Json study = base_study();
  const Json::json_pointer place(pointer);
  if (value.empty())
    study[place.parent_pointer()].erase(place.back());
  else
    study[place] = parse_json(value, "value");
  return study;
}

inline std::vector<RunSpec> runs_of(const Json& study) {
  return read_study(study).runs;
}
// The one run of a study.
inline RunSpec only_run(const Json& study) {
  auto list = runs_of(study);
  EXPECT_EQ(list.size(), 1u);
  return list.at(0);
}

}  // namespace liebench
