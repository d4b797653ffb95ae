#include "harness/record_plots.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "harness/errors.h"
#include "tests/harness/sample_records.h"

namespace liebench {
namespace {

// A run with flops of 1000 a step, timed at 0.5 us a step where asked for.
Json costed(const SampleRun& sample, bool timed = true) {
  Json record = power_law_record(sample, sample.k);
  const double steps = record.at("steps").get<double>();
  record["cost"]["flops"] = 1000 * steps;
  if (timed) record["time"] = {{"total_ns", 500 * steps}};
  return record;
}

std::vector<Json> study(bool timed = true) {
  std::vector<Json> records;
  for (const char* formulation : {"SO3", "R3xSO3"})
    for (const int k : {2, 3})
      for (const double h : {1e-2, 1e-3})
        records.push_back(
            costed({.formulation = formulation, .k = k, .precision = "double", .step_size = h}, timed));
  return records;
}

TEST(Abscissa, UnknownNamesAreRefusedWithTheNearest) {
  EXPECT_EQ(abscissa("time").name, "time");
  try {
    abscissa("flop");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"flops\""), std::string::npos) << error.what();
  }
}

TEST(Abscissa, TheDearestThatAllHaveIsTaken) {
  EXPECT_EQ(dearest_abscissa(record_rows(study())).name, "time");
  EXPECT_EQ(dearest_abscissa(record_rows(study(false))).name, "flops");
  std::vector<Json> records = study(false);
  records.back()["cost"].erase("flops");
  EXPECT_EQ(dearest_abscissa(record_rows(records)).name, "residuals");
  // A failed run has no time and needs none.
  records = study();
  records.push_back(sample_record({.precision = "double", .step_size = 0.1}, sample_failure()));
  EXPECT_EQ(dearest_abscissa(record_rows(records)).name, "time");
  // Nor has a run in extended precision.
  records.push_back(power_law_record({.precision = "extended", .step_size = 0.05}, 2));
  EXPECT_EQ(dearest_abscissa(record_rows(records)).name, "time");
}

TEST(ErrorFigure, HasAPanelForEachFormulationAndTheCostsOfTheRecords) {
  const RecordFigure result = error_figure(record_rows(study()), abscissa("time"), {}, true);
  EXPECT_EQ(result.left_out, 0u);
  ASSERT_EQ(result.figure.panels.size(), 2u);
  EXPECT_EQ(result.figure.rows * result.figure.columns, 2);
  for (const Panel& panel : result.figure.panels) {
    ASSERT_EQ(panel.series.size(), 2u);
    // One method: one colour; two k: two marks.
    EXPECT_EQ(panel.series[0].style, panel.series[1].style);
    EXPECT_NE(panel.series[0].mark, panel.series[1].mark);
    ASSERT_EQ(panel.series[0].points.size(), 2u);
    EXPECT_DOUBLE_EQ(panel.series[0].points[0].x, 500e-9 * 200);
    EXPECT_DOUBLE_EQ(panel.series[0].points[0].y, 1e-4);
    EXPECT_DOUBLE_EQ(panel.series[0].points[1].x, 500e-9 * 2000);
  }
  const RecordFigure one = error_figure(record_rows(study()), abscissa("time"), {}, false);
  ASSERT_EQ(one.figure.panels.size(), 1u);
  EXPECT_EQ(one.figure.panels[0].series.size(), 4u);
}

TEST(ErrorFigure, AFailedRunIsNeverDropped) {
  std::vector<Json> records = study();
  Json failed = sample_record({.formulation = "SO3", .k = 2, .precision = "double", .step_size = 0.1},
                              sample_failure());
  records.push_back(failed);
  const RecordFigure by_step = error_figure(record_rows(records), abscissa("step_size"), {}, true);
  ASSERT_EQ(by_step.figure.panels[0].series[0].failures.size(), 1u);
  EXPECT_EQ(by_step.figure.panels[0].series[0].failures[0].x, 0.1);
  // It has no time: above the coarsest run of its curve.
  const RecordFigure by_time = error_figure(record_rows(records), abscissa("time"), {}, true);
  const Series& series = by_time.figure.panels[0].series[0];
  ASSERT_EQ(series.failures.size(), 1u);
  EXPECT_EQ(series.failures[0].x, series.points[0].x);
  EXPECT_NE(by_time.figure.failures.find("1 newton"), std::string::npos) << by_time.figure.failures;
}

TEST(ErrorFigure, AFailedRunHasNoPlaceWhereTheQuantityDoesNotExist) {
  std::vector<Json> records = study();
  Json failed = sample_record({.formulation = "SO3", .k = 2, .precision = "double", .step_size = 0.1},
                              sample_failure());
  records.push_back(failed);
  const RecordFigure lambda =
      error_figure(record_rows(records), abscissa("step_size"), {"lambda", "end_relative"}, true);
  ASSERT_EQ(lambda.figure.panels.size(), 1u);
  EXPECT_EQ(lambda.figure.panels[0].title, "R3xSO3, index3");
  EXPECT_TRUE(error_figure({row_of(failed)}, abscissa("step_size"), {}, true).figure.panels.empty());
}

TEST(ErrorFigure, CurvesThatShareAPanelLookDifferent) {
  std::vector<Json> records = study();
  const auto series =
      error_figure(record_rows(records), abscissa("step_size"), {}, false).figure.panels.at(0).series;
  std::set<std::tuple<int, bool, int>> looks;
  for (const Series& each : series) looks.emplace(each.style, each.secondary, each.mark);
  EXPECT_EQ(looks.size(), series.size());
}

TEST(ErrorFigure, RecordsWithoutTheCostAreCounted) {
  std::vector<Json> records = study();
  records[0].erase("time");
  EXPECT_EQ(error_figure(record_rows(records), abscissa("time"), {}, true).left_out, 1u);
}

TEST(DriftFigure, HasAPanelForEachInvariantThatApplies) {
  std::vector<Json> constrained, free;
  for (const Json& record : study())
    (record.at("formulation") == "SO3" ? free : constrained).push_back(record);
  EXPECT_EQ(drift_figure(record_rows(constrained)).figure.panels.size(), 5u);
  EXPECT_EQ(drift_figure(record_rows(free)).figure.panels.size(), 3u);
  EXPECT_TRUE(drift_figure({row_of(sample_record({}, sample_failure()))}).figure.panels.empty());
}

}  // namespace
}  // namespace liebench
