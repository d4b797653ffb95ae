#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <string>

#include "harness/embedded.h"
#include "harness/figures.h"
#include "tests/harness/json_schema.h"
#include "tests/harness/sample_studies.h"

namespace liebench {
namespace {

// The schema and the program.

TEST(Study, TheStudiesOfTheFiguresAreValidByTheSchemaAndAccepted) {
  const JsonSchema schema(embedded_file("study.schema.json"));
  for (const PaperFigure& figure : paper_figures()) {
    ASSERT_FALSE(figure.studies.empty()) << figure.name;
    for (const std::string_view file : figure.studies) {
      const std::string_view text = embedded_file(file);
      EXPECT_EQ(schema.violations(text), "") << file;
      const Study study = read_study(parse_json(text, std::string(file)));
      EXPECT_TRUE(study.name.starts_with(figure.name)) << file;
      EXPECT_FALSE(study.runs.empty()) << file;
    }
  }
}

TEST(Study, WhatTheProgramAcceptsIsValidByTheSchema) {
  const JsonSchema schema(embedded_file("study.schema.json"));
  std::vector<Json> accepted{
      base_study(),
      changed_study("/problems/0/formulation", ""),
      changed_study("/problems/0/formulation", "[\"SO3\", \"R3xSO3\"]"),
      changed_study("/problems/0/parameters",
                    R"({"mass": [10, 15], "inertia": [1, 2, 3], "gravity": [0, 0, -1]})"),
      changed_study("/problems/0/parameters",
                    R"({"inertia": [[2,0.5,0],[0.5,2,0],[0,0,1]], "orientation": [1,1,0,0]})"),
      changed_study("/integrators/0", R"({"name": "bliedf2nd", "k": [1, 2.0], "correction": [true, false],
                                    "modified_start": true, "form": "index3"})"),
      changed_study("/step_sizes", R"({"from": 1e-2, "to": 1e-3, "per_decade": 4})"),
      changed_study("/t_0", "-1.5"),
      changed_study("/start", "\"reference\""),
      changed_study("/precision", "[\"double\", \"extended\"]")};
  accepted.push_back(changed_study("/t_end", ""));
  accepted.back()["steps"] = 3;
  for (const Json& study : accepted) {
    EXPECT_NO_THROW(read_study(study)) << study;
    EXPECT_EQ(schema.violations(study.dump()), "") << study;
  }
}

TEST(Study, TheSchemaItselfRefusesWhatAnEditorShouldUnderline) {
  const JsonSchema schema(embedded_file("study.schema.json"));
  const std::vector<std::pair<std::string, std::string>> bad{{"/name", ""},
                                                             {"/name", "\"\""},
                                                             {"/problems", "[]"},
                                                             {"/problems/0/name", ""},
                                                             {"/problems/0/formulations", "\"SO3\""},
                                                             {"/integrators", "[]"},
                                                             {"/integrators/0/name", ""},
                                                             {"/integrators/0/k", "[]"},
                                                             {"/integrators/0/k", "null"},
                                                             {"/step_sizes", "[]"},
                                                             {"/step_sizes", "0.1"},
                                                             {"/step_sizes/0", "0"},
                                                             {"/step_sizes/0", "-1"},
                                                             {"/step_sizes", R"({"from": 1e-2, "to": 1e-3})"},
                                                             {"/t_end", ""},
                                                             {"/t_end", "null"},
                                                             {"/steps", "1"},
                                                             {"/start", "\"now\""},
                                                             {"/precision", "\"half\""},
                                                             {"/precision", "[]"},
                                                             {"/step_size", "1"}};
  for (const auto& [pointer, value] : bad)
    EXPECT_NE(schema.violations(changed_study(pointer, value).dump()), "") << pointer << " = " << value;
}

// Expansion.

TEST(StudyExpansion, IsTheProductOfAllListsInTheOrderOfTheFile) {
  Json study = base_study();
  study["problems"][0]["formulation"] = {"SO3", "R3xSO3"};
  study["problems"][0]["parameters"] = {{"mass", {10, 20}}};
  study["integrators"] = parse_json(
      R"([{"name": "bliedf2nd", "k": [3, 2], "correction": [false, true]}, {"name": "bliedf2nd", "k": 1}])",
      "test");
  study["precision"] = {"extended", "double"};
  study["step_sizes"] = {0.01, 0.02};
  std::vector<std::string> expected, actual;
  for (const char* formulation : {"SO3", "R3xSO3"})
    for (const int mass : {10, 20})
      for (const auto& [k, correction] :
           std::vector<std::pair<int, bool>>{{3, false}, {3, true}, {2, false}, {2, true}, {1, true}})
        for (const char* precision : {"extended", "double"})
          for (const double h : {0.01, 0.02})
            expected.push_back(
                fmt::format("{} {} {} {} {} {}", formulation, mass, k, correction, precision, h));
  for (const RunSpec& run : runs_of(study))
    actual.push_back(fmt::format("{} {} {} {} {} {}", run.formulation->name,
                                 run.parameters["mass"].get<double>(), run.request.options.integer("k"),
                                 run.request.options.boolean("correction"), name(run.precision),
                                 run.requested_step_size));
  EXPECT_EQ(actual, expected);
}

TEST(StudyExpansion, DoesNotTakeAVectorForAListOfChoices) {
  const Json study =
      changed_study("/problems/0/parameters",
                    R"({"inertia": [1, 2, 3], "gravity": [0, 1, 2], "angular_velocity": [3, 4, 5],
                                 "center_of_mass": [6, 7, 8], "orientation": [1, 0, 0, 1]})");
  const RunSpec run = only_run(study);
  EXPECT_EQ(run.parameters["angular_velocity"], Json({3.0, 4.0, 5.0}));
  EXPECT_EQ(run.parameters["inertia"], Json({{1.0, 0.0, 0.0}, {0.0, 2.0, 0.0}, {0.0, 0.0, 3.0}}));
}

TEST(StudyExpansion, LeavesNoParameterAndNoOptionToADefaultUnsaid) {
  const RunSpec run = only_run(base_study());
  for (const ParameterInfo& info : run.problem->parameters)
    EXPECT_TRUE(run.parameters.contains(info.name)) << info.name;
  for (const OptionInfo& info : run.method->options)
    EXPECT_NE(run.request.options.all().contains(info.name), info.unsaid) << info.name;
  EXPECT_EQ(run.precision, Precision::double_precision);
  EXPECT_EQ(run.request.start, Start::reference);
  EXPECT_EQ(run.t_0, 0.0);
}

TEST(StudyExpansion, SaysTheSameRunOnceOnly) {
  Json study = base_study();
  study["problems"] = parse_json(R"([{"name": "heavy_top"}, {"name": "heavy_top", "formulation": "SO3",
                                      "parameters": {"mass": [15, 15.0]}}])",
                                 "test");
  study["integrators"][0]["k"] = parse_json("[2, 2, 2.0]", "test");
  study["precision"] = {"double", "double"};
  study["step_sizes"] = {0.01, 1e-2, 0.0100000000000000001};
  EXPECT_EQ(runs_of(study).size(), 1u);
  // Different wishes, one grid: both divide [0, 0.1] into 4 steps.
  EXPECT_EQ(runs_of(changed_study("/step_sizes", "[0.03, 0.026]")).size(), 1u);
}

TEST(StudyExpansion, ARangeOfStepSizesIsLogarithmicAndKeepsBothEnds) {
  Json study = changed_study("/step_sizes", R"({"from": 1e-2, "to": 1e-5, "per_decade": 4})");
  study["t_end"] = 2.0;
  const auto list = runs_of(study);
  ASSERT_EQ(list.size(), 13u);
  for (std::size_t i = 0; i < list.size(); ++i)
    EXPECT_NEAR(list[i].requested_step_size / std::pow(10.0, -2.0 - double(i) / 4.0), 1.0, 1e-14);
  EXPECT_EQ(list.front().requested_step_size, 1e-2);
  // No end inside a step: 1e-2, 1e-3 and no further.
  EXPECT_EQ(runs_of(changed_study("/step_sizes", R"({"from": 1e-2, "to": 3e-4, "per_decade": 1})")).size(),
            2u);
  EXPECT_EQ(runs_of(changed_study("/step_sizes", R"({"from": 1e-2, "to": 1e-2, "per_decade": 7})")).size(),
            1u);
}

TEST(StudyGrid, AStepSizeThatDividesTheIntervalIsKept) {
  // 0.3 / 0.1 is 2.9999999999999996 in double, 0.7 / 0.1 is 6.999999999999999, 1.1 / 0.1
  // is 11.000000000000002.
  const std::vector<std::array<double, 3>> cases{{0.3, 0.1, 3},     {0.7, 0.1, 7},    {1.1, 0.1, 11},
                                                 {2.0, 1e-3, 2000}, {2.0, 1e-6, 2e6}, {0.3, 1e-7, 3e6}};
  for (const auto& [t_end, h, steps] : cases) {
    Json study = base_study();
    study["t_end"] = t_end;
    study["step_sizes"] = {h};
    const RunSpec run = only_run(study);
    EXPECT_EQ(double(run.request.steps), steps) << t_end << " / " << h;
    EXPECT_EQ(run.step_size(), h) << t_end << " / " << h;
    EXPECT_EQ(run.requested_step_size, h);
  }
}

TEST(StudyGrid, AStepSizeThatDoesNotDivideTheIntervalBecomesTheNextSmallerThatDoes) {
  for (const double t_0 : {0.0, 0.25, -3.0})
    for (const double length : {0.1, 1.0, 2.0, 3.7})
      for (const double h : {0.03, 0.0123456789, 1e-3 / 3.0, 7.7e-3, 3.16227766e-5}) {
        Json study = base_study();
        study["t_0"] = t_0;
        study["t_end"] = t_0 + length;
        study["step_sizes"] = {h};
        const RunSpec run = only_run(study);
        const double n = double(run.request.steps);
        // eps of a division; a step size may exceed the wish by round-off alone.
        EXPECT_LE(run.step_size(), h * (1.0 + 1e-11)) << length << " / " << h;
        EXPECT_GT((run.t_end - t_0) / (n - 1.0), h * (1.0 - 1e-11)) << "fewer steps would have done";
        EXPECT_NEAR(run.step_size() * n, run.t_end - t_0, 4e-15 * std::abs(run.t_end) + 4e-15 * length);
        EXPECT_EQ(run.requested_step_size, h);
      }
}

TEST(StudyGrid, TheStepSizeIsTheExactQuotientOfTheDecimals) {
  // 2 / 3000 in 106 bits, not the double next to it: an extended run must not inherit 1e-16.
  Json study = base_study();
  study["t_end"] = 0.3;  // no double
  study["step_sizes"] = {0.1};
  study["precision"] = "extended";
  const RunSpec run = only_run(study);
  const Extended three_tenths = Extended(3.0) / Extended(10.0);
  EXPECT_LE(std::abs(to_double(Extended(run.request.step_size * 3.0) - three_tenths)), 1e-31);
}

TEST(StudyGrid, LocalRunsTakeTheirStepsAfterTheStartingValues) {
  for (int k = 1; k <= 4; ++k) {
    Json study = changed_study("/t_end", "");
    study["integrators"][0]["k"] = k;
    study["steps"] = 5;
    study["step_sizes"] = {0.003};
    const RunSpec run = only_run(study);
    EXPECT_EQ(run.request.steps, std::uint64_t(k - 1 + 5));
    EXPECT_EQ(run.step_size(), 0.003);
    EXPECT_DOUBLE_EQ(run.t_end, 0.003 * (k - 1 + 5));
  }
}

TEST(StudyGrid, AsManyStepsAsTheStartNeedsAreEnough) {
  Json study = base_study();
  study["step_sizes"] = {0.04};  // 3 steps of 0.1 / 3, and k = 3
  EXPECT_EQ(only_run(study).request.steps, 3u);
}

// Keys.

TEST(RunKey, IsThirtyTwoHexadecimalDigits) {
  const std::string key = only_run(base_study()).key();
  EXPECT_EQ(key.size(), 32u);
  EXPECT_EQ(key.find_first_not_of("0123456789abcdef"), std::string::npos) << key;
}

TEST(RunKey, IsTheSameForTheSameInputHoweverItIsWritten) {
  const std::string key = only_run(base_study()).key();
  EXPECT_EQ(only_run(base_study()).key(), key);
  EXPECT_EQ(only_run(changed_study("/name", "\"another name\"")).key(), key);
  EXPECT_EQ(only_run(changed_study("/integrators/0/k", "3.0")).key(), key);
  EXPECT_EQ(only_run(changed_study("/integrators/0/k", "[3]")).key(), key);
  EXPECT_EQ(only_run(changed_study("/integrators/0/correction", "true")).key(), key);
  EXPECT_EQ(only_run(changed_study("/step_sizes/0", "0.01000")).key(), key);
  EXPECT_EQ(only_run(changed_study("/precision", "\"double\"")).key(), key);
  EXPECT_EQ(only_run(changed_study("/t_0", "0")).key(), key);
  EXPECT_EQ(only_run(changed_study("/problems/0/parameters", "{\"mass\": 15}")).key(), key);
  EXPECT_EQ(
      only_run(changed_study("/problems/0/parameters", R"({"gravity": [0, 0, -9.81], "mass": 15.0})")).key(),
      key);
  EXPECT_EQ(only_run(parse_json(R"({"t_end": 0.1, "step_sizes": [1e-2], "start": "reference",
                                    "integrators": [{"k": 3, "name": "bliedf2nd"}], "name": "test",
                                    "problems": [{"formulation": "R3xSO3", "name": "heavy_top"}]})",
                                "test"))
                .key(),
            key);
}

TEST(RunKey, IsAnotherAfterAnyChangeOfInput) {
  const std::vector<std::pair<std::string, std::string>> changes{
      {"/problems/0/formulation", "\"SO3\""},
      {"/problems/0/parameters", R"({"mass": 15.000000000000002})"},
      {"/problems/0/parameters", R"({"inertia": [0.234375, 0.46875, 0.2343751]})"},
      {"/problems/0/parameters", R"({"inertia": [[0.234375,1e-9,0],[1e-9,0.46875,0],[0,0,0.234375]]})"},
      {"/problems/0/parameters", R"({"center_of_mass": [0, 1.5, 0]})"},
      {"/problems/0/parameters", R"({"gravity": [0, 0, -9.80665]})"},
      {"/problems/0/parameters", R"({"orientation": [1, 1e-9, 0, 0]})"},
      {"/problems/0/parameters", R"({"angular_velocity": [0, 150, -4.61539]})"},
      {"/integrators/0/k", "2"},
      {"/integrators/0/correction", "false"},
      {"/integrators/0/modified_start", "true"},
      {"/precision", "\"extended\""},
      {"/step_sizes/0", "0.005"},
      {"/t_0", "0.05"},
      {"/t_end", "0.2"}};
  std::set<std::string> keys{only_run(base_study()).key()};
  for (const auto& [pointer, value] : changes)
    EXPECT_TRUE(keys.insert(only_run(changed_study(pointer, value)).key()).second)
        << pointer << " = " << value;
  // The same grid as the base study, asked for as a number of steps.
  Json local = changed_study("/t_end", "");
  local["steps"] = 8;
  EXPECT_EQ(only_run(local).request.steps, only_run(base_study()).request.steps);
  EXPECT_TRUE(keys.insert(only_run(local).key()).second);
  local["step_sizes"] = {0.011};
  EXPECT_TRUE(keys.insert(only_run(local).key()).second);
  local["steps"] = 9;
  EXPECT_TRUE(keys.insert(only_run(local).key()).second);
}

}  // namespace
}  // namespace liebench
