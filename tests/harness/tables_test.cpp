#include "harness/tables.h"

#include <gtest/gtest.h>

#include "tests/harness/sample_records.h"

namespace liebench {
namespace {

std::vector<Json> two_curves() {
  std::vector<Json> records;
  for (const int k : {2, 3})
    for (const double h : {0.01, 0.005, 0.0025, 0.00125, 0.000625})
      records.push_back(power_law_record({.k = k, .step_size = h}, k));
  return records;
}

TEST(OrdersTable, HasARowForEveryErrorThatACurveHas) {
  EXPECT_EQ(orders_table(record_rows(two_curves())).rows().size(), 12u);  // 2 curves, 3 components, 2 norms
  std::vector<Json> unconstrained;
  for (const double h : {0.01, 0.005, 0.0025, 0.00125})
    unconstrained.push_back(power_law_record({.formulation = "SO3", .step_size = h}, 2));
  EXPECT_EQ(orders_table(record_rows(unconstrained)).rows().size(), 4u);
  EXPECT_EQ(orders_table(record_rows({sample_record({}, sample_failure())})).rows().size(), 0u);
}

TEST(OrdersTable, ShowsTheOrderOfEachCurve) {
  const Table table = orders_table(record_rows(two_curves()));
  for (const Row& row : table.rows()) {
    const double expected = std::get<std::string>(row.at(0)) == "k = 2" ? 2.0 : 3.0;
    EXPECT_NEAR(std::get<double>(row.at(2)), expected, 1e-6);
    EXPECT_EQ(std::get<double>(row.at(4)), 0.000625);
    EXPECT_EQ(std::get<double>(row.at(5)), 0.01);
    EXPECT_EQ(std::get<std::int64_t>(row.at(6)), 5);
  }
}

TEST(OrdersTable, SaysWhyThereIsNoOrder) {
  const Table table = orders_table(
      record_rows({power_law_record({.step_size = 0.01}, 2), power_law_record({.step_size = 0.005}, 2)}));
  ASSERT_FALSE(table.rows().empty());
  for (const Row& row : table.rows()) {
    EXPECT_TRUE(std::holds_alternative<std::monostate>(row.at(2)));
    EXPECT_FALSE(std::get<std::string>(row.at(7)).empty());
  }
}

TEST(OutcomesTable, CountsEveryRunOnce) {
  std::vector<Json> records = two_curves();
  records.push_back(sample_record({.k = 2, .step_size = 0.02}, sample_failure()));
  records.push_back(sample_record({.k = 2, .step_size = 0.04}, sample_failure()));
  RunResult other = sample_failure();
  other.outcome = Outcome::rotation_too_large;
  other.failure->time = 1.5;
  records.push_back(sample_record({.k = 3, .step_size = 0.04}, other));
  const Table table = outcomes_table(record_rows(records));
  std::int64_t runs = 0;
  std::vector<std::string> rows;
  for (const Row& row : table.rows()) {
    runs += std::get<std::int64_t>(row.at(2));
    rows.push_back(std::get<std::string>(row.at(0)) + " " + std::get<std::string>(row.at(1)) + " " +
                   std::to_string(std::get<std::int64_t>(row.at(2))) + " " +
                   std::get<std::string>(row.at(3)));
  }
  EXPECT_EQ(runs, std::int64_t(records.size()));
  EXPECT_EQ(rows,
            (std::vector<std::string>{"k = 2 newton_diverged 2 0.04 to 0.02", "k = 2 ok 5 0.01 to 0.000625",
                                      "k = 3 ok 5 0.01 to 0.000625", "k = 3 rotation_too_large 1 0.04"}));
  EXPECT_EQ(std::get<double>(table.rows()[3].at(4)), 1.5);
  EXPECT_EQ(std::get<std::int64_t>(table.rows()[3].at(5)), 250);
  EXPECT_EQ(std::get<double>(table.rows()[3].at(6)), 3.5);
  EXPECT_EQ(std::get<std::string>(table.rows()[3].at(7)), "it does not converge");
  EXPECT_TRUE(std::holds_alternative<std::monostate>(table.rows()[1].at(4)));
}

}  // namespace
}  // namespace liebench
