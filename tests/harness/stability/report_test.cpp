#include "harness/stability/report.h"

#include <gtest/gtest.h>

#include "harness/errors.h"

namespace liebench {
namespace {

Json record(const std::string& subject, const std::string& form, const std::string& verdict,
            bool safeguard = true) {
  Json j = {{"schema", 1},
            {"key", subject + form + verdict},
            {"case", "stiffness"},
            {"variant", "soft"},
            {"subject", subject},
            {"form", form},
            {"integrator", "bliedf2nd"},
            {"options", {{"k", 2}}},
            {"outcome", "ok"},
            {"grade", "survived"},
            {"expected", "survived"},
            {"verdict", verdict},
            {"amount", 0.5},
            {"what", "amplitude"},
            {"reason", "theory"},
            {"measured", {{"amplitude", 0.5}}}};
  if (safeguard) j["options"]["safeguard"] = true;
  return j;
}

const std::vector<Json>& records() {
  static const std::vector<Json> list{
      record("BLieDF2nd, k = 1", "index3", "passed"), record("BLieDF2nd, k = 1", "index3", "degraded"),
      record("BLieDF2nd, k = 2", "stabilized_index2", "failed_as_expected"),
      record("BLieDF2nd, k = 2", "stabilized_index2", "failed_unexpectedly", false)};
  return list;
}

TEST(StabilityMap, ACellIsTheWorstTrialWithTheSafeguard) {
  const HeatMap map = stability_map(records());
  EXPECT_EQ(map.rows, (std::vector<std::string>{"BLieDF2nd, k = 1", "BLieDF2nd, k = 2"}));
  ASSERT_EQ(map.columns.size(), 2u);
  EXPECT_EQ(map.columns[0].label, "index 3");
  EXPECT_EQ(map.columns[1].label, "stabilized");
  EXPECT_EQ(map.cells, (std::vector<std::vector<int>>{{1, -1}, {-1, 2}}));
  // No surprise: no entry of the legend for one.
  EXPECT_EQ(map.kinds.size(), 3u);
}

TEST(StabilityMap, ASurpriseHasItsColour) {
  std::vector<Json> all = records();
  all.push_back(record("BLieDF2nd, k = 1", "stabilized_index2", "passed_unexpectedly"));
  const HeatMap map = stability_map(all);
  ASSERT_EQ(map.kinds.size(), 4u);
  EXPECT_EQ(map.kinds[3].name, "better than theory says");
  EXPECT_EQ(map.cells[0][1], 3);
}

TEST(StabilityTables, TheMatrixSaysHowMuchIsDegraded) {
  const Table matrix = stability_matrix(records(), "index3");
  ASSERT_EQ(matrix.rows().size(), 1u);
  EXPECT_EQ(std::get<std::string>(matrix.rows()[0][1]), "degraded (0.5)");
  EXPECT_TRUE(stability_matrix(records(), "").rows().empty());
}

TEST(StabilityTables, TheListHasEveryTrialWithWhatWasMeasured) {
  const Table list = stability_list(records());
  EXPECT_EQ(list.rows().size(), records().size());
  EXPECT_EQ(list.columns().back().header, "amplitude");
}

TEST(StabilityRecords, WhatIsNoneIsRefusedByItsPlace) {
  EXPECT_NO_THROW(parse_stability_record(records()[0].dump(), "a:1"));
  for (const char* key : {"key", "case", "verdict"}) {
    Json broken = records()[0];
    broken.erase(key);
    try {
      parse_stability_record(broken.dump(), "a.jsonl:3");
      ADD_FAILURE() << key;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("a.jsonl:3"), std::string::npos);
      EXPECT_NE(std::string(error.what()).find(key), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace liebench
