#include "harness/outside/outside_methods.h"

#include <gtest/gtest.h>

#include <fstream>
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

std::vector<std::string_view> methods_of_scenes() {
  std::vector<std::string_view> names;
  for (const OutsideMethod& method : outside_methods())
    if (method.scenes) names.push_back(method.name);
  return names;
}

// The same on a scene, whose reference all methods share.
Json scene_study(const std::vector<std::string_view>& names, const std::string& scene,
                 const std::string& tolerances, double t_end = 0.2) {
  Json study = outside_study(names.front(), tolerances);
  study["problems"][0] = {{"scene", scene}};
  study["t_end"] = t_end;
  for (std::size_t i = 1; i < names.size(); ++i) {
    study["integrators"][i] = study["integrators"][0];
    study["integrators"][i]["name"] = names[i];
  }
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
  // The file with this scene.
  std::string scene_file(const std::string& name, const std::string& text) const {
    const std::string file = folder_.path() / (name + ".json");
    std::ofstream(file) << text;
    return file;
  }

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

// Of several bodies on several groups, with forces of the time.
constexpr const char* bodies_of_three_groups = R"json({
  "name": "bodies",
  "bodies": [
    {"name": "a", "formulation": "SE3", "mass": 2, "inertia": [1, 1.5, 2], "position": [1, 0, 0], "velocity": [0, 1, 0],
     "angular_velocity": [1, 2, -3]},
    {"name": "b", "formulation": "UDQ", "mass": 3, "inertia": [1, 2, 2.5], "position": [2, 0, 0],
     "angular_velocity": [-4, 1, 2]},
    {"name": "c", "formulation": "R3", "mass": 1, "position": [3, 0, 0]}],
  "effects": [
    {"type": "uniform_gravity", "acceleration": [0, 0, -9.81]},
    {"type": "applied_force", "body": "a", "force": [3, 0, 0], "point": [0, 0.5, 0],
     "factor": {"expression": "sin(20*t)"}},
    {"type": "spring_damper", "bodies": ["ground", "a"], "points": [[0, 0, 0], [0, 0.2, 0]], "stiffness": 200},
    {"type": "spring_damper", "bodies": ["a", "b"], "points": [[0.2, 0, 0], [0, 0, 0.3]], "stiffness": 100,
     "damping": 2},
    {"type": "spring_damper", "bodies": ["b", "c"], "points": [[0.2, 0, 0], [0, 0, 0]], "stiffness": 50}]
})json";

TEST_F(OutsideRunsTest, OnScenesWithoutJointsTheErrorFallsWithTheTolerance) {
  for (const std::string& scene :
       {std::string("builtin:top_on_soft_mount"), std::string("builtin:bushing_body"),
        scene_file("bodies", bodies_of_three_groups)}) {
    std::map<std::string, double> before;
    for (const Json& record : records(scene_study(methods_of_scenes(), scene, "[1e-4, 1e-6, 1e-8]"))) {
      const std::string run = scene + record.at("integrator").dump() + record.at("options").dump();
      ASSERT_EQ(record.at("outcome"), "ok") << run;
      EXPECT_EQ(schema_.violations(record.dump()), "") << record.dump();
      EXPECT_FALSE(record.at("errors").contains("lambda"));
      // What is read is normalised.
      EXPECT_LT(record.at("drift").at("group"), 1e-14) << run;
      if (record.at("options").at("tolerance") == 1e-4) before.clear();
      for (const auto& [component, norms] : record.at("errors").items()) {
        const double error = norms.at("max_absolute");
        if (before.contains(component)) {
          EXPECT_LT(error, before.at(component) / 4.0) << component << run;
        }
        before[component] = error;
      }
      // The tolerance bounds the error of a step; those of hundreds of steps come together.
      EXPECT_LT(before.at("q"), 200.0 * record.at("options").at("tolerance").get<double>()) << run;
    }
  }
}

// Its fastest motion dies with 100 microseconds, and explicit methods follow it: the longest stable step is some of these. The
// others take steps of ten.
TEST_F(OutsideRunsTest, AStiffMountBoundsTheStepsOfExplicitMethodsAlone) {
  const double t_end = 0.05, damping_time = 1e-4;
  for (const Json& record :
       records(scene_study(methods_of_scenes(), "builtin:top_on_stiff_mount", "[1e-4, 1e-6, 1e-8]", t_end))) {
    const std::string run = record.at("integrator").dump() + record.at("options").dump();
    ASSERT_EQ(record.at("outcome"), "ok") << run;
    const double tolerance = record.at("options").at("tolerance");
    EXPECT_LT(record.at("errors").at("q").at("max_absolute"), 10.0 * tolerance) << run;
    const bool implicit = record.at("cost").contains("jacobians");
    const double step = t_end / double(record.at("steps"));
    if (!implicit) {
      EXPECT_LT(step, 6.0 * damping_time) << run;
    } else if (tolerance == 1e-4) {
      EXPECT_GT(step, 10.0 * damping_time) << run;
    }
  }
}

// The same steps, and errors that differ by round-off: a thousand times that of 1 and of 150 rad/s.
TEST_F(OutsideRunsTest, TheTopAsASceneIsTheHeavyTop) {
  const std::map<std::string, double> round_off{{"q", 1000.0 * 1.0 * 0x1p-52},
                                                {"v", 1000.0 * 150.0 * 0x1p-52}};
  for (const char* group : {"SO3", "S3"}) {
    const std::string scene = scene_file(group, std::string(R"({"name": "top", "bodies": [
      {"name": "top", "formulation": ")") + group + R"(", "fixed_point": [0, 0, 0], "mass": 15,
       "inertia": [0.234375, 0.46875, 0.234375], "position": [0, 1, 0], "angular_velocity": [0, 150, -4.61538]}],
      "effects": [{"type": "uniform_gravity", "acceleration": [0, 0, -9.81]}]})");
    const auto on_scene = records(scene_study(methods_of_scenes(), scene, "[1e-4, 1e-6]"));
    Json study = scene_study(methods_of_scenes(), scene, "[1e-4, 1e-6]");
    study["problems"][0] = {{"name", "heavy_top"}, {"formulation", "S3"}};
    const auto on_top = records(study);
    ASSERT_EQ(on_scene.size(), on_top.size());
    for (std::size_t i = 0; i < on_top.size(); ++i) {
      const std::string run = group + on_top[i].at("integrator").dump() + on_top[i].at("options").dump();
      EXPECT_EQ(on_scene[i].at("cost"), on_top[i].at("cost")) << run;
      EXPECT_EQ(on_scene[i].at("steps"), on_top[i].at("steps")) << run;
      for (const auto& [component, error] : round_off)
        EXPECT_NEAR(on_scene[i].at("errors").at(component).at("max_absolute"),
                    on_top[i].at("errors").at(component).at("max_absolute"), error)
            << component << run;
    }
  }
}

TEST_F(OutsideRunsTest, OnScenesTheSameRunHasTheSameRecordTwiceAndIsTimed) {
  const auto runs = read_study(scene_study(methods_of_scenes(), "builtin:bushing_body", "1e-5")).runs;
  std::vector<Json> first = records(runs), second = records(runs);
  Progress progress("", 1.0);
  time_runs(runs, {.least_time = 1e-4, .repetitions = 2, .most_rounds = 1}, cache_, progress,
            [&](std::size_t i, const RunTimes& times) {
              EXPECT_EQ(times.steps, first[i].at("steps")) << first[i].at("integrator");
              EXPECT_GT(times.start, 0.0);
              EXPECT_EQ(schema_.violations(with_time(first[i], times).dump()), "");
            });
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (Json* record : {&first[i], &second[i]}) record->erase("provenance");
    EXPECT_EQ(first[i].dump(), second[i].dump());
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
    const OutsideMethod* outside = find_outside_method(method);
    const std::string fitting = "the heavy top in the formulation \"" + std::string(outside->formulation) +
                                (outside->scenes ? "\" and scenes without joints; this one is another"
                                                 : "\" alone; this one is another");
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

TEST(OutsideMethods, AreRefusedOnScenesWithJoints) {
  for (const OutsideMethod& method : outside_methods()) {
    const InputError error = refusal_of(scene_study({method.name}, "builtin:heavy_top", "1e-4"));
    EXPECT_EQ(error.place(), "/integrators/0/name");
    const std::string reason = method.scenes ? "and scenes without joints; this one has joints"
                                             : "\"R3xS3\" alone; this one is another";
    EXPECT_NE(error.message().find(reason), std::string::npos) << error.message();
    // What fits are methods with constraints, none from outside among them.
    const auto list = error.message().find("What fits it: \"bliedf2nd\"");
    ASSERT_NE(list, std::string::npos) << error.message();
    for (const OutsideMethod& other : outside_methods())
      EXPECT_EQ(error.message().find('"' + std::string(other.name) + '"', list), std::string::npos)
          << error.message();
  }
}

TEST(OutsideMethods, IdaIsRefusedOnScenesWithoutJointsWithWhatFitsThem) {
  const InputError error = refusal_of(scene_study({"ida"}, "builtin:bushing_body", "1e-4"));
  EXPECT_NE(error.message().find("\"R3xS3\" alone; this one is another"), std::string::npos)
      << error.message();
  for (const std::string_view method : methods_of_scenes())
    EXPECT_NE(error.message().find('"' + std::string(method) + '"'), std::string::npos) << error.message();
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
    EXPECT_EQ(each.runs.run_scene != nullptr, outside_obstacle().empty() && each.scenes);
    EXPECT_EQ(each.runs.timed_scene != nullptr, outside_obstacle().empty() && each.scenes);
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
