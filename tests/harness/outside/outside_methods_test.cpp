#include "harness/outside/outside_methods.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "harness/embedded.h"
#include "harness/errors.h"
#include "harness/execute.h"
#include "harness/progress.h"
#include "harness/provenance.h"
#include "harness/record.h"
#include "harness/timing.h"
#include "tests/harness/json_schema.h"
#include "tests/support/run_program.h"

namespace liebench {
namespace {

// A study of one solver from outside in its own formulation.
Json outside_study(std::string_view method, const std::string& tolerances) {
  const OutsideMethod* outside = find_outside_method(method);
  Json study =
      parse_json(R"({"name": "outside", "problems": [{"name": "heavy_top"}], "t_end": 0.2})", "test");
  study["problems"][0]["formulation"] = outside->formulation;
  study["integrators"] = Json::array({{{"name", method}, {"tolerance", parse_json(tolerances, "test")}}});
  return study;
}

// Runs of the solvers from outside, where there are any.
class OutsideRunsTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!outside_obstacle().empty()) GTEST_SKIP() << outside_obstacle();
  }
  std::vector<Json> records(const std::vector<RunSpec>& runs) const {
    std::vector<Json> list(runs.size());
    Progress progress("test", 1.0);
    execute(runs, 1, cache_, progress, [&](std::size_t index, const Json& record) { list[index] = record; });
    return list;
  }
  std::vector<Json> records(const Json& study) const { return records(read_study(study).runs); }

  const JsonSchema schema_{embedded_file("record.schema.json")};
  const TemporaryFolder folder_;
  const ReferenceCache cache_{folder_.path()};
};

TEST_F(OutsideRunsTest, TheErrorFallsWithTheTolerance) {
  for (const OutsideMethod& method : outside_methods()) {
    std::map<std::string, double> before;
    for (const Json& record : records(outside_study(method.name, "[1e-4, 1e-6, 1e-8]"))) {
      ASSERT_EQ(record.at("outcome"), "ok") << method.name << record.at("options");
      EXPECT_EQ(record.at("errors").contains("lambda"), method.fits == Fits::with_constraints);
      for (const auto& [component, norms] : record.at("errors").items()) {
        const double error = norms.at("max_absolute");
        if (before.contains(component)) {
          EXPECT_LT(error, before.at(component) / 4.0)
              << method.name << ' ' << component << record.at("options");
        }
        before[component] = error;
      }
    }
    // The smallest tolerance bounds the error of a step; those of the thousands of steps of a fifth of a second come
    // together.
    EXPECT_LT(before.at("q"), 1e-4) << method.name;
  }
}

TEST_F(OutsideRunsTest, TheRecordsHoldWhatTheSolverCountsAndNothingElse) {
  const std::set<std::string> all{"residuals", "rejected_steps"};
  const std::set<std::string> of_newton{"residuals",         "jacobians", "factorizations",
                                        "newton_iterations", "solves",    "rejected_steps"};
  const std::map<std::string_view, std::set<std::string>> expected{{"cvode_bdf", of_newton},
                                                                   {"cvode_adams", all},
                                                                   {"arkode_erk", all},
                                                                   {"arkode_dirk", of_newton},
                                                                   {"ida", of_newton}};
  for (const OutsideMethod& method : outside_methods()) {
    const Json record = records(outside_study(method.name, "1e-5")).front();
    EXPECT_EQ(schema_.violations(record.dump()), "") << record.dump();
    std::set<std::string> counted;
    for (const auto& [key, count] : record.at("cost").items()) counted.insert(key);
    EXPECT_EQ(counted, expected.at(method.name)) << method.name;
    EXPECT_GE(record.at("cost").at("residuals"), record.at("steps")) << method.name;
    if (record.at("cost").contains("jacobians")) {
      EXPECT_GE(record.at("cost").at("jacobians"), 1);
      EXPECT_GE(record.at("cost").at("factorizations"), record.at("cost").at("jacobians")) << method.name;
    }
    EXPECT_EQ(record.at("provenance").at("libraries").at("sundials"), sundials_version());
    EXPECT_FALSE(record.contains("requested_step_size"));
  }
}

TEST_F(OutsideRunsTest, TheSchemaAsksForTheirCountsAndForbidsOthers) {
  const Json record = records(outside_study("cvode_bdf", "1e-3")).front();
  for (const auto& [key, count] : record.at("cost").items()) {
    Json less = record;
    less["cost"].erase(key);
    EXPECT_NE(schema_.violations(less.dump()), "") << "without " << key;
  }
  for (const char* key : {"exp", "commutators", "flops", "surplus"}) {
    Json more = record;
    more["cost"][key] = 0;
    EXPECT_NE(schema_.violations(more.dump()), "") << "with " << key;
  }
}

TEST_F(OutsideRunsTest, TheSameRunHasTheSameRecordTwice) {
  for (const OutsideMethod& method : outside_methods()) {
    const Json study = outside_study(method.name, "[1e-4, 1e-7]");
    std::vector<Json> first = records(study), second = records(study);
    for (std::size_t i = 0; i < first.size(); ++i) {
      first[i].erase("provenance");
      second[i].erase("provenance");
      EXPECT_EQ(first[i].dump(), second[i].dump()) << method.name;
    }
  }
}

TEST_F(OutsideRunsTest, TimedRunsTakeTheStepsOfTheirRecords) {
  for (const OutsideMethod& method : outside_methods()) {
    const auto runs = read_study(outside_study(method.name, "1e-5")).runs;
    const Json record = records(runs).front();
    Progress progress("", 1.0);
    time_runs(runs, {.least_time = 1e-4, .repetitions = 2, .most_rounds = 1}, cache_, progress,
              [&](std::size_t, const RunTimes& times) {
                EXPECT_EQ(times.steps, record.at("steps")) << method.name;
                EXPECT_GT(times.start, 0.0);
                EXPECT_EQ(schema_.violations(with_time(record, times).dump()), "");
              });
  }
}

TEST_F(OutsideRunsTest, AToleranceBelowRoundOffIsAFailureInTheWordsOfTheSolver) {
  for (const OutsideMethod& method : outside_methods()) {
    const Json record = records(outside_study(method.name, "1e-30")).front();
    EXPECT_NE(record.at("outcome"), "ok") << method.name;
    EXPECT_FALSE(record.at("failure").at("message").get<std::string>().empty());
    EXPECT_FALSE(record.at("failure").contains("residual"));
    EXPECT_EQ(schema_.violations(record.dump()), "") << record.dump();
  }
}

TEST_F(OutsideRunsTest, EveryOrderOfArkodeHasATable) {
  for (const auto& [name, orders] : std::map<std::string, std::vector<int>>{
           {"arkode_erk", {2, 3, 4, 5, 6, 7, 8}}, {"arkode_dirk", {2, 3, 4, 5}}}) {
    Json study = outside_study(name, "1e-5");
    study["integrators"][0]["order"] = orders;
    const auto all = records(study);
    ASSERT_EQ(all.size(), orders.size());
    for (const Json& record : all) EXPECT_EQ(record.at("outcome"), "ok") << name << record.at("options");
  }
}

// What `study` is refused with; a failure where it is not.
InputError refusal_of(const Json& study) {
  try {
    read_study(study);
  } catch (const InputError& error) {
    return error;
  }
  ADD_FAILURE() << "accepted: " << study;
  return {"", ""};
}

TEST(OutsideMethods, AnotherFormulationIsRefusedWithWhatFitsIt) {
  for (const auto& [method, formulation] : std::vector<std::pair<const char*, const char*>>{
           {"cvode_bdf", "SO3"}, {"cvode_adams", "R3xS3"}, {"ida", "S3"}, {"ida", "R3xSO3"}}) {
    Json study = outside_study(method, "1e-4");
    study["problems"][0]["formulation"] = formulation;
    const InputError error = refusal_of(study);
    EXPECT_EQ(error.place(), "/integrators/0/name");
    const std::string fitting = std::string("the heavy top in the formulation \"") +
                                std::string(find_outside_method(method)->formulation) + "\" alone";
    EXPECT_NE(error.message().find(fitting), std::string::npos) << error.message();
    EXPECT_NE(error.message().find("What fits it: \"bliedf2nd\""), std::string::npos) << error.message();
  }
}

TEST(OutsideMethods, AreNotOfferedForWhatTheyDoNotIntegrate) {
  Json study = outside_study("ida", "1e-4");
  study["integrators"][0] = {{"name", "rkmk"}};
  study["step_sizes"] = {1e-3};
  EXPECT_NE(refusal_of(study).message().find("\"ida\""), std::string::npos) << "R3xS3 is its own";
  study["problems"][0]["formulation"] = "R3xSO3";
  EXPECT_EQ(refusal_of(study).message().find("\"ida\""), std::string::npos);
}

TEST(OutsideMethods, AreRefusedOnScenes) {
  const std::string folder = std::string(LIEBENCH_SOURCE_DIR) + "/problems/scenes/";
  Json study = outside_study("ida", "1e-4");
  study["problems"][0] = {{"scene", folder + "heavy_top.json"}};
  const InputError error = refusal_of(study);
  EXPECT_EQ(error.place(), "/integrators/0/name");
  EXPECT_NE(error.message().find("in the formulation \"R3xS3\" alone"), std::string::npos) << error.message();
}

// A program without SUNDIALS refuses the method before it looks at the precision.
TEST(OutsideMethods, ExtendedPrecisionIsRefused) {
  Json study = outside_study("arkode_erk", "1e-4");
  study["precision"] = {"double", "extended"};
  const InputError error = refusal_of(study);
  if (!outside_obstacle().empty()) GTEST_SKIP() << error.what();
  EXPECT_EQ(error.place(), "/precision/1");
  EXPECT_NE(error.message().find("arkode_erk runs in \"double\" alone"), std::string::npos)
      << error.message();
}

TEST(OutsideMethods, AnOrderWithoutATableIsRefused) {
  Json study = outside_study("arkode_dirk", "1e-4");
  study["integrators"][0]["order"] = 6;
  EXPECT_EQ(refusal_of(study).place(), "/integrators/0/order");
}

TEST(OutsideMethods, AreListedWhetherTheyCanRunOrNot) {
  EXPECT_EQ(outside_methods().size(), 5u);
  for (const OutsideMethod& each : outside_methods()) {
    const MethodInfo* method = find_method(each.name);
    ASSERT_NE(method, nullptr) << each.name;
    EXPECT_EQ(method->outside, &each);
    EXPECT_TRUE(method->chooses_steps);
    EXPECT_TRUE(has_option(*method, "tolerance"));
    EXPECT_EQ(each.runs.run != nullptr, outside_obstacle().empty());
    EXPECT_EQ(each.runs.timed != nullptr, outside_obstacle().empty());
  }
  for (const MethodInfo& method : methods())
    EXPECT_EQ(method.outside != nullptr, find_outside_method(method.name) != nullptr) << method.name;
}

TEST(OutsideMethods, WithoutSundialsAStudySaysHowToGetIt) {
  if (outside_obstacle().empty()) GTEST_SKIP() << "this program has SUNDIALS " << sundials_version();
  const InputError error = refusal_of(outside_study("cvode_bdf", "1e-4"));
  EXPECT_EQ(error.place(), "/integrators/0/name");
  EXPECT_NE(error.message().find("install libsundials-dev and build again"), std::string::npos);
  EXPECT_FALSE(provenance().at("libraries").contains("sundials"));
}

}  // namespace
}  // namespace liebench
