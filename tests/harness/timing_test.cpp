#include "harness/timing.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <map>
#include <stdexcept>

#include "harness/execute.h"
#include "harness/progress.h"
#include "harness/record.h"
#include "tests/harness/sample_records.h"
#include "tests/support/run_program.h"

namespace liebench {
namespace {

TEST(SpreadOf, IsTheInterquartileRangeOverTheMedian) {
  EXPECT_EQ(spread_of({7.0}), 0.0);
  EXPECT_EQ(spread_of({2.0, 2.0, 2.0}), 0.0);
  EXPECT_DOUBLE_EQ(spread_of({5.0, 1.0, 4.0, 2.0, 3.0}), 2.0 / 3.0);
  // One that stands apart does not matter, half of them do.
  EXPECT_EQ(spread_of({1.0, 1.0, 1.0, 1.0, 50.0}), 0.0);
  EXPECT_GT(spread_of({1.0, 1.0, 50.0, 50.0}), 0.5);
}

class TimeRunsTest : public testing::Test {
 protected:
  static std::vector<RunSpec> runs(const char* precision = "double") {
    Json study = Json::parse(
        R"({"name": "times", "problems": [{"name": "heavy_top", "formulation": ["SO3", "R3xSO3"]}],
            "integrators": [{"name": "bliedf2nd", "k": 3}, {"name": "generalized_alpha"}], "step_sizes": [1e-3, 2e-3],
            "t_end": 0.1})");
    study["precision"] = precision;
    return read_study(study).runs;
  }

  std::map<std::size_t, RunTimes> times(const std::vector<RunSpec>& specs, const TimingRules& rules) const {
    std::map<std::size_t, RunTimes> all;
    Progress progress("", 1.0);
    time_runs(specs, rules, ReferenceCache(cache_.path()), progress,
              [&](std::size_t i, const RunTimes& each) { EXPECT_TRUE(all.emplace(i, each).second); });
    return all;
  }

 private:
  TemporaryFolder cache_;
};

TEST_F(TimeRunsTest, EveryRunGetsItsRepetitions) {
  const auto specs = runs();
  const auto all = times(specs, {.least_time = 1e-4, .repetitions = 3, .most_rounds = 1, .spread = 0.0});
  ASSERT_EQ(all.size(), 8u);
  for (const auto& [i, each] : all) {
    EXPECT_EQ(each.per_step.size(), 3u);
    for (const double ns : each.per_step) EXPECT_GT(ns, 0.0);
    EXPECT_GT(each.start, 0.0);
    const bool multistep = specs[i].method->name == "bliedf2nd";
    EXPECT_EQ(each.steps, specs[i].request.steps + 1 - (multistep ? 3 : 1));
  }
}

TEST_F(TimeRunsTest, AnUnsteadyRunIsTimedAgainAndThenSaysSo) {
  for (const auto& entry :
       times(runs(), {.least_time = 1e-4, .repetitions = 3, .most_rounds = 2, .spread = -1.0})) {
    EXPECT_EQ(entry.second.per_step.size(), 6u);
    EXPECT_FALSE(entry.second.steady);
  }
  for (const auto& entry :
       times(runs(), {.least_time = 1e-4, .repetitions = 3, .most_rounds = 2, .spread = 1e9})) {
    EXPECT_EQ(entry.second.per_step.size(), 3u);
    EXPECT_TRUE(entry.second.steady);
  }
}

TEST_F(TimeRunsTest, LeavesTheThreadOnTheProcessorsWhereItWas) {
  cpu_set_t before, after;
  ASSERT_EQ(sched_getaffinity(0, sizeof(before), &before), 0);
  times(runs(), {.least_time = 1e-5, .repetitions = 1, .most_rounds = 1});
  ASSERT_EQ(sched_getaffinity(0, sizeof(after), &after), 0);
  EXPECT_TRUE(CPU_EQUAL(&before, &after));
}

TEST_F(TimeRunsTest, RunsInExtendedPrecisionAreNotTimed) {
  const auto specs = runs("extended");
  EXPECT_FALSE(is_timed(specs.front()));
  EXPECT_THROW(times(specs, {}), std::logic_error);
}

TEST(TimesOfARecord, AreThoseOfTheRepetitions) {
  const Json record = sample_record({.precision = "double"}, sample_result(1e-3, 1e-3, 1e-3));
  const RunTimes times{
      .per_step = {300.04, 310.0, 290.0, 305.0}, .start = 5000.4, .steps = 10, .steady = false};
  const Json timed = with_time(record, times);
  const Json& time = timed.at("time");
  EXPECT_EQ(time.at("ns_per_step").at("median"), 302.5);
  EXPECT_EQ(time.at("ns_per_step").at("min"), 290.0);
  EXPECT_EQ(time.at("ns_per_step").at("max"), 310.0);
  EXPECT_EQ(time.at("ns_per_step").at("repetitions"), 4);
  EXPECT_EQ(time.at("ns_per_step").at("samples"), (std::vector<double>{300.0, 310.0, 290.0, 305.0}));
  EXPECT_EQ(time.at("start_ns"), 5000.0);
  EXPECT_EQ(time.at("total_ns"), 8026.0);
  EXPECT_EQ(time.at("unsteady"), true);
  EXPECT_EQ(timed.at("errors"), record.at("errors"));
  EXPECT_EQ(timed.back(), timed.at("provenance"));
}

}  // namespace
}  // namespace liebench
