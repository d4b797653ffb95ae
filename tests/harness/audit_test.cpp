#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "harness/execute.h"
#include "harness/progress.h"
#include "harness/strict_json.h"
#include "tests/support/run_program.h"

// What a run costs, against what the definitions of the methods say.

namespace liebench {
namespace {

class AuditTest : public testing::Test {
 protected:
  std::vector<Json> run(const std::string& integrators, const std::string& rest) const {
    return run_problem(R"({"name": "heavy_top", "formulation": ["SO3", "R3xSO3", "SE3"]})", integrators,
                       rest);
  }
  std::vector<Json> run_problem(const std::string& problem, const std::string& integrators,
                                const std::string& rest) const {
    const Study study = read_study(parse_json(R"({"name": "audit", "problems": [)" + problem +
                                                  R"(], "integrators": )" + integrators + ", " + rest + "}",
                                              "audit"));
    std::vector<Json> records(study.runs.size());
    Progress progress("", 1.0);
    execute(study.runs, 2, ReferenceCache(cache_.path()), progress,
            [&](std::size_t i, const Json& record) { records[i] = record; });
    return records;
  }

  static std::uint64_t count(const Json& record, const char* what) {
    return record.at("cost").at(what).get<std::uint64_t>();
  }
  // Every evaluation of the step equation takes one exponential: an iteration, the state at its end, a new matrix.
  static std::uint64_t evaluations(const Json& record) {
    return count(record, "newton_iterations") + own_steps(record) + count(record, "jacobians");
  }
  static std::uint64_t start_factorizations(const Json& record) {
    return record.at("cost").at("factorizations_by_cause").at("start").get<std::uint64_t>();
  }
  static std::uint64_t own_steps(const Json& record) {
    return record.at("steps").get<std::uint64_t>() + 1 - record.at("options").at("k").get<std::uint64_t>();
  }

 private:
  TemporaryFolder cache_;
};

const std::string from_reference = R"("step_sizes": [1e-3], "t_end": 0.2, "start": "reference")";

TEST_F(AuditTest, BLieDF2ndTakesOneCommutatorAStepAndNoLogarithmAfterTheStart) {
  const auto records = run(R"([{"name": "bliedf2nd", "k": [3, 4]}])", from_reference);
  ASSERT_EQ(records.size(), 6u);
  for (const Json& record : records) {
    EXPECT_EQ(record.at("outcome"), "ok");
    EXPECT_EQ(count(record, "commutators"), own_steps(record)) << record.at("options");
    EXPECT_EQ(count(record, "log"), record.at("options").at("k").get<std::uint64_t>() - 1);
    EXPECT_EQ(count(record, "tangent_inverse"), 0u);
    EXPECT_EQ(count(record, "exp"), evaluations(record));
  }
}

TEST_F(AuditTest, WithoutTheCorrectionThereIsNoCommutator) {
  for (const Json& record :
       run(R"([{"name": "bliedf2nd", "k": [2, 3, 4], "correction": false}, {"name": "bliedf2nd", "k": 2}])",
           from_reference))
    EXPECT_EQ(count(record, "commutators"), 0u) << record.at("options");
}

TEST_F(AuditTest, FaltinsensVariantsTakeLogarithmsOrMoreCommutators) {
  for (const Json& record :
       run(R"([{"name": "faltinsen_bdf", "k": [3, 4], "variant": ["exact", "bch"]}])", from_reference)) {
    const auto k = record.at("options").at("k").get<std::uint64_t>();
    if (record.at("options").at("variant") == "exact") {
      EXPECT_EQ(count(record, "log"), k - 1 + (k - 2) * own_steps(record));
      // T once in each evaluation; those of the Newton matrices come on top.
      EXPECT_GT(count(record, "tangent"), evaluations(record));
    } else {
      EXPECT_EQ(count(record, "log"), k - 1);
      // In a step 1 (k = 3) or 3 (k = 4) of the history, 1 or 2 in each evaluation.
      EXPECT_GE(count(record, "commutators"),
                (2 * k - 5) * own_steps(record) + (k - 2) * evaluations(record));
    }
  }
}

TEST_F(AuditTest, CausesAndKindsSumUp) {
  for (const Json& record :
       run(R"([{"name": "bliedf2nd", "k": 3}, {"name": "generalized_alpha"}])",
           R"("step_sizes": [5e-3, 1e-3], "t_end": 0.2, "precision": ["double", "extended"])")) {
    const Json& cost = record.at("cost");
    std::uint64_t causes = 0, kinds = 0;
    for (const auto& cause : cost.at("factorizations_by_cause").items())
      causes += cause.value().get<std::uint64_t>();
    EXPECT_EQ(causes, count(record, "factorizations"));
    EXPECT_EQ(count(record, "jacobians"), causes - start_factorizations(record));
    // Every iteration evaluates the forces once; the start does so, too.
    EXPECT_GT(count(record, "residuals"), count(record, "newton_iterations"));
    const bool in_double = record.at("precision") == "double";
    EXPECT_EQ(cost.contains("flops"), in_double);
    EXPECT_EQ(cost.contains("flops_by_kind"), in_double);
    if (!in_double) continue;
    for (const auto& kind : cost.at("flops_by_kind").items()) kinds += kind.value().get<std::uint64_t>();
    EXPECT_EQ(kinds, count(record, "flops"));
    // A 3 x 3 back-substitution alone takes 15.
    EXPECT_GT(count(record, "flops"), 15 * count(record, "solves"));
  }
}

TEST_F(AuditTest, TheStartIsPartOfTheCost) {
  const auto own = run(R"([{"name": "bliedf2nd", "k": 3, "modified_start": false}])",
                       R"("step_sizes": [1e-3], "t_end": 0.2, "start": "self")");
  const auto given = run(R"([{"name": "bliedf2nd", "k": 3, "modified_start": false}])", from_reference);
  for (std::size_t i = 0; i < own.size(); ++i) {
    EXPECT_EQ(count(given[i], "tangent_inverse"), 0u);
    EXPECT_EQ(count(own[i], "tangent_inverse"),
              6u * 3u);  // stages but the first, steps to the points t_1, t_2, t_3
    EXPECT_GT(count(own[i], "flops"), count(given[i], "flops"));
  }
}

// The explicit correction of k = 6 is unstable at this step size where a constraint fixes the increments.
TEST_F(AuditTest, AFailedRunHasItsCountsUpToTheFailure) {
  int failed = 0;
  for (const Json& record : run(R"([{"name": "bliedf2nd", "k": 6, "form": "index3"}])",
                                R"("step_sizes": [2e-3], "t_end": 2.0, "start": "reference")")) {
    if (record.at("outcome") == "ok") continue;
    ++failed;
    const auto step = record.at("failure").at("step").get<std::uint64_t>();
    ASSERT_GT(step, 6u);
    EXPECT_LT(step, record.at("steps").get<std::uint64_t>());
    // Each step that was taken or tried takes an iteration at least, and each has its correction: four commutators.
    EXPECT_GE(count(record, "newton_iterations"), step - 5);
    EXPECT_EQ(count(record, "commutators"), 4 * (step - 5));
    EXPECT_GT(count(record, "flops"), 0u);
  }
  EXPECT_GT(failed, 0);
}

// --- scenes ------------------------------------------------------------------------------------------------

class SceneAuditTest : public AuditTest {
 protected:
  // A rod on a joint, and a bead on a string from its end: two bodies, of which one rotates.
  std::vector<Json> run_beads(const std::string& integrators, const std::string& rest) {
    folder_.write("beads.json",
                  R"({"name": "beads", "bodies": [
      {"name": "rod", "mass": 1, "shape": {"type": "rod", "length": 1, "width": 0.1}, "position": [0.5, 0, 0]},
      {"name": "bead", "mass": 0.5, "formulation": "R3", "position": [1, 0, -1]}],
    "joints": [{"type": "spherical", "bodies": ["ground", "rod"], "point": [0, 0, 0]},
               {"type": "distance", "bodies": ["rod", "bead"], "points": [[0.5, 0, 0], [0, 0, 0]]}],
    "effects": [{"type": "uniform_gravity", "acceleration": [0, 0, -9.81]}]})");
    return run_problem(R"({"scene": ")" + (folder_.path() / "beads.json").string() + R"("})", integrators,
                       rest);
  }
  static constexpr std::uint64_t bodies = 2, rotating = 1;

 private:
  TemporaryFolder folder_;
};

const std::string in_both_precisions =
    R"("step_sizes": [1e-3], "t_end": 0.1, "start": "reference", "precision": ["double", "extended"])";

// As those of the heavy top above, body by body; the reference beside the run is no part of it.
TEST_F(SceneAuditTest, CountsBodyByBodyAndNoCommutatorOfAPointMass) {
  const auto records = run_beads(R"([{"name": "bliedf2nd", "k": [3, 4]}])", in_both_precisions);
  ASSERT_EQ(records.size(), 4u);
  for (const Json& record : records) {
    EXPECT_EQ(record.at("outcome"), "ok");
    EXPECT_EQ(count(record, "residuals"), count(record, "newton_iterations")) << record;
    EXPECT_EQ(count(record, "commutators"), rotating * own_steps(record)) << record;
    EXPECT_EQ(count(record, "log"), bodies * (record.at("options").at("k").get<std::uint64_t>() - 1));
    EXPECT_EQ(count(record, "exp"), bodies * evaluations(record)) << record;
    EXPECT_EQ(count(record, "tangent_inverse"), 0u);
  }
}

// The linear part of a run in extended precision is in double, and counts as it does in a run in double.
TEST_F(SceneAuditTest, TangentOperatorsOfNewtonMatricesCountInEveryPrecision) {
  for (const Json& record : run_beads(R"([{"name": "bliedf2nd", "k": [2, 3]}])", in_both_precisions)) {
    EXPECT_GT(count(record, "jacobians"), 0u);
    EXPECT_EQ(count(record, "tangent"), bodies * count(record, "jacobians")) << record;
  }
  for (const Json& record :
       run_beads(R"([{"name": "faltinsen_bdf", "k": 3, "variant": ["exact", "bch"]}])", in_both_precisions)) {
    const bool exact = record.at("options").at("variant") == "exact";
    const std::uint64_t matrices = count(record, "jacobians");
    // T once in each evaluation, and in each matrix.
    EXPECT_EQ(count(record, "tangent"), bodies * (matrices + (exact ? evaluations(record) : 0))) << record;
    // In a matrix ad(s), and one for each term of the series of T: two, for increments are small, of which "bch" has the first.
    EXPECT_EQ(count(record, "commutators"),
              rotating * (exact ? 3 * matrices : own_steps(record) + evaluations(record) + 2 * matrices))
        << record;
  }
}

// Of n unknowns: a dense factorization divides n (n + 1) / 2 times, KLU counts n of them.
TEST_F(AuditTest, ASceneSaysWhatFactorizedItsNewtonMatrices) {
  const std::string crank = R"({"scene": ")" LIEBENCH_SOURCE_DIR R"(/problems/scenes/slider_crank.json"})";
  // 18 velocities and 17 constraints; twice as many unknowns in the stabilized form.
  const auto records =
      run_problem(crank, R"([{"name": "bliedf2nd", "form": ["index3", "stabilized_index2"]}])",
                  R"("step_sizes": [1e-3], "t_end": 0.05, "precision": ["double", "extended"])");
  ASSERT_EQ(records.size(), 4u);
  for (const Json& record : records) {
    const bool large = record.at("options").at("form") == "stabilized_index2";
    EXPECT_EQ(record.at("solver"), large ? "klu" : "dense_lu") << record;
    if (record.at("precision") == "extended") continue;
    const auto divisions = record.at("cost").at("flops_by_kind").at("divide").get<std::uint64_t>();
    const std::uint64_t n = large ? 70 : 35;
    EXPECT_EQ(divisions >= count(record, "factorizations") * n * (n + 1) / 2, !large) << record;
  }
  for (const Json& record : run(R"([{"name": "bliedf2nd"}])", from_reference))
    EXPECT_FALSE(record.contains("solver")) << "a matrix of fixed size";
}

}  // namespace
}  // namespace liebench
