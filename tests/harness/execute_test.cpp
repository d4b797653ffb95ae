#include "harness/execute.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "groups/flattened.h"
#include "harness/progress.h"
#include "tests/support/run_program.h"

namespace liebench {
namespace {

class ExecuteTest : public testing::Test {
 protected:
  std::vector<Json> records(const Json& study, int jobs) {
    const Study read = read_study(study);
    std::vector<Json> list(read.runs.size());
    Progress progress("test", 1.0);
    execute(read.runs, jobs, cache, progress, [&](std::size_t index, const Json& record) {
      EXPECT_TRUE(list.at(index).is_null()) << "handed over twice";
      list.at(index) = record;
    });
    return list;
  }

  static Json small_study() {
    return parse_json(
        R"({"name": "small", "problems": [{"name": "heavy_top", "formulation": ["SO3", "R3xSO3"]}],
                          "integrators": [{"name": "bliedf2nd", "k": [2, 4], "correction": [true, false]}],
                          "step_sizes": [0.01, 0.002, 0.001], "t_end": 0.05,
                          "precision": ["double", "extended"]})",
        "test");
  }

  TemporaryFolder folder;
  ReferenceCache cache{folder.path()};
};

// Everything but the date.
std::vector<std::string> texts(std::vector<Json> records) {
  std::vector<std::string> list;
  for (Json& record : records) {
    record["provenance"].erase("date");
    list.push_back(record.dump());
  }
  return list;
}

// Printed with four digits by an independent prototype (other language, group classes and Newton method, its
// reference by another route): relative errors at t_end = 2 s of runs with h = 1e-4 s in extended precision,
// paper's data, starting values from the reference.
TEST_F(ExecuteTest, TheErrorsAgreeWithAnIndependentProgram) {
  struct Printed {
    int k;
    std::string formulation, component;
    double error;
  };
  const std::vector<Printed> all{
      {4, "R3xSO3", "q", 1.014e-07}, {4, "R3xSO3", "lambda", 9.826e-08}, {4, "SO3", "q", 1.382e-06},
      {3, "R3xSO3", "q", 3.452e-05}, {3, "R3xSO3", "lambda", 7.405e-06}, {3, "SO3", "q", 6.257e-04},
      {2, "R3xSO3", "q", 5.488e-04}, {2, "R3xSO3", "lambda", 5.278e-04}, {2, "SO3", "q", 1.073e-02}};
  Json study = small_study();
  study["integrators"] = Json::array(
      {{{"name", "bliedf2nd"}, {"k", detail::sanitized ? Json(4) : Json({4, 3, 2})}}});  // slow under ASan
  study["step_sizes"] = Json::array({1e-4});
  study["t_end"] = 2.0;
  study["precision"] = "extended";
  std::map<std::pair<int, std::string>, Json> errors;
  for (const Json& record : records(study, 2)) {
    ASSERT_EQ(record["outcome"], "ok");
    EXPECT_EQ(record["steps"], 20000);
    EXPECT_LT(record["reference"]["error_estimate"].get<double>(), 1e-25);
    errors[{record["options"]["k"].get<int>(), record["formulation"].get<std::string>()}] = record["errors"];
  }
  for (const Printed& printed : all) {
    const auto found = errors.find({printed.k, printed.formulation});
    if (found == errors.end()) {
      EXPECT_TRUE(detail::sanitized && printed.k != 4) << "no run";
      continue;
    }
    // 0.1 %: the last printed digit alone is 0.05 %.
    EXPECT_NEAR(found->second[printed.component]["end_relative"].get<double>() / printed.error, 1.0, 1e-3)
        << printed.formulation << " k = " << printed.k << " " << printed.component;
  }
}

TEST_F(ExecuteTest, TheRecordsDoNotDependOnTheNumberOfThreads) {
  const auto one = texts(records(small_study(), 1));
  EXPECT_EQ(one.size(), 48u);
  EXPECT_TRUE(texts(records(small_study(), 2)) == one);
  EXPECT_TRUE(texts(records(small_study(), 7)) == one);
}

TEST_F(ExecuteTest, TheRecordsDoNotDependOnTheCache) {
  const auto computed = texts(records(small_study(), 2));
  EXPECT_FALSE(folder.entries().empty()) << "nothing was stored";
  EXPECT_TRUE(texts(records(small_study(), 2)) == computed);
  cache = ReferenceCache(std::filesystem::path());
  EXPECT_TRUE(texts(records(small_study(), 2)) == computed);
}

// A shard, or the rest of a study that was stopped, must write what the whole study does.

TEST_F(ExecuteTest, TheErrorsOfARunDoNotDependOnTheOtherRunsOfItsStudy) {
  const auto whole = records(small_study(), 1);
  Json alone = small_study();
  alone["step_sizes"] = Json::array({0.001});
  const auto part = records(alone, 1);
  ASSERT_EQ(part.size() * 3, whole.size());
  for (std::size_t i = 0; i < part.size(); ++i)
    for (const char* name : {"key", "outcome", "errors", "drift", "cost"})
      EXPECT_EQ(part[i][name].dump(), whole[3 * i + 2][name].dump()) << name;
}

TEST_F(ExecuteTest, TheReferenceOfARunDoesNotDependOnTheOtherRunsOfItsStudy) {
  Json alone = small_study();
  alone["step_sizes"] = Json::array({0.001});
  EXPECT_EQ(records(alone, 1).back()["reference"].dump(),
            records(small_study(), 1).back()["reference"].dump());
}

TEST_F(ExecuteTest, NothingToRunIsNoError) {
  Progress progress("test", 0.0);
  execute({}, 2, cache, progress, [](std::size_t, const Json&) { ADD_FAILURE(); });
  EXPECT_TRUE(folder.entries().empty());
}

TEST_F(ExecuteTest, WhatTheTakerThrowsComesThroughAndStopsTheRest) {
  const Study study = read_study(small_study());
  Progress progress("test", 1.0);
  for (const int jobs : {1, 3}) {
    int calls = 0;
    EXPECT_THROW(execute(study.runs, jobs, cache, progress,
                         [&](std::size_t, const Json&) {
                           if (++calls == 2) throw std::runtime_error("disk full");
                         }),
                 std::runtime_error);
    EXPECT_LT(calls, 2 + jobs + 1);
  }
}

TEST_F(ExecuteTest, RoundOffSeparatesThePrecisions) {
  // h = 1e-3, k = 4, constrained: the drift off the constraint is what Newton's method leaves.
  double drift[2] = {};
  for (const Json& record : records(small_study(), 2)) {
    if (record["formulation"] != "R3xSO3" || record["outcome"] != "ok") continue;
    double& largest = drift[record["precision"] == "extended" ? 1 : 0];
    largest = std::max(largest, record["drift"]["position_constraint"].get<double>());
  }
  EXPECT_GT(drift[0], 1e-20);
  EXPECT_LT(drift[0], 1e-10);
  EXPECT_LT(drift[1], 1e-22) << "extended runs meet the constraint far below double's eps";
}

TEST(ExpectedWork, GrowsWithStepsPrecisionAndConstraints) {
  const auto run = [](const char* formulation, const char* precision, double h) {
    Json study;
    study["name"] = "x";
    study["problems"] = Json::array({{{"name", "heavy_top"}, {"formulation", formulation}}});
    study["integrators"] = Json::array({{{"name", "bliedf2nd"}}});
    study["step_sizes"] = Json::array({h});
    study["t_end"] = 1.0;
    study["precision"] = precision;
    return expected_work(read_study(study).runs.at(0));
  };
  EXPECT_GT(run("SO3", "double", 0.1), 0.0);
  EXPECT_GT(run("SO3", "double", 0.01), run("SO3", "double", 0.1));
  EXPECT_GT(run("SO3", "extended", 0.01), run("SO3", "double", 0.01));
  EXPECT_GT(run("R3xSO3", "double", 0.01), run("SO3", "double", 0.01));
  EXPECT_GE(default_jobs(), 1);
}

}  // namespace
}  // namespace liebench
