#include <algorithm>

#include "harness/embedded.h"
#include "harness/record_reader.h"
#include "tests/cli/program_test.h"
#include "tests/harness/json_schema.h"

// liebench figures, in the form that takes a second. CI runs all of it.

namespace liebench {
namespace {

using FiguresTest = ProgramTest;

TEST_F(FiguresTest, OneFigureLeavesItsRecordsItsPicturesAndItsVerdictAndNothingElse) {
  const ProgramResult result = run({"figures", "--short", "--only", "figure2", "--out", "out/deep"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(folder.entries(), (std::vector<std::string>{"out", "out/deep", "out/deep/figure2.jsonl",
                                                        "out/deep/figure2.pdf", "out/deep/figure2.png",
                                                        "out/deep/figure2.svg", "out/deep/verification.md"}));
  EXPECT_TRUE(contains(result.out, "out/deep/figure2.svg")) << result.out;
  EXPECT_TRUE(contains(result.out, "out/deep/verification.md")) << result.out;
  EXPECT_EQ(result.err, "");

  const std::filesystem::path out = folder / "out/deep";
  EXPECT_TRUE(read_text(out / "figure2.pdf").starts_with("%PDF-"));
  EXPECT_TRUE(contains(
      read_text(out / "figure2.pdf").substr(std::filesystem::file_size(out / "figure2.pdf") - 16), "%%EOF"));
  EXPECT_TRUE(read_text(out / "figure2.png").starts_with("\x89PNG\r\n\x1a\n"));
  const std::string svg = read_text(out / "figure2.svg");
  EXPECT_TRUE(contains(svg, "<svg")) << svg.substr(0, 100);
  EXPECT_TRUE(contains(svg.substr(svg.size() - 16), "</svg>"));
  const std::string verification = read_text(out / "verification.md");
  EXPECT_TRUE(contains(verification, "short form"));
  EXPECT_TRUE(contains(verification, "Theorem 1"));
  EXPECT_FALSE(contains(verification, "Global errors")) << "figure 4 was not asked for";

  const JsonSchema schema(embedded_file("record.schema.json"));
  const auto lines = lines_of(read_text(out / "figure2.jsonl"));
  EXPECT_EQ(lines.size(), 2u * 6u * 2u * 13u);  // formulations, methods, precisions, step sizes
  for (const std::string& line : lines) ASSERT_EQ(schema.violations(line), "") << line;
}

TEST_F(FiguresTest, TheRecordsOfAFigureAreTablesAndPlotsAsThoseOfAnyStudy) {
  ASSERT_EQ(run({"figures", "--short", "--only", "figure2", "--out", "out"}).status, 0);
  const ProgramResult table = run({"table", "out/figure2.jsonl", "--format", "csv"});
  EXPECT_EQ(table.status, 0) << table.err;
  EXPECT_GT(lines_of(table.out).size(), 24u);
  EXPECT_EQ(run({"plot", "out/figure2.jsonl", "--norm", "end_absolute", "--out", "plot.svg"}).status, 0);
  EXPECT_TRUE(contains(read_text(folder / "plot.svg"), "</svg>"));
}

// The whole matrix of methods, forms and formulations in extended precision: an order that is missing, or one that should
// be reduced and is not, is exit status 1. Some five minutes of one core's time; ten times that under sanitizers, which see the same
// code in smaller runs.
TEST_F(FiguresTest, EveryMethodFormAndFormulationHasTheOrderThatTheoryGivesIt) {
#ifdef LIEBENCH_SANITIZED
  GTEST_SKIP() << "too long under sanitizers";
#endif
  ProgramCall verification = call({"figures", "--only", "verification", "--out", "out"});
  verification.time_limit = std::chrono::minutes(9);
  const ProgramResult result = run_program(verification);
  EXPECT_EQ(result.status, 0) << result.out << result.err;
  const std::string verdict = read_text(folder / "out/verification.md");
  // 19 methods, exact and own start: 2 unconstrained formulations with 4 errors, 5 constrained ones in 2 forms with 6.
  // The rest of the field: 27 methods without constraints, 22 with them.
  EXPECT_TRUE(contains(verdict, "**3460 of 3460 claims confirmed.**")) << verdict.substr(0, 2000);
  // Reductions are entries, too.
  EXPECT_TRUE(contains(read_text(folder / "out/verification.csv"),
                       "\"BLieDF2nd, k = 2\",index 3,reference,maximum error "
                       "of lambda in N,1,"));
}

}  // namespace
}  // namespace liebench
