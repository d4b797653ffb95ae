#include "harness/stability/suite.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "groups/flattened.h"
#include "harness/embedded.h"
#include "harness/errors.h"
#include "harness/execute.h"
#include "harness/progress.h"
#include "harness/stability/report.h"
#include "tests/harness/json_schema.h"

namespace liebench {
namespace {

std::vector<Json> records_of(const std::vector<SuiteTrial>& trials, int jobs) {
  std::vector<Json> records(trials.size());
  Progress progress("stability", 1.0);
  run_suite(trials, jobs, progress, [&](std::size_t index, const Json& record) { records[index] = record; });
  return records;
}

std::string text_of(std::vector<Json> records) {
  std::string text;
  for (Json& record : records) {
    record.erase("provenance");
    text += record.dump() + "\n";
  }
  return text;
}

// The fast half: a method that does worse than theory says, or better, is a defect of one of them.
TEST(StabilitySuite, NoMethodSurprises) {
  // Under sanitizers, where a step takes twenty times as long, the cases of few steps.
  const auto trials = detail::sanitized
                          ? suite({"extreme_arguments", "correction_term", "degenerate_runs"}, true)
                          : suite({}, true);
  ASSERT_GT(trials.size(), detail::sanitized ? 500u : 4000u);
  int shown = 0;
  for (const Json& record : records_of(trials, default_jobs())) {
    const std::string verdict = record.at("verdict");
    if (plain(record) || (verdict != "failed_unexpectedly" && verdict != "passed_unexpectedly")) continue;
    ADD_FAILURE() << record.at("case") << ' ' << record.at("variant") << ' ' << record.at("subject") << ' '
                  << record.value("form", "") << ": " << record.at("outcome") << ", " << record.at("grade")
                  << " where " << record.at("reason") << " lets expect " << record.at("expected");
    if (++shown == 20) break;
  }
}

TEST(StabilitySuite, TheRecordsDoNotDependOnTheNumberOfJobs) {
  const auto trials = detail::sanitized ? suite({"correction_term"}, true)
                                        : suite({"degenerate_runs", "large_rotations"}, true);
  EXPECT_EQ(text_of(records_of(trials, 1)), text_of(records_of(trials, 3)));
}

TEST(StabilitySuite, TheRecordsFulfilTheirSchema) {
  const JsonSchema schema(embedded_file("stability.schema.json"));
  for (const Json& record : records_of(
           detail::sanitized ? suite({"extreme_arguments"}, true)
                             : suite({"degenerate_runs", "extreme_arguments", "correction_term"}, true),
           2))
    ASSERT_EQ(schema.violations(record.dump()), "") << record.dump();
}

TEST(StabilitySuite, EveryTrialHasAKeyOfItsOwn) {
  std::set<std::string> keys;
  const auto trials = suite({}, false);
  for (const SuiteTrial& trial : trials) keys.insert(trial.key());
  EXPECT_EQ(keys.size(), trials.size());
}

TEST(StabilitySuite, AnUnknownCaseIsRefusedWithTheNearestName) {
  try {
    suite({"stifness"}, true);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"stiffness\"?"), std::string::npos)
        << error.what();
  }
}

// A method is in the suite with every choice of options that sets its members apart, or the suite would say nothing of
// it. Solvers from outside run in studies alone, and are none of it.
TEST(StabilitySuite, EveryMethodOfTheListIsAContestant) {
  std::set<std::string_view> names;
  for (const Contestant& contestant : contestants(true)) names.insert(contestant.method->name);
  for (const MethodInfo& method : methods())
    EXPECT_EQ(names.contains(method.name), method.outside == nullptr) << method.name;
}

// docs/stability.md, "Methods that choose their steps": where they are tried, at either tolerance.
TEST(StabilitySuite, MethodsThatChooseTheirStepsAreTriedWhereverACaseIsNotAboutFixedOnes) {
  std::map<std::string, std::set<std::string>> cases;
  for (const SuiteTrial& trial : suite({}, true))
    cases[trial.trial.subject].insert(std::string(trial.owner->name));
  const std::set<std::string> unconstrained{"long_runs",    "large_rotations", "stiffness",
                                            "rough_forces", "unstable_motion", "degenerate_runs"};
  std::set<std::string> all = unconstrained;
  all.insert({"correction_term", "singular", "masses", "bad_beginnings"});
  int rows = 0;
  for (const Contestant& contestant : contestants(true)) {
    if (!contestant.chooses_steps()) continue;
    ++rows;
    // Tolerances from 1e-10 on are tried in the row of the smaller one.
    EXPECT_EQ(cases[contestant.name].erase("small_steps"), *contestant.tolerance() < 1e-6 ? 1u : 0u);
    EXPECT_EQ(cases[contestant.name], contestant.is("rkmk_variable") ? unconstrained : all)
        << contestant.name;
  }
  EXPECT_EQ(rows, 4);
}

TEST(StabilitySuite, EveryCaseHasItsSectionInTheDocumentation) {
  std::ifstream file(std::string(LIEBENCH_SOURCE_DIR) + "/docs/stability.md");
  std::stringstream text;
  text << file.rdbuf();
  for (const StabilityCase& entry : stability_cases()) {
    // "Singular, redundant" is "Singular and redundant" there.
    const std::string title(entry.title.substr(0, entry.title.find_first_of(", ")));
    EXPECT_NE(text.str().find("\n## " + title), std::string::npos) << entry.title;
  }
}

}  // namespace
}  // namespace liebench
