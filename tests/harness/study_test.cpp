#include "harness/study.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <string>

#include "harness/embedded.h"
#include "harness/errors.h"
#include "harness/figures.h"
#include "tests/harness/json_schema.h"

namespace liebench {
namespace {

Json base() {
  return parse_json(R"({"name": "test", "problems": [{"name": "heavy_top", "formulation": "R3xSO3"}],
                        "integrators": [{"name": "bliedf2nd", "k": 3}], "step_sizes": [1e-2], "start": "reference", "t_end": 0.1})",
                    "test");
}

// The base study with the value at `pointer` replaced or added; an empty text removes the key there.
Json changed(const std::string& pointer, const std::string& value) {
  Json study = base();
  const Json::json_pointer place(pointer);
  if (value.empty())
    study[place.parent_pointer()].erase(place.back());
  else
    study[place] = parse_json(value, "value");
  return study;
}

std::vector<RunSpec> runs(const Json& study) {
  return read_study(study).runs;
}
RunSpec only_run(const Json& study) {
  auto list = runs(study);
  EXPECT_EQ(list.size(), 1u);
  return list.at(0);
}

// Bad input: one change of the base study, and what its refusal must say.

struct BadStudy {
  const char* law;
  const char* pointer;
  const char* value;
  const char* place;
  std::vector<const char*> says;
};

void PrintTo(const BadStudy& bad, std::ostream* out) {
  *out << bad.pointer << " = " << bad.value;
}

class BadStudyIsRefused : public testing::TestWithParam<BadStudy> {};

TEST_P(BadStudyIsRefused, WithPlaceValueAndWhatIsAllowed) {
  const BadStudy& bad = GetParam();
  try {
    const Study study = read_study(changed(bad.pointer, bad.value));
    FAIL() << "accepted, " << study.runs.size() << " runs";
  } catch (const InputError& error) {
    EXPECT_EQ(error.place(), bad.place) << error.what();
    for (const char* part : bad.says)
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
          << "not found: " << part << "\nmessage: " << error.what();
  }
}

const char* const positive_step = "a positive step size in s";
const char* const inertia =
    "3 positive principal moments, or a symmetric positive definite 3 x 3 matrix as a list of rows";

INSTANTIATE_TEST_SUITE_P(
    Names, BadStudyIsRefused,
    testing::Values(BadStudy{"misspelt_method",
                             "/integrators/0/name",
                             "\"bliedf2\"",
                             "/integrators/0/name",
                             {"unknown integrator \"bliedf2\"",
                              "allowed: \"bliedf2nd\", \"generalized_alpha\" or \"faltinsen_bdf\"",
                              "did you mean \"bliedf2nd\"?"}},
                    BadStudy{"unknown_method",
                             "/integrators/0/name",
                             "\"rk4\"",
                             "/integrators/0/name",
                             {"unknown integrator \"rk4\"", "allowed: \"bliedf2nd\""}},
                    BadStudy{"misspelt_problem",
                             "/problems/0/name",
                             "\"heavy-top\"",
                             "/problems/0/name",
                             {"unknown problem \"heavy-top\"", "did you mean \"heavy_top\"?"}},
                    BadStudy{"misspelt_formulation",
                             "/problems/0/formulation",
                             "\"SO_3\"",
                             "/problems/0/formulation",
                             {"unknown formulation \"SO_3\"", "\"SO3\", \"S3\", \"R3xSO3\"",
                              "did you mean \"SO3\"?"}},
                    BadStudy{"formulation_in_list",
                             "/problems/0/formulation",
                             "[\"SO3\", \"SE2\"]",
                             "/problems/0/formulation/1",
                             {"\"SE2\"", "\"SE3\", \"S3|xR3\" or \"UDQ\""}},
                    BadStudy{"misspelt_key",
                             "/step_size",
                             "[1]",
                             "/step_size",
                             {"unknown key \"step_size\"", "\"step_sizes\"", "did you mean \"step_sizes\"?"}},
                    BadStudy{"misspelt_problem_key",
                             "/problems/0/formulations",
                             "\"SO3\"",
                             "/problems/0/formulations",
                             {"unknown key", "did you mean \"formulation\"?"}},
                    BadStudy{"misspelt_parameter",
                             "/problems/0/parameters",
                             "{\"mas\": 3}",
                             "/problems/0/parameters/mas",
                             {"unknown key \"mas\"", "did you mean \"mass\"?"}},
                    BadStudy{"parameter_key_with_slash",
                             "/problems/0/parameters",
                             "{\"a/b\": 3}",
                             "/problems/0/parameters/a~1b",
                             {"unknown key \"a/b\""}},
                    BadStudy{"misspelt_option",
                             "/integrators/0/correctio",
                             "true",
                             "/integrators/0/correctio",
                             {"unknown key \"correctio\"", "did you mean \"correction\"?"}},
                    BadStudy{"misspelt_precision",
                             "/precision",
                             "\"extend\"",
                             "/precision",
                             {"\"extend\"", "\"double\" or \"extended\"", "did you mean \"extended\"?"}},
                    BadStudy{"unknown_start",
                             "/start",
                             "\"selfish\"",
                             "/start",
                             {"\"selfish\"", "\"self\" or \"reference\"", "did you mean \"self\"?"}},
                    BadStudy{"empty_name", "/name", "\"\"", "/name", {"\"\"", "not empty"}}),
    [](const auto& info) { return info.param.law; });

INSTANTIATE_TEST_SUITE_P(
    Steps, BadStudyIsRefused,
    testing::Values(
        BadStudy{"negative_step", "/step_sizes/0", "-0.001", "/step_sizes/0", {"-0.001", positive_step}},
        BadStudy{"zero_step", "/step_sizes/0", "0", "/step_sizes/0", {"0 is not allowed", positive_step}},
        BadStudy{"minus_zero_step", "/step_sizes/0", "-0.0", "/step_sizes/0", {positive_step}},
        BadStudy{"second_step", "/step_sizes", "[0.01, -0.5]", "/step_sizes/1", {"-0.5", positive_step}},
        BadStudy{"null_step", "/step_sizes/0", "null", "/step_sizes/0", {"null", positive_step}},
        BadStudy{"text_step", "/step_sizes/0", "\"0.1\"", "/step_sizes/0", {"\"0.1\"", positive_step}},
        BadStudy{"one_number_for_the_list", "/step_sizes", "0.1", "/step_sizes", {"0.1", "a list"}},
        BadStudy{"too_many_steps",
                 "/step_sizes/0",
                 "1e-12",
                 "/step_sizes/0",
                 {"1e-12", "1e+11 steps", "at most 1e+09"}},
        BadStudy{"denormal_step", "/step_sizes/0", "1e-310", "/step_sizes/0", {"1e-310", "at most 1e+09"}},
        BadStudy{"too_few_steps_for_k",
                 "/step_sizes/0",
                 "0.05",
                 "/step_sizes/0",
                 {"0.05", "2 steps", "at least 3", "bliedf2nd", "k = 3"}},
        BadStudy{"step_beyond_the_interval",
                 "/step_sizes/0",
                 "5",
                 "/step_sizes/0",
                 {"5", "1 steps", "at least 3"}},
        BadStudy{"range_upside_down",
                 "/step_sizes",
                 R"({"from": 1e-4, "to": 1e-2, "per_decade": 4})",
                 "/step_sizes/to",
                 {"0.01", "0.0001"}},
        BadStudy{"range_negative",
                 "/step_sizes",
                 R"({"from": 1e-2, "to": -1e-4, "per_decade": 4})",
                 "/step_sizes/to",
                 {"-0.0001", positive_step}},
        BadStudy{"range_incomplete",
                 "/step_sizes",
                 R"({"from": 1e-2, "to": 1e-4})",
                 "/step_sizes/per_decade",
                 {"missing"}},
        BadStudy{"range_unknown_key",
                 "/step_sizes",
                 R"({"from": 1e-2, "to": 1e-4, "per_decades": 4})",
                 "/step_sizes/per_decades",
                 {"did you mean \"per_decade\"?"}},
        BadStudy{"range_fraction",
                 "/step_sizes",
                 R"({"from": 1e-2, "to": 1e-4, "per_decade": 2.5})",
                 "/step_sizes/per_decade",
                 {"2.5", "an integer from 1 to 100"}},
        // from / to overflows: the range must not end up empty.
        BadStudy{"range_without_end",
                 "/step_sizes",
                 R"({"from": 1e300, "to": 1e-300, "per_decade": 1})",
                 "/step_sizes",
                 {}}),
    [](const auto& info) { return info.param.law; });

INSTANTIATE_TEST_SUITE_P(
    Interval, BadStudyIsRefused,
    testing::Values(
        BadStudy{"end_before_start", "/t_end", "-1", "/t_end", {"-1", "after t_0 = 0"}},
        BadStudy{"end_is_start", "/t_end", "0", "/t_end", {"after t_0 = 0"}},
        BadStudy{"start_after_end", "/t_0", "3", "/t_end", {"0.1", "after t_0 = 3"}},
        BadStudy{"no_end", "/t_end", "", "/t_end", {"missing"}},
        BadStudy{"null_end", "/t_end", "null", "/t_end", {"null", "a time in s"}},
        BadStudy{"null_start", "/t_0", "null", "/t_0", {"null", "a finite time in s"}},
        BadStudy{"both_end_and_steps", "/steps", "1", "/steps", {"\"t_end\"", "\"steps\"", "not both"}}),
    [](const auto& info) { return info.param.law; });

INSTANTIATE_TEST_SUITE_P(
    Options, BadStudyIsRefused,
    testing::Values(
        BadStudy{"k_too_large", "/integrators/0/k", "7", "/integrators/0/k", {"7", "an integer from 1 to 6"}},
        BadStudy{"k_zero", "/integrators/0/k", "0", "/integrators/0/k", {"0", "an integer from 1 to 6"}},
        BadStudy{
            "k_negative", "/integrators/0/k", "-2", "/integrators/0/k", {"-2", "an integer from 1 to 6"}},
        BadStudy{
            "k_fraction", "/integrators/0/k", "2.5", "/integrators/0/k", {"2.5", "an integer from 1 to 6"}},
        BadStudy{
            "k_text", "/integrators/0/k", "\"2\"", "/integrators/0/k", {"\"2\"", "an integer from 1 to 6"}},
        BadStudy{
            "k_null", "/integrators/0/k", "null", "/integrators/0/k", {"null", "an integer from 1 to 6"}},
        BadStudy{"k_in_list", "/integrators/0/k", "[2, 3, 7]", "/integrators/0/k/2", {"7"}},
        BadStudy{"k_in_list_in_list", "/integrators/0/k", "[2, [3]]", "/integrators/0/k/1", {"[3]"}},
        BadStudy{"k_overflows_int", "/integrators/0/k", "4294967298", "/integrators/0/k", {"4294967298"}},
        BadStudy{"correction_number",
                 "/integrators/0/correction",
                 "1",
                 "/integrators/0/correction",
                 {"1 is not allowed", "true, false or \"implicit\""}},
        BadStudy{"correction_misspelt",
                 "/integrators/0/correction",
                 "\"implicitx\"",
                 "/integrators/0/correction",
                 {"\"implicitx\"", "true, false or \"implicit\"", "did you mean \"implicit\"?"}},
        BadStudy{"faltinsen_k",
                 "/integrators/0",
                 R"({"name": "faltinsen_bdf", "k": 5})",
                 "/integrators/0/k",
                 {"5", "an integer from 1 to 4"}},
        BadStudy{"faltinsen_variant",
                 "/integrators/0",
                 R"({"name": "faltinsen_bdf", "variant": "exakt"})",
                 "/integrators/0/variant",
                 {"\"exakt\"", "\"exact\" or \"bch\"", "did you mean \"exact\"?"}},
        BadStudy{"faltinsen_correction",
                 "/integrators/0",
                 R"({"name": "faltinsen_bdf", "correction": true})",
                 "/integrators/0/correction",
                 {"unknown key \"correction\"", "\"variant\""}},
        BadStudy{"rho_inf_too_large",
                 "/integrators/0",
                 R"({"name": "generalized_alpha", "rho_inf": 1.5})",
                 "/integrators/0/rho_inf",
                 {"1.5", "a number from 0 to 1"}},
        BadStudy{"rho_inf_negative",
                 "/integrators/0",
                 R"({"name": "generalized_alpha", "rho_inf": -0.1})",
                 "/integrators/0/rho_inf",
                 {"-0.1", "a number from 0 to 1"}},
        BadStudy{"rho_inf_null",
                 "/integrators/0",
                 R"({"name": "generalized_alpha", "rho_inf": null})",
                 "/integrators/0/rho_inf",
                 {"null", "a number from 0 to 1"}},
        BadStudy{"modified_start_number",
                 "/integrators/0/modified_start",
                 "1",
                 "/integrators/0/modified_start",
                 {"1", "true or false"}},
        BadStudy{"modified_start_of_the_stabilized_form",
                 "/integrators/0",
                 R"({"name": "bliedf2nd", "form": "stabilized_index2", "modified_start": true})",
                 "/integrators/0/modified_start",
                 {"has no effect", "\"form\": \"index3\""}},
        BadStudy{"form_unknown",
                 "/integrators/0/form",
                 "\"index2\"",
                 "/integrators/0/form",
                 {"\"index2\"", "\"index3\""}}),
    [](const auto& info) { return info.param.law; });

INSTANTIATE_TEST_SUITE_P(
    Parameters, BadStudyIsRefused,
    testing::Values(
        BadStudy{"mass_null",
                 "/problems/0/parameters/mass",
                 "null",
                 "/problems/0/parameters/mass",
                 {"null", "a positive number"}},
        BadStudy{"mass_negative",
                 "/problems/0/parameters/mass",
                 "-15",
                 "/problems/0/parameters/mass",
                 {"-15", "a positive number"}},
        BadStudy{
            "mass_zero", "/problems/0/parameters/mass", "0", "/problems/0/parameters/mass", {"positive"}},
        BadStudy{"mass_in_list",
                 "/problems/0/parameters/mass",
                 "[15, -1]",
                 "/problems/0/parameters/mass/1",
                 {"-1", "a positive number"}},
        BadStudy{"mass_list_empty",
                 "/problems/0/parameters/mass",
                 "[]",
                 "/problems/0/parameters/mass",
                 {"at least one"}},
        BadStudy{"inertia_negative",
                 "/problems/0/parameters/inertia",
                 "[1, -1, 1]",
                 "/problems/0/parameters/inertia",
                 {"[1,-1,1]", inertia}},
        BadStudy{"inertia_zero",
                 "/problems/0/parameters/inertia",
                 "[0, 0, 0]",
                 "/problems/0/parameters/inertia",
                 {"[0,0,0]", inertia}},
        BadStudy{"inertia_semidefinite",
                 "/problems/0/parameters/inertia",
                 "[[1,1,0],[1,1,0],[0,0,1]]",
                 "/problems/0/parameters/inertia",
                 {inertia}},
        BadStudy{"inertia_unsymmetric",
                 "/problems/0/parameters/inertia",
                 "[[1,0.1,0],[0,1,0],[0,0,1]]",
                 "/problems/0/parameters/inertia",
                 {"[[1,0.1,0],[0,1,0],[0,0,1]]", inertia}},
        BadStudy{"inertia_indefinite",
                 "/problems/0/parameters/inertia",
                 "[[1,2,0],[2,1,0],[0,0,1]]",
                 "/problems/0/parameters/inertia",
                 {inertia}},
        BadStudy{"inertia_short",
                 "/problems/0/parameters/inertia",
                 "[1, 1]",
                 "/problems/0/parameters/inertia",
                 {"[1,1]", inertia}},
        BadStudy{"inertia_ragged",
                 "/problems/0/parameters/inertia",
                 "[[1,0,0],[0,1],[0,0,1]]",
                 "/problems/0/parameters/inertia/1",
                 {"[0,1]", "3 finite numbers"}},
        BadStudy{"inertia_element_null",
                 "/problems/0/parameters/inertia",
                 "[[1,0,0],[0,null,0],[0,0,1]]",
                 "/problems/0/parameters/inertia/1/1",
                 {"null", "a finite number"}},
        BadStudy{"gravity_element_null",
                 "/problems/0/parameters/gravity",
                 "[0, 0, null]",
                 "/problems/0/parameters/gravity/2",
                 {"null", "a finite number"}},
        BadStudy{"gravity_number",
                 "/problems/0/parameters/gravity",
                 "9.81",
                 "/problems/0/parameters/gravity",
                 {"9.81", "a list of 3 finite numbers"}},
        BadStudy{"velocity_of_two",
                 "/problems/0/parameters/angular_velocity",
                 "[0, 150]",
                 "/problems/0/parameters/angular_velocity",
                 {"[0,150]", "a list of 3 finite numbers"}},
        BadStudy{"velocity_list_of_vectors",
                 "/problems/0/parameters/angular_velocity",
                 "[[0,1,0],[0,2,0],[0,3,0]]",
                 "/problems/0/parameters/angular_velocity/0",
                 {"[0,1,0]", "a finite number"}},
        BadStudy{"zero_quaternion",
                 "/problems/0/parameters/orientation",
                 "[0, 0, 0, 0]",
                 "/problems/0/parameters/orientation",
                 {"[0,0,0,0]", "not all zero"}},
        BadStudy{"quaternion_of_three",
                 "/problems/0/parameters/orientation",
                 "[1, 0, 0]",
                 "/problems/0/parameters/orientation",
                 {"[1,0,0]", "4 finite numbers"}},
        BadStudy{"parameters_list",
                 "/problems/0/parameters",
                 "[15]",
                 "/problems/0/parameters",
                 {"[15]", "an object"}},
        // m |X|^2 swamps J: the inertia about the tip has no digits left, so no top can be made of this.
        BadStudy{"mass_beyond_all_measure",
                 "/problems/0/parameters/mass",
                 "1e300",
                 "/problems/0/parameters/mass",
                 {"1e+300"}}),
    [](const auto& info) { return info.param.law; });

INSTANTIATE_TEST_SUITE_P(
    Shapes, BadStudyIsRefused,
    testing::Values(
        BadStudy{"no_name", "/name", "", "/name", {"missing"}},
        BadStudy{"no_problems", "/problems", "", "/problems", {"missing"}},
        BadStudy{"no_integrators", "/integrators", "", "/integrators", {"missing"}},
        BadStudy{"no_step_sizes", "/step_sizes", "", "/step_sizes", {"missing"}},
        BadStudy{"problem_without_name", "/problems/0/name", "", "/problems/0/name", {"missing"}},
        BadStudy{"integrator_without_name", "/integrators/0/name", "", "/integrators/0/name", {"missing"}},
        BadStudy{"name_number", "/name", "3", "/name", {"3", "text"}},
        BadStudy{"problems_object", "/problems", "{}", "/problems", {"{}", "a list"}},
        BadStudy{
            "problem_text", "/problems/0", "\"heavy_top\"", "/problems/0", {"\"heavy_top\"", "an object"}},
        BadStudy{"integrator_text",
                 "/integrators/0",
                 "\"bliedf2nd\"",
                 "/integrators/0",
                 {"\"bliedf2nd\"", "an object"}},
        BadStudy{"integrator_name_number",
                 "/integrators/0/name",
                 "1",
                 "/integrators/0/name",
                 {"1", "\"bliedf2nd\""}},
        BadStudy{"no_problem", "/problems", "[]", "/problems", {"[]", "at least one"}},
        BadStudy{"no_integrator", "/integrators", "[]", "/integrators", {"[]", "at least one"}},
        BadStudy{"no_step_size", "/step_sizes", "[]", "/step_sizes", {"[]", "at least one"}},
        BadStudy{"no_k", "/integrators/0/k", "[]", "/integrators/0/k", {"[]", "at least one"}},
        BadStudy{"no_precision", "/precision", "[]", "/precision", {"[]", "at least one"}},
        BadStudy{"no_formulation",
                 "/problems/0/formulation",
                 "[]",
                 "/problems/0/formulation",
                 {"[]", "at least one"}},
        BadStudy{"precision_number", "/precision", "16", "/precision", {"16", "\"double\""}}),
    [](const auto& info) { return info.param.law; });

TEST(Study, AFormIsRefusedWhereNoProblemHasConstraints) {
  Json study = changed("/integrators/0/form", "\"stabilized_index2\"");
  study["problems"][0]["formulation"] = {"SO3", "S3"};
  try {
    read_study(study);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.place(), "/integrators/0/form");
    EXPECT_NE(std::string(error.what()).find("a formulation with constraints"), std::string::npos)
        << error.what();
  }
}

TEST(Study, OptionsThatMeanNothingForARunAreAbsentFromIt) {
  Json study = changed("/integrators/0/form", R"(["index3", "stabilized_index2"])");
  study["problems"][0]["formulation"] = {"SO3", "R3xSO3"};
  std::vector<std::string> seen;
  for (const RunSpec& run : runs(study))
    seen.push_back(options_to_json(*run.method, run.request.options).dump());
  EXPECT_EQ(seen, (std::vector<std::string>{
                      R"({"k":3,"correction":true})",  // once, for the two forms that it has not
                      R"({"k":3,"correction":true,"modified_start":false,"form":"index3"})",
                      R"({"k":3,"correction":true,"form":"stabilized_index2"})"}));
}

TEST(Study, StartsByItselfUnlessToldOtherwise) {
  const RunSpec own = only_run(changed("/start", ""));
  EXPECT_EQ(own.request.start, Start::self);
  // The transient phase of the index-3 form then keeps its order.
  EXPECT_TRUE(own.request.options.boolean("modified_start"));
  EXPECT_FALSE(only_run(base()).request.options.boolean("modified_start"));
  Json study = changed("/start", "\"self\"");
  study["integrators"][0]["modified_start"] = false;
  EXPECT_FALSE(only_run(study).request.options.boolean("modified_start"));
  EXPECT_NE(own.key(), only_run(base()).key());
}

TEST(Study, WhatIsNotAnObjectIsRefused) {
  for (const char* text : {"[]", "null", "\"study\"", "3", "{}"})
    EXPECT_THROW(read_study(parse_json(text, "test")), InputError) << text;
}

TEST(Study, LocalRunsOfASizeThatNoReferenceCanCoverAreRefused) {
  // An interval has at most 1e9 steps; a fixed number of steps of 1e300 s would have no end either.
  Json study = changed("/t_end", "");
  study["steps"] = 1;
  study["step_sizes"] = {1e300};
  EXPECT_THROW(read_study(study), InputError);
}

TEST(Study, LocalRunsOfABadNumberOfStepsAreRefused) {
  for (const char* steps : {"0", "-1", "1.5", "1000001", "\"1\"", "null", "[1]"}) {
    Json study = changed("/t_end", "");
    study["steps"] = parse_json(steps, "steps");
    try {
      read_study(study);
      ADD_FAILURE() << "accepted: " << steps;
    } catch (const InputError& error) {
      EXPECT_EQ(error.place(), "/steps") << steps;
    }
  }
}

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
      base(),
      changed("/problems/0/formulation", ""),
      changed("/problems/0/formulation", "[\"SO3\", \"R3xSO3\"]"),
      changed("/problems/0/parameters", R"({"mass": [10, 15], "inertia": [1, 2, 3], "gravity": [0, 0, -1]})"),
      changed("/problems/0/parameters",
              R"({"inertia": [[2,0.5,0],[0.5,2,0],[0,0,1]], "orientation": [1,1,0,0]})"),
      changed("/integrators/0", R"({"name": "bliedf2nd", "k": [1, 2.0], "correction": [true, false],
                                    "modified_start": true, "form": "index3"})"),
      changed("/step_sizes", R"({"from": 1e-2, "to": 1e-3, "per_decade": 4})"),
      changed("/t_0", "-1.5"),
      changed("/start", "\"reference\""),
      changed("/precision", "[\"double\", \"extended\"]")};
  accepted.push_back(changed("/t_end", ""));
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
    EXPECT_NE(schema.violations(changed(pointer, value).dump()), "") << pointer << " = " << value;
}

// Expansion.

TEST(StudyExpansion, IsTheProductOfAllListsInTheOrderOfTheFile) {
  Json study = base();
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
  for (const RunSpec& run : runs(study))
    actual.push_back(fmt::format("{} {} {} {} {} {}", run.formulation->name,
                                 run.parameters["mass"].get<double>(), run.request.options.integer("k"),
                                 run.request.options.boolean("correction"), name(run.precision),
                                 run.requested_step_size));
  EXPECT_EQ(actual, expected);
}

TEST(StudyExpansion, DoesNotTakeAVectorForAListOfChoices) {
  const Json study = changed("/problems/0/parameters",
                             R"({"inertia": [1, 2, 3], "gravity": [0, 1, 2], "angular_velocity": [3, 4, 5],
                                 "center_of_mass": [6, 7, 8], "orientation": [1, 0, 0, 1]})");
  const RunSpec run = only_run(study);
  EXPECT_EQ(run.parameters["angular_velocity"], Json({3.0, 4.0, 5.0}));
  EXPECT_EQ(run.parameters["inertia"], Json({{1.0, 0.0, 0.0}, {0.0, 2.0, 0.0}, {0.0, 0.0, 3.0}}));
}

TEST(StudyExpansion, LeavesNoParameterAndNoOptionToADefaultUnsaid) {
  const RunSpec run = only_run(base());
  for (const ParameterInfo& info : run.problem->parameters)
    EXPECT_TRUE(run.parameters.contains(info.name)) << info.name;
  for (const OptionInfo& info : run.method->options)
    EXPECT_TRUE(run.request.options.all().contains(info.name)) << info.name;
  EXPECT_EQ(run.precision, Precision::double_precision);
  EXPECT_EQ(run.request.start, Start::reference);
  EXPECT_EQ(run.t_0, 0.0);
}

TEST(StudyExpansion, SaysTheSameRunOnceOnly) {
  Json study = base();
  study["problems"] = parse_json(R"([{"name": "heavy_top"}, {"name": "heavy_top", "formulation": "SO3",
                                      "parameters": {"mass": [15, 15.0]}}])",
                                 "test");
  study["integrators"][0]["k"] = parse_json("[2, 2, 2.0]", "test");
  study["precision"] = {"double", "double"};
  study["step_sizes"] = {0.01, 1e-2, 0.0100000000000000001};
  EXPECT_EQ(runs(study).size(), 1u);
  // Different wishes, one grid: both divide [0, 0.1] into 4 steps.
  EXPECT_EQ(runs(changed("/step_sizes", "[0.03, 0.026]")).size(), 1u);
}

TEST(StudyExpansion, ARangeOfStepSizesIsLogarithmicAndKeepsBothEnds) {
  Json study = changed("/step_sizes", R"({"from": 1e-2, "to": 1e-5, "per_decade": 4})");
  study["t_end"] = 2.0;
  const auto list = runs(study);
  ASSERT_EQ(list.size(), 13u);
  for (std::size_t i = 0; i < list.size(); ++i)
    EXPECT_NEAR(list[i].requested_step_size / std::pow(10.0, -2.0 - double(i) / 4.0), 1.0, 1e-14);
  EXPECT_EQ(list.front().requested_step_size, 1e-2);
  // No end inside a step: 1e-2, 1e-3 and no further.
  EXPECT_EQ(runs(changed("/step_sizes", R"({"from": 1e-2, "to": 3e-4, "per_decade": 1})")).size(), 2u);
  EXPECT_EQ(runs(changed("/step_sizes", R"({"from": 1e-2, "to": 1e-2, "per_decade": 7})")).size(), 1u);
}

TEST(StudyGrid, AStepSizeThatDividesTheIntervalIsKept) {
  // 0.3 / 0.1 is 2.9999999999999996 in double, 0.7 / 0.1 is 6.999999999999999, 1.1 / 0.1
  // is 11.000000000000002.
  const std::vector<std::array<double, 3>> cases{{0.3, 0.1, 3},     {0.7, 0.1, 7},    {1.1, 0.1, 11},
                                                 {2.0, 1e-3, 2000}, {2.0, 1e-6, 2e6}, {0.3, 1e-7, 3e6}};
  for (const auto& [t_end, h, steps] : cases) {
    Json study = base();
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
        Json study = base();
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
  Json study = base();
  study["t_end"] = 0.3;  // no double
  study["step_sizes"] = {0.1};
  study["precision"] = "extended";
  const RunSpec run = only_run(study);
  const Extended three_tenths = Extended(3.0) / Extended(10.0);
  EXPECT_LE(std::abs(to_double(Extended(run.request.step_size * 3.0) - three_tenths)), 1e-31);
}

TEST(StudyGrid, LocalRunsTakeTheirStepsAfterTheStartingValues) {
  for (int k = 1; k <= 4; ++k) {
    Json study = changed("/t_end", "");
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
  Json study = base();
  study["step_sizes"] = {0.04};  // 3 steps of 0.1 / 3, and k = 3
  EXPECT_EQ(only_run(study).request.steps, 3u);
}

// Keys.

TEST(RunKey, IsThirtyTwoHexadecimalDigits) {
  const std::string key = only_run(base()).key();
  EXPECT_EQ(key.size(), 32u);
  EXPECT_EQ(key.find_first_not_of("0123456789abcdef"), std::string::npos) << key;
}

TEST(RunKey, IsTheSameForTheSameInputHoweverItIsWritten) {
  const std::string key = only_run(base()).key();
  EXPECT_EQ(only_run(base()).key(), key);
  EXPECT_EQ(only_run(changed("/name", "\"another name\"")).key(), key);
  EXPECT_EQ(only_run(changed("/integrators/0/k", "3.0")).key(), key);
  EXPECT_EQ(only_run(changed("/integrators/0/k", "[3]")).key(), key);
  EXPECT_EQ(only_run(changed("/integrators/0/correction", "true")).key(), key);
  EXPECT_EQ(only_run(changed("/step_sizes/0", "0.01000")).key(), key);
  EXPECT_EQ(only_run(changed("/precision", "\"double\"")).key(), key);
  EXPECT_EQ(only_run(changed("/t_0", "0")).key(), key);
  EXPECT_EQ(only_run(changed("/problems/0/parameters", "{\"mass\": 15}")).key(), key);
  EXPECT_EQ(only_run(changed("/problems/0/parameters", R"({"gravity": [0, 0, -9.81], "mass": 15.0})")).key(),
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
  std::set<std::string> keys{only_run(base()).key()};
  for (const auto& [pointer, value] : changes)
    EXPECT_TRUE(keys.insert(only_run(changed(pointer, value)).key()).second) << pointer << " = " << value;
  // The same grid as the base study, asked for as a number of steps.
  Json local = changed("/t_end", "");
  local["steps"] = 8;
  EXPECT_EQ(only_run(local).request.steps, only_run(base()).request.steps);
  EXPECT_TRUE(keys.insert(only_run(local).key()).second);
  local["step_sizes"] = {0.011};
  EXPECT_TRUE(keys.insert(only_run(local).key()).second);
  local["steps"] = 9;
  EXPECT_TRUE(keys.insert(only_run(local).key()).second);
}

}  // namespace
}  // namespace liebench
