#include "harness/compare.h"

#include <gtest/gtest.h>

#include "harness/rank_test.h"
#include "tests/harness/sample_records.h"

namespace liebench {
namespace {

std::vector<Json> rows() {
  std::vector<Json> records;
  for (const double h : {0.01, 0.005, 0.0025})
    records.push_back(power_law_record({.precision = "double", .step_size = h}, 2));
  return records;
}

Comparison compared(const std::vector<Json>& before, const std::vector<Json>& after,
                    double band = default_band) {
  return compare_records(record_rows(before), record_rows(after), band);
}

TEST(Compare, OfASetWithItselfFindsNothing) {
  const Comparison c = compared(rows(), rows());
  EXPECT_EQ(c.matched, 3u);
  EXPECT_FALSE(c.differs(true)) << report(c);
}

TEST(Compare, OtherKeysAreMatchedByWhatWasRun) {
  auto after = rows();
  for (Json& record : after) record["key"] = "new " + record["key"].get<std::string>();
  const Comparison c = compared(rows(), after);
  EXPECT_EQ(c.matched, 3u);
  EXPECT_FALSE(c.differs(true)) << report(c);
}

TEST(Compare, SeesACountThatIsOneMore) {
  auto after = rows();
  after[1]["cost"]["residuals"] = after[1]["cost"]["residuals"].get<int>() + 1;
  const Comparison c = compared(rows(), after);
  EXPECT_EQ(c.counts.size(), 1u) << report(c);
  EXPECT_TRUE(c.differs(false));
}

TEST(Compare, ACountThatIsNewIsNoChangeAndOneThatIsGoneIs) {
  auto after = rows();
  after[0]["cost"]["flops"] = 7;
  EXPECT_FALSE(compared(rows(), after).differs(false));
  EXPECT_TRUE(compared(after, rows()).differs(false));
}

TEST(Compare, ErrorsMayDifferInsideTheBandOnly) {
  auto after = rows();
  Json& error = after[0]["errors"]["q"]["end_relative"];
  const double value = error.get<double>();
  error = value * (1 + 5e-7);
  EXPECT_FALSE(compared(rows(), after).differs(false));
  error = value * (1 + 1e-5);
  EXPECT_EQ(compared(rows(), after).errors.size(), 1u);
  EXPECT_FALSE(compared(rows(), after, 1e7).differs(false));
}

TEST(Compare, SeesOutcomesAndRowsThatComeAndGo) {
  auto after = rows();
  after[0] = sample_record({.precision = "double", .step_size = 0.01}, sample_failure());
  after[2] = power_law_record({.k = 3, .precision = "double", .step_size = 0.01}, 3);
  const Comparison c = compared(rows(), after);
  EXPECT_EQ(c.outcomes.size(), 1u) << report(c);
  EXPECT_EQ(c.missing.size(), 1u) << report(c);
  EXPECT_EQ(c.added.size(), 1u) << report(c);
}

TEST(Compare, ATimeThatChangedIsADifferenceOnlyWhenAsked) {
  auto before = rows(), after = rows();
  for (int i = 0; i < 9; ++i) {
    before[0]["time"]["ns_per_step"]["samples"].push_back(100.0 + i);
    after[0]["time"]["ns_per_step"]["samples"].push_back(150.0 + i);
  }
  const Comparison c = compared(before, after);
  EXPECT_EQ(c.times.size(), 1u) << report(c);
  EXPECT_FALSE(c.differs(false));
  EXPECT_TRUE(c.differs(true));
}

TEST(Compare, ReportNamesTwentyOfAKind) {
  Comparison c;
  c.missing.assign(23, "row");
  EXPECT_NE(report(c).find("... and 3 more"), std::string::npos);
}

TEST(RankTest, IsExactForSmallSamples) {
  // All of one sample below all of the other: 2 of the 252 choices of five ranks out of ten.
  EXPECT_NEAR(rank_test({1, 2, 3, 4, 5}, {6, 7, 8, 9, 10}), 2.0 / 252, 1e-12);
  EXPECT_NEAR(rank_test({1, 2, 3}, {4, 5, 6}), 2.0 / 20, 1e-12);
  EXPECT_EQ(rank_test({1, 4}, {2, 3}), 1.0);
  EXPECT_EQ(rank_test({1, 1, 1}, {1, 1}), 1.0);
}

}  // namespace
}  // namespace liebench
