#include "harness/select.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/harness/sample_records.h"

namespace liebench {
namespace {

Json record(const SampleRun& sample) {
  return sample_record(sample, sample_result(1, 1, 1));
}
std::size_t curve_count(const std::vector<Json>& records) {
  return curves(record_rows(records)).size();
}

std::vector<std::string> labels(const std::vector<Curve>& list) {
  std::vector<std::string> texts;
  for (const Curve& curve : list) texts.push_back(curve.label);
  return texts;
}

TEST(Curves, HoldTheRecordsThatDifferInTheStepSizeAloneByFallingStepSize) {
  const std::vector<RecordRow> records =
      record_rows({record({.k = 2, .step_size = 0.01}), record({.k = 3, .step_size = 0.01}),
                   record({.k = 2, .step_size = 0.1}), record({.k = 3, .step_size = 0.05}),
                   record({.k = 2, .step_size = 0.02})});
  const auto list = curves(records);
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(labels(list), (std::vector<std::string>{"k = 2", "k = 3"}));
  EXPECT_EQ(list[0].records, (std::vector<const RecordRow*>{&records[2], &records[4], &records[0]}));
  EXPECT_EQ(list[1].records, (std::vector<const RecordRow*>{&records[3], &records[1]}));
}

TEST(Curves, DoNotDependOnTheStudyAndItsProvenance) {
  Json elsewhere = record({.study = "another", .step_size = 0.02});
  elsewhere["provenance"]["cpu"] = "another";
  EXPECT_EQ(curve_count({record({.step_size = 0.01}), elsewhere}), 1u);
}

TEST(Curves, OfAnotherInputAreApart) {
  const SampleRun base;
  const std::vector<SampleRun> others{{.formulation = "SO3"},
                                      {.k = 4},
                                      {.correction = false},
                                      {.modified_start = true},
                                      {.precision = "double"}};
  for (const SampleRun& other : others) EXPECT_EQ(curve_count({record(base), record(other)}), 2u);
  Json heavier = record(base);
  heavier["parameters"]["mass"] = 20.0;
  EXPECT_EQ(curve_count({record(base), heavier}), 2u);
  Json later = record(base);
  later["t_0"] = 1.0;
  EXPECT_EQ(curve_count({record(base), later}), 2u);
}

TEST(Curves, OverAnotherIntervalAreApart) {
  // Errors at t = 1 and at t = 2 do not lie on one curve.
  EXPECT_EQ(
      curve_count({record({.step_size = 0.01, .t_end = 1.0}), record({.step_size = 0.02, .t_end = 2.0})}),
      2u);
}

TEST(Curves, OfLocalRunsEndAtTheirOwnTimesAndAreOne) {
  EXPECT_EQ(
      curve_count({record({.step_size = 0.01, .local = true}), record({.step_size = 0.02, .local = true})}),
      1u);
}

TEST(Curves, ThatWereReadApartAreOneWhereTheyAreEqual) {
  std::vector<RecordRow> rows = record_rows({record({.step_size = 0.01})});
  Json other = record({.step_size = 0.02});
  other["parameters"]["mass"] = 15;
  rows.push_back(row_of(other));
  ASSERT_NE(rows[0].curve, rows[1].curve);
  EXPECT_EQ(curves(rows).size(), 1u);
}

TEST(Curves, AreNamedByWhatDiffersAmongThem) {
  EXPECT_EQ(labels(curves(record_rows({record({})}))), std::vector<std::string>{"bliedf2nd"});
  EXPECT_EQ(labels(curves(record_rows({record({.correction = true}), record({.correction = false})}))),
            (std::vector<std::string>{"correction = true", "correction = false"}));
  EXPECT_EQ(labels(curves(record_rows({record({.formulation = "SO3", .precision = "double"}),
                                       record({.formulation = "R3xSO3", .precision = "extended"})}))),
            (std::vector<std::string>{"SO3, double", "R3xSO3, extended"}));
}

TEST(Curves, NoTwoHaveTheSameName) {
  std::vector<Json> records;
  for (const char* formulation : {"SO3", "R3xSO3"})
    for (const int k : {2, 3})
      for (const bool correction : {true, false})
        for (const char* precision : {"double", "extended"})
          records.push_back(
              record({.formulation = formulation, .k = k, .correction = correction, .precision = precision}));
  const auto list = labels(curves(record_rows(records)));
  EXPECT_EQ(list.size(), 16u);
  for (std::size_t i = 0; i < list.size(); ++i)
    EXPECT_EQ(std::count(list.begin(), list.end(), list[i]), 1) << list[i];
}

TEST(ErrorOf, IsWhatTheRecordSaysAndNothingWhereItDoesNot) {
  RunResult result = sample_result(0, 0, 0);
  result.q = ErrorNorms{.end_relative = 1, .end_absolute = 2, .max_absolute = 3};
  result.lambda = ErrorNorms{.end_relative = 4, .end_absolute = 5, .max_absolute = 6};
  const RecordRow record = row_of(sample_record({}, result));
  EXPECT_EQ(error_of(record, {"q", "end_relative"}), 1.0);
  EXPECT_EQ(error_of(record, {"q", "end_absolute"}), 2.0);
  EXPECT_EQ(error_of(record, {"q", "max_absolute"}), 3.0);
  EXPECT_EQ(error_of(record, {"lambda", "max_absolute"}), 6.0);
  EXPECT_EQ(error_of(record, {"v", "end_relative"}), 0.0);
  EXPECT_EQ(error_of(row_of(sample_record({}, sample_failure())), {}), std::nullopt);
  EXPECT_EQ(error_of(row_of(sample_record({.formulation = "SO3"}, sample_result(1, 1, 1, false))),
                     {"lambda", "end_relative"}),
            std::nullopt);
}

TEST(FitCurve, FindsTheOrderOfAPowerLawAndPassesOverFailures) {
  std::vector<Json> records{sample_record({.step_size = 0.1}, sample_failure())};
  for (const double h : {0.01, 0.005, 0.0025, 0.00125, 0.000625})
    records.push_back(power_law_record({.step_size = h}, 3.0));
  const auto rows = record_rows(records);
  const auto list = curves(rows);
  ASSERT_EQ(list.size(), 1u);
  const OrderFit fit = fit_curve(list[0], {});
  ASSERT_TRUE(fit.estimate) << fit.reason;
  EXPECT_NEAR(fit.estimate->order, 3.0, 1e-6);
  EXPECT_EQ(fit.estimate->points, 5);
}

TEST(FitCurve, TakesTheErrorOfTheReferenceIntoAccount) {
  std::vector<Json> records;
  for (const double h : {0.01, 0.005, 0.0025, 0.00125, 0.000625}) {
    records.push_back(power_law_record({.step_size = h}, 3.0));
    records.back()["reference"]["error_estimate"] = 1e-6;
  }
  EXPECT_EQ(fit_curve(curves(record_rows(records))[0], {}).outcome, OrderOutcome::below_reference);
}

}  // namespace
}  // namespace liebench
