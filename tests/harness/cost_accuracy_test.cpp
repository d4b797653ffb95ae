#include "harness/cost_accuracy.h"

#include <gtest/gtest.h>

#include "harness/tables.h"
#include "tests/harness/sample_records.h"

namespace liebench {
namespace {

Json run_of(int k, double h, double error) {
  Json record = sample_record({.k = k, .step_size = h}, sample_result(error, error, error));
  record["cost"]["residuals"] = int(100 * k / h);
  return record;
}

std::vector<Json> curve_of(std::vector<double> errors) {
  std::vector<Json> records;
  double h = 0.01;
  for (const double error : errors) {
    records.push_back(run_of(2, h, error));
    h /= 10;
  }
  return records;
}

// target, curve, cheapest, h, steps, residuals, scd, mescd, remark
Row row_at(const std::vector<Json>& records, double target) {
  return cost_accuracy_table(record_rows(records), {}, {target}).rows().at(0);
}
double step_size(const Row& row) {
  return std::get<double>(row.at(3));
}
std::string remark(const Row& row) {
  return std::get<std::string>(row.back());
}
bool reached(const Row& row) {
  return std::holds_alternative<double>(row.at(3));
}

TEST(CostAccuracy, LiesOnTheLineBetweenTwoRuns) {
  const Row row = row_at(curve_of({1e-2, 1e-4, 1e-6}), 1e-5);
  EXPECT_NEAR(step_size(row), 0.001 / std::sqrt(10.0), 1e-12);
  EXPECT_NEAR(std::get<double>(row.at(5)), 2e5 * std::sqrt(10.0), 1e2);
  EXPECT_NEAR(std::get<double>(row.at(6)), 5.0, 1e-12);  // scd
  // mescd: relative and absolute error are both 1e-5, the solution has size 1.
  EXPECT_NEAR(std::get<double>(row.at(7)), 5.0 + std::log10(2.0), 1e-12);
  EXPECT_EQ(remark(row), "");
}

TEST(CostAccuracy, ACoarsestRunThatReachesTheTargetIsAnUpperBound) {
  const Row row = row_at(curve_of({1e-3, 1e-5}), 1e-2);
  EXPECT_DOUBLE_EQ(step_size(row), 0.01);
  EXPECT_EQ(remark(row), "at most: the coarsest run reaches it");
}

TEST(CostAccuracy, ExtrapolatesOneDecadeAndNoMore) {
  const Row row = row_at(curve_of({1e-2, 1e-4}), 1e-5);
  EXPECT_NEAR(step_size(row), 0.001 / std::sqrt(10.0), 1e-12);
  EXPECT_EQ(remark(row), "extrapolated");
  EXPECT_TRUE(std::holds_alternative<std::monostate>(row.at(2)));
  EXPECT_EQ(remark(row_at(curve_of({1e-2, 1e-4}), 9e-6 / 10)), "never reached; best 1.0e-04");
}

TEST(CostAccuracy, AFloorIsNotExtrapolatedAndDoesNotHideWhatLiesAboveIt) {
  const auto records = curve_of({1e-2, 1e-4, 1e-6, 3e-6, 2e-6});
  EXPECT_FALSE(reached(row_at(records, 5e-7)));
  EXPECT_NEAR(step_size(row_at(records, 1e-5)), 0.001 / std::sqrt(10.0), 1e-12);
}

TEST(CostAccuracy, AZeroCrossingDoesNotReachATargetThatFinerRunsMiss) {
  const auto records = curve_of({1e-2, 1e-9, 1e-4, 1e-6});
  EXPECT_FALSE(reached(row_at(records, 1e-8)));
  // Not before the finer runs reach it, too.
  EXPECT_LT(step_size(row_at(records, 1e-5)), 1e-4);
}

TEST(CostAccuracy, NeverInterpolatesAcrossAFailedRun) {
  auto records = curve_of({1e-2, 1e-4, 1e-6});
  records[1] = sample_record({.step_size = 0.001}, sample_failure());
  const Row row = row_at(records, 1e-4);
  EXPECT_DOUBLE_EQ(step_size(row), 1e-4);
  EXPECT_EQ(remark(row), "at most: the next coarser run failed");
}

TEST(CostAccuracy, MarksOneCheapestOfATarget) {
  std::vector<Json> records;
  for (const int k : {2, 3})
    for (const double h : {0.01, 0.001, 0.0001}) records.push_back(run_of(k, h, std::pow(h, k)));
  const Table table = cost_accuracy_table(record_rows(records), {}, {1e-5, 1e-7});
  ASSERT_EQ(table.rows().size(), 4u);
  for (const std::size_t first : {0u, 2u}) {
    EXPECT_EQ(std::get<std::string>(table.rows()[first].at(1)), "k = 3");
    EXPECT_EQ(std::get<bool>(table.rows()[first].at(2)), true);
    EXPECT_TRUE(std::holds_alternative<std::monostate>(table.rows()[first + 1].at(2)));
  }
}

TEST(CostsTable, DividesTheCountsOfTheFinestRunByItsSteps) {
  auto records = curve_of({1e-2, 1e-4});
  records[1]["cost"]["commutators"] = records[1]["steps"];
  const Table table = costs_table(record_rows(records));
  ASSERT_EQ(table.rows().size(), 1u);
  EXPECT_EQ(table.columns().back().header, "commutators");
  EXPECT_EQ(std::get<double>(table.rows()[0].back()), 1.0);
  EXPECT_EQ(std::get<double>(table.rows()[0].at(1)), 0.001);
  EXPECT_EQ(costs_table(record_rows(records), 0.01).rows().size(), 1u);
  EXPECT_TRUE(costs_table(record_rows(records), 0.5).rows().empty());
}

}  // namespace
}  // namespace liebench
