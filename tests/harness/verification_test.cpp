#include "harness/verification.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "harness/embedded.h"
#include "harness/figures.h"
#include "harness/order_matrix.h"
#include "tests/harness/sample_records.h"

namespace liebench {
namespace {

using Records = std::map<std::string, std::vector<Json>>;

// The orders that the paper claims, of q, v and lambda.
struct Orders {
  double q, v, lambda;
};

Orders claimed(const Json& record) {
  if (record["integrator"] == "generalized_alpha") return {2, 2, 2};
  const int k = record["options"]["k"].get<int>();
  const bool corrected = record["options"].value("correction", Json(true)) != false;
  const double order = corrected ? k : std::min(2, k);
  return {order, order, order};
}

// With errors of the orders that the matrix of all methods expects; of a method that chooses its steps in the step that its tolerance
// asks for. What theory says nothing of follows no law.
RunResult as_expected(const Json& record, const RunSpec& run, bool constrained) {
  const std::vector<RecordRow> rows = record_rows({record});
  double step_size = run.step_size();
  if (run.method->chooses_steps)
    step_size = std::pow(run.request.options.real("tolerance"),
                         1.0 / run.method->orders(run.request.options).estimate);
  const auto error = [&](const char* component, const char* norm) {
    return std::pow(step_size, expected_order(*rows.at(0).curve, {component, norm}).value_or(1.7));
  };
  RunResult result = sample_result(error("q", "end_relative"), error("v", "end_relative"),
                                   constrained ? error("lambda", "end_relative") : 0.0, constrained);
  result.q->max_absolute = error("q", "max_absolute");
  result.v->max_absolute = error("v", "max_absolute");
  if (result.lambda) result.lambda->max_absolute = error("lambda", "max_absolute");
  return result;
}

// Records of every run of the figures' studies, with errors that follow the claims exactly; `change` may bend
// the orders of a record of the paper's methods. The study of the field is left out: it claims no order, and has runs
// by tolerance, without a step size.
template <class Change>
Records records_by(const Change& change) {
  Records all;
  for (const PaperFigure& figure : paper_figures()) {
    if (figure.name == "field") continue;
    for (const std::string_view file : figure.studies)
      for (const RunSpec& run : read_study(parse_json(embedded_file(file), std::string(file))).runs) {
        const bool constrained = run.formulation->constraints > 0;
        const Json plain =
            make_record(run, sample_result(1, 1, 1, constrained), NoProblem(), sample_provenance());
        if (figure.name == "verification") {
          all[run.study].push_back(
              make_record(run, as_expected(plain, run, constrained), NoProblem(), sample_provenance()));
          continue;
        }
        Orders orders = claimed(plain);
        if (figure.name == "figure2") orders = {orders.q + 1, orders.v + 1, orders.lambda + 1};
        if (figure.name == "first_steps") orders.q += 1;
        double lambda_max = orders.lambda;
        const std::string_view formulation = run.formulation->name;
        if (figure.name != "figure2" && run.request.options.choice_or("form", "") == "index3" &&
            !run.request.options.boolean("modified_start") && formulation.starts_with("R3x"))
          lambda_max -= 1;
        change(plain, orders, lambda_max);
        const auto law = [&](double order) { return std::pow(run.step_size(), order); };
        RunResult result = sample_result(law(orders.q), law(orders.v), law(orders.lambda), constrained);
        if (result.lambda) result.lambda->max_absolute = law(lambda_max);
        all[run.study].push_back(make_record(run, result, NoProblem(), sample_provenance()));
      }
  }
  return all;
}

Verification verify_records(const Records& all, const std::string& note = "") {
  std::map<std::string, std::vector<RecordRow>> rows;
  for (const auto& [study, records] : all) rows[study] = record_rows(records);
  return verify(rows, note);
}

Records perfect() {
  return records_by([](const Json&, Orders&, double&) {});
}

TEST(Verification, ConfirmsEveryClaimWhereTheErrorsFollowThePaper) {
  const Verification result = verify_records(perfect());
  EXPECT_GT(result.claims, 40);
  EXPECT_EQ(result.confirmed, result.claims) << result.markdown;
  EXPECT_NE(result.markdown.find(fmt::format("**{} of {} claims confirmed.**", result.claims, result.claims)),
            std::string::npos);
}

TEST(Verification, CoversEveryOrderOfThePaperInEveryComponent) {
  const std::string text = verify_records(perfect()).markdown;
  for (const char* part :
       {"Theorem 1", "Theorem 2", "Theorem 3", "Generalized-alpha", "stabilized index 2", "(56)", "L_k",
        "relative error of q", "relative error of v", "relative error of lambda", "maximum error of lambda"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
}

TEST(Verification, DeniesAClaimWhoseErrorsFallMoreSlowly) {
  // lambda of Figure 4, k = 3 with L_k: order 2.5 instead of 3.
  const Verification result = verify_records(records_by([](const Json& record, Orders& orders, double&) {
    if (record["study"] == "figure4" && record["options"]["k"] == 3 &&
        record["options"]["correction"] == true)
      orders.lambda = 2.5;
  }));
  EXPECT_EQ(result.confirmed, result.claims - 1) << result.markdown;
  EXPECT_NE(result.markdown.find("differs"), std::string::npos);
}

TEST(Verification, DeniesAClaimWhoseErrorsFallFaster) {
  // Without L_k the paper claims order 2, not "at least 2".
  const Verification result = verify_records(records_by([](const Json& record, Orders& orders, double&) {
    if (record["study"] == "figure3" && record["options"]["k"] == 4 &&
        record["options"]["correction"] == false)
      orders.q = 4;
  }));
  EXPECT_EQ(result.confirmed, result.claims - 1) << result.markdown;
}

TEST(Verification, JudgesTheOrderReductionAsAClaimOfItsOwn) {
  // Without (56) the maximum of lambda has order k - 1: order k there is a difference, not a bonus.
  const Verification result = verify_records(records_by([](const Json& record, Orders&, double& lambda_max) {
    if (record["study"] == "figure1" && record["options"]["k"] == 2) lambda_max = 2;
  }));
  EXPECT_EQ(result.confirmed, result.claims - 1) << result.markdown;
}

TEST(Verification, DeniesAMethodThatChoosesItsStepsWhoseErrorsFollowAnotherPowerOfTheTolerance) {
  Records all = perfect();
  int bent = 0;
  for (Json& record : all.at("verification_step_control")) {
    if (record["integrator"] != "rkmk_variable" || record["formulation"] != "SO3") continue;
    // tol^{4/5}, as if the solution of order 4 were kept.
    record["errors"]["q"]["max_absolute"] = std::pow(record["options"]["tolerance"].get<double>(), 0.8);
    ++bent;
  }
  EXPECT_GT(bent, 5);
  const Verification result = verify_records(all);
  EXPECT_EQ(result.confirmed, result.claims - 1);
  EXPECT_NE(result.markdown.find("**4.00 ± 0.00, expected 5**"), std::string::npos);
}

TEST(Verification, LooksAtExtendedPrecisionOnly) {
  Records records = perfect();
  const Verification before = verify_records(records);
  for (auto& [study, rows] : records)
    for (Json& record : rows)
      if (record["precision"] == "double") record["errors"]["q"]["end_relative"] = 1.0;
  EXPECT_EQ(verify_records(records).markdown, before.markdown);
}

TEST(Verification, WithoutPointsConfirmsNothing) {
  Records records = perfect();
  for (auto& [study, rows] : records)
    for (Json& record : rows) {
      record["outcome"] = "newton_diverged";
      record.erase("errors");
      record["failure"] = {{"time", 0.5}, {"message", "it does not converge"}};
    }
  const Verification result = verify_records(records);
  EXPECT_GT(result.claims, 40);
  EXPECT_EQ(result.confirmed, 0);
  EXPECT_NE(result.markdown.find("no order: "), std::string::npos);
}

TEST(Verification, LeavesOutClaimsOfFiguresThatWereNotMade) {
  const Records all = perfect();
  int sum = 0;
  for (const auto& [study, rows] : all) {
    const Verification one = verify_records({{study, rows}});
    // Three studies compare and claim no order.
    EXPECT_EQ(one.claims == 0,
              study == "formulations" || study == "correction_stability" || study == "cost_accuracy")
        << study;
    sum += one.claims;
  }
  EXPECT_EQ(sum, verify_records(all).claims);
  EXPECT_EQ(verify_records({}).claims, 0);
}

TEST(Verification, CarriesTheNote) {
  EXPECT_NE(verify_records(perfect(), "This is the short form.").markdown.find("This is the short form."),
            std::string::npos);
}

}  // namespace
}  // namespace liebench
