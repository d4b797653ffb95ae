#include "harness/cost_report.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/harness/sample_records.h"

namespace liebench {
namespace {

// Errors h^k, a microsecond and 1000 operations a step, whatever k is.
std::vector<RecordRow> study(bool timed) {
  std::vector<Json> records;
  for (const char* formulation : {"SO3", "R3xSO3"})
    for (const int k : {2, 3})
      for (const double h : {1e-1, 1e-2, 1e-3}) {
        Json record =
            power_law_record({.formulation = formulation, .k = k, .precision = "double", .step_size = h}, k);
        const double steps = record.at("steps").get<double>();
        record["cost"]["flops"] = 1000 * steps;
        if (timed) record["time"] = {{"total_ns", 1000 * steps}};
        records.push_back(std::move(record));
      }
  return record_rows(records);
}

TEST(CostReport, NamesTheCheapestAndWhatItCosts) {
  const std::string text = cost_report(study(true));
  // 1e-6 takes k = 3 at h = 1e-2: 200 steps, 0.2 ms; k = 2 at h = 1e-3: 2 ms.
  EXPECT_NE(text.find("0.2: BLieDF2nd, k = 3 on SO3"), std::string::npos) << text;
  EXPECT_NE(text.find("0.2: BLieDF2nd, k = 3 on R3xSO3, index3"), std::string::npos) << text;
  EXPECT_NE(text.find("**0.2**"), std::string::npos) << text;
  EXPECT_NE(text.find("2.00e+05"), std::string::npos) << text;
  // 1e-8 with k = 2 would take a step of 1e-4: a decade beyond in h, two in the error.
  EXPECT_EQ(text.find("No run was timed"), std::string::npos);
}

TEST(CostReport, WithoutTimesItSaysSoAndCountsOperations) {
  const std::string text = cost_report(study(false));
  EXPECT_NE(text.find("No run was timed"), std::string::npos);
  EXPECT_EQ(text.find("Computing time"), std::string::npos);
  EXPECT_EQ(cost_accuracy_figure(study(false)).panels.at(0).x_label, "floating point operations of the run");
}

TEST(CostAccuracyFigure, HasOneTitleAPanelAndTheTimes) {
  const Figure figure = cost_accuracy_figure(study(true));
  ASSERT_EQ(figure.panels.size(), 2u);
  EXPECT_EQ(figure.panels[0].x_label, "computing time of the run in s");
  EXPECT_NE(figure.panels[0].title, figure.panels[1].title);
}

}  // namespace
}  // namespace liebench
