#include "harness/order_matrix.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/harness/sample_records.h"

namespace liebench {
namespace {

CurveIdentity identity(const char* formulation, const Json& options) {
  return {.formulation = formulation,
          .integrator = options.contains("rho_inf")     ? "generalized_alpha"
                        : options.contains("max_order") ? "bliedf2nd_variable"
                        : options.empty()               ? "rkmk_variable"
                                                        : "bliedf2nd",
          .options = SharedJson(options)};
}
Json bdf(int k, const char* form, bool modified) {
  Json options{{"k", k}, {"correction", true}};
  if (*form) options["form"] = form;
  if (std::string(form) == "index3") options["modified_start"] = modified;
  return options;
}
const Quantity lambda_max{"lambda", "max_absolute"}, lambda_end{"lambda", "end_relative"},
    q_max{"q", "max_absolute"}, v_max{"v", "max_absolute"}, v_end{"v", "end_relative"};

TEST(ExpectedOrder, IsThatOfTheMethod) {
  for (int k = 1; k <= 6; ++k) {
    EXPECT_EQ(expected_order(identity("SO3", bdf(k, "", false)), q_max), k);
    EXPECT_EQ(expected_order(identity("R3xSO3", bdf(k, "stabilized_index2", false)), lambda_max), k);
    EXPECT_EQ(expected_order(identity("R3xSO3", bdf(k, "index3", false)), lambda_end), k);
  }
  Json none = bdf(4, "", false);
  none["correction"] = false;
  EXPECT_EQ(expected_order(identity("S3", none), q_max), 2);
  EXPECT_EQ(expected_order(identity("SO3", Json{{"rho_inf", 0.9}}), q_max), 2);
}

TEST(ExpectedOrder, OfLambdaIsReducedFromExactVelocitiesInTheInertialFrameOnly) {
  EXPECT_EQ(expected_order(identity("R3xSO3", bdf(3, "index3", false)), lambda_max), 2);
  EXPECT_EQ(expected_order(identity("R3xS3", bdf(3, "index3", false)), lambda_max), 2);
  EXPECT_EQ(expected_order(identity("R3xSO3", bdf(3, "index3", true)), lambda_max), 3);
  for (const char* body_fixed : {"SE3", "S3|xR3", "UDQ"})
    EXPECT_EQ(expected_order(identity(body_fixed, bdf(3, "index3", false)), lambda_max), 3) << body_fixed;
}

TEST(ExpectedOrder, ByToleranceIsThatOfTheFirstStepsWhereTheirErrorsAreTheLargest) {
  for (int k = 1; k <= 4; ++k) {
    const double first = 0.5 * (k + 1);
    Json options{{"max_order", k}};
    EXPECT_EQ(expected_order(identity("SO3", options), v_max), k);
    options["form"] = "stabilized_index2";
    EXPECT_EQ(expected_order(identity("R3xSO3", options), v_max), k);
    EXPECT_EQ(expected_order(identity("R3xSO3", options), lambda_end), k);
    EXPECT_EQ(expected_order(identity("R3xSO3", options), lambda_max), std::min<double>(k, first));
    EXPECT_EQ(expected_order(identity("SE3", options), lambda_max), k);
    options["form"] = "index3";
    EXPECT_EQ(expected_order(identity("R3xS3", options), q_max), k);
    EXPECT_EQ(expected_order(identity("R3xS3", options), v_end), k);
    EXPECT_EQ(expected_order(identity("R3xS3", options), v_max), std::min<double>(k, first));
    EXPECT_EQ(expected_order(identity("R3xS3", options), lambda_max), 0.0);
    EXPECT_EQ(expected_order(identity("R3xS3", options), lambda_end), std::nullopt);
    for (const char* body_fixed : {"SE3", "S3|xR3", "UDQ"})
      EXPECT_EQ(expected_order(identity(body_fixed, options), lambda_max), k) << body_fixed;
  }
  EXPECT_EQ(expected_order(identity("SO3", Json::object()), v_max), 5);
}

// Records of one curve whose errors are h^order.
std::vector<RecordRow> curve_records(double order) {
  std::vector<Json> records;
  for (int i = 0; i < 7; ++i) {
    const double h = 1e-3 * std::pow(10.0, -i / 6.0);
    records.push_back(power_law_record({.formulation = "SO3", .k = 3, .step_size = h}, order));
  }
  return record_rows(records);
}

TEST(OrderMatrix, ConfirmsWhatFallsAsExpectedAndNothingElse) {
  for (const double order : {2.0, 2.7, 3.0, 3.3, 4.0}) {
    const OrderMatrix matrix = order_matrix(curve_records(order));
    EXPECT_EQ(matrix.entries, 4) << order;  // q and v, at the end and largest
    EXPECT_EQ(matrix.confirmed, order == 3.0 ? 4 : 0) << order;
    EXPECT_EQ(matrix.markdown.find("expected 3") == std::string::npos, order == 3.0) << matrix.markdown;
    EXPECT_EQ(matrix.rows.size(), 4u);
  }
}

TEST(OrderMatrix, ACurveOfFailuresOfAMethodWithoutFormsStandsUnderLambdaToo) {
  std::vector<Json> records;
  for (int i = 0; i < 7; ++i)
    records.push_back(power_law_record({.k = 3, .step_size = 1e-3 * std::pow(10.0, -i / 6.0)}, 3.0));
  Json failed = records.back();
  failed["integrator"] = "half_explicit";
  failed["options"] = Json{{"tableau", "herk4"}, {"projection", false}};
  failed["outcome"] = "newton_diverged";
  failed["failure"] = Json{{"time", 0.5}, {"message", "it does not converge"}};
  failed.erase("errors");
  records.push_back(failed);
  const OrderMatrix matrix = order_matrix(record_rows(records));
  EXPECT_EQ(matrix.entries, 12);  // of two methods: q, v and lambda, at the end and largest
  EXPECT_NE(matrix.markdown.find("no order"), std::string::npos) << matrix.markdown;
}

TEST(OrderMatrix, AnExpectedOrderOfZeroIsMetByAnErrorThatDoesNotFall) {
  const std::vector<RecordRow> flat = curve_records(0.0), falling = curve_records(1.0);
  Curve curve;
  for (const RecordRow& record : flat) curve.records.push_back(&record);
  EXPECT_TRUE(judge(curve, q_max, 0).confirmed);
  EXPECT_FALSE(judge(curve, q_max, 1).confirmed);
  curve.records.clear();
  for (const RecordRow& record : falling) curve.records.push_back(&record);
  EXPECT_FALSE(judge(curve, q_max, 0).confirmed);
}

}  // namespace
}  // namespace liebench
