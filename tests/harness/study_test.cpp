#include "harness/study.h"

#include <gtest/gtest.h>

#include <string>

#include "harness/errors.h"
#include "tests/harness/sample_studies.h"

namespace liebench {
namespace {

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
    const Study study = read_study(changed_study(bad.pointer, bad.value));
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
    testing::Values(
        BadStudy{"misspelt_method",
                 "/integrators/0/name",
                 "\"bliedf2\"",
                 "/integrators/0/name",
                 {"unknown integrator \"bliedf2\"",
                  "allowed: \"bliedf2nd\", \"bliedf2nd_variable\", \"generalized_alpha\", \"faltinsen_bdf\"",
                  "did you mean \"bliedf2nd\"?"}},
        BadStudy{"tolerance_of_fixed_steps",
                 "/integrators/0/tolerance",
                 "1e-6",
                 "/integrators/0/tolerance",
                 {"bliedf2nd takes the steps of \"step_sizes\"", "\"rkmk_variable\""}},
        BadStudy{"form_of_an_explicit_method",
                 "/integrators/0",
                 "{\"name\": \"commutator_free\", \"form\": \"index3\"}",
                 "/integrators/0/form",
                 {"commutator_free has no option \"form\" and integrates problems without constraints",
                  "methods that have it: \"bliedf2nd\""}},
        BadStudy{"step_sizes_of_methods_that_choose_theirs",
                 "/integrators/0",
                 "{\"name\": \"bliedf2nd_variable\"}",
                 "/step_sizes",
                 {"all methods of this study choose their steps"}},
        BadStudy{"explicit_method_with_constraints",
                 "/integrators/0",
                 "{\"name\": \"rkmk\"}",
                 "/integrators/0/name",
                 {"heavy_top in R3xSO3: rkmk integrates problems without constraints",
                  "this one has constraints", "\"half_explicit\""}},
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
                 {"unknown formulation \"SO_3\"", "\"SO3\", \"S3\", \"R3xSO3\"", "did you mean \"SO3\"?"}},
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
                 {"faltinsen_bdf has no option \"correction\"", "methods that have it: \"bliedf2nd\""}},
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
  Json study = changed_study("/integrators/0/form", "\"stabilized_index2\"");
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
  Json study = changed_study("/integrators/0/form", R"(["index3", "stabilized_index2"])");
  study["problems"][0]["formulation"] = {"SO3", "R3xSO3"};
  std::vector<std::string> seen;
  for (const RunSpec& run : runs_of(study))
    seen.push_back(options_to_json(*run.method, run.request.options).dump());
  EXPECT_EQ(seen, (std::vector<std::string>{
                      R"({"k":3,"correction":true})",  // once, for the two forms that it has not
                      R"({"k":3,"correction":true,"modified_start":false,"form":"index3"})",
                      R"({"k":3,"correction":true,"form":"stabilized_index2"})"}));
}

TEST(Study, StartsByItselfUnlessToldOtherwise) {
  const RunSpec own = only_run(changed_study("/start", ""));
  EXPECT_EQ(own.request.start, Start::self);
  // The transient phase of the index-3 form then keeps its order.
  EXPECT_TRUE(own.request.options.boolean("modified_start"));
  EXPECT_FALSE(only_run(base_study()).request.options.boolean("modified_start"));
  Json study = changed_study("/start", "\"self\"");
  study["integrators"][0]["modified_start"] = false;
  EXPECT_FALSE(only_run(study).request.options.boolean("modified_start"));
  EXPECT_NE(own.key(), only_run(base_study()).key());
}

TEST(Study, WhatIsNotAnObjectIsRefused) {
  for (const char* text : {"[]", "null", "\"study\"", "3", "{}"})
    EXPECT_THROW(read_study(parse_json(text, "test")), InputError) << text;
}

TEST(Study, LocalRunsOfASizeThatNoReferenceCanCoverAreRefused) {
  // An interval has at most 1e9 steps; a fixed number of steps of 1e300 s would have no end either.
  Json study = changed_study("/t_end", "");
  study["steps"] = 1;
  study["step_sizes"] = {1e300};
  EXPECT_THROW(read_study(study), InputError);
}

TEST(Study, LocalRunsOfABadNumberOfStepsAreRefused) {
  for (const char* steps : {"0", "-1", "1.5", "1000001", "\"1\"", "null", "[1]"}) {
    Json study = changed_study("/t_end", "");
    study["steps"] = parse_json(steps, "steps");
    try {
      read_study(study);
      ADD_FAILURE() << "accepted: " << steps;
    } catch (const InputError& error) {
      EXPECT_EQ(error.place(), "/steps") << steps;
    }
  }
}

}  // namespace
}  // namespace liebench
