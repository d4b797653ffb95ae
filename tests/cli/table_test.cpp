#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/cli/program_test.h"

// Tables and comparisons of records as their users make them.

namespace liebench {
namespace {

class TableTest : public ProgramTest {
 protected:
  void SetUp() override {
    Json study = small_study();
    study["integrators"][0]["k"] = {2, 3};
    study["step_sizes"] = {4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4};
    write_study(study);
    ASSERT_EQ(run({"run", "study.json", "--out", "runs.jsonl"}).status, 0);
  }

  // Writes the records changed, as other.jsonl.
  template <class Change>
  void write_changed(const Change& change) const {
    std::string text;
    auto records = records_of(read_text(folder / "runs.jsonl"));
    for (std::size_t i = 0; i < records.size(); ++i)
      if (change(records[i], i)) text += records[i].dump() + "\n";
    folder.write("other.jsonl", text);
  }
};

TEST_F(TableTest, CostAccuracySaysWhatAnErrorCosts) {
  const ProgramResult result =
      run({"table", "runs.jsonl", "--kind", "cost-accuracy", "--target", "1e-4,1e-6", "--format", "csv"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto lines = lines_of(result.out);
  EXPECT_EQ(lines.size(), 1u + 2u * 4u);  // header; targets times curves
  EXPECT_TRUE(contains(lines[0], "flops")) << lines[0];
  EXPECT_FALSE(contains(lines[0], "time")) << "no run was timed: " << lines[0];
  int cheapest = 0;
  for (const std::string& line : lines) cheapest += contains(line, ",true,") ? 1 : 0;
  EXPECT_EQ(cheapest, 2);
}

TEST_F(TableTest, EveryKindIsATableInEveryFormat) {
  for (const char* kind : {"orders", "outcomes", "costs", "cost-accuracy"})
    for (const char* format : {"markdown", "latex", "csv"}) {
      const ProgramResult result = run({"table", "runs.jsonl", "--kind", kind, "--format", format});
      EXPECT_EQ(result.status, 0) << kind << ' ' << format << ": " << result.err;
      EXPECT_GT(lines_of(result.out).size(), 4u) << kind << ' ' << format;
    }
}

TEST_F(TableTest, LatexCompilesWhereThereIsATex) {
  if (std::system("command -v pdflatex >/dev/null 2>&1") != 0) GTEST_SKIP() << "no pdflatex here";
  std::string text = "\\documentclass{article}\n\\usepackage{booktabs,siunitx,amssymb}\n\\begin{document}\n";
  for (const char* kind : {"orders", "outcomes", "costs", "cost-accuracy"})
    text += run({"table", "runs.jsonl", "--kind", kind, "--format", "latex"}).out;
  folder.write("tables.tex", text + "\\end{document}\n");
  const std::string command = "cd " + folder.path().string() +
                              " && pdflatex -halt-on-error -interaction=batchmode tables.tex >/dev/null";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST_F(TableTest, BadTargetsAndStepSizesAreRefused) {
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"table", "runs.jsonl", "--kind", "cost-accuracy", "--target", "1e-3,-1"},
           {"table", "runs.jsonl", "--kind", "costs", "--step-size", "0.123"},
           {"table", "runs.jsonl", "--kind", "cost-acuracy"},
           {"plot", "runs.jsonl", "--x", "tme", "--out", "a.svg"},
           {"plot", "runs.jsonl", "--kind", "work-precision", "--x", "time", "--out", "a.svg"}}) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.status, 2) << arguments.back();
    EXPECT_NE(result.err, "");
    EXPECT_FALSE(std::filesystem::exists(folder / "a.svg"));
  }
}

TEST_F(TableTest, BadLinesAreNamedAndTheGoodRowsUsedWhenAsked) {
  const std::string good = read_text(folder / "runs.jsonl");
  folder.write("bad.jsonl", good + "{\"schema\":1,\"key\":\"torn\n" + "{\"a\": 1}\n");
  for (const char* command : {"table", "plot"}) {
    std::vector<std::string> arguments{command, "bad.jsonl"};
    if (arguments[0] == "plot") arguments.insert(arguments.end(), {"--out", "a.svg"});
    const ProgramResult refused = run(arguments);
    EXPECT_EQ(refused.status, 2);
    EXPECT_TRUE(contains(refused.err, "bad.jsonl:21")) << refused.err;
    arguments.emplace_back("--skip-bad-lines");
    const ProgramResult used = run(arguments);
    EXPECT_EQ(used.status, 0) << used.err;
    EXPECT_TRUE(contains(used.err, "2 bad lines skipped")) << used.err;
  }
  EXPECT_EQ(run({"table", "bad.jsonl", "--skip-bad-lines"}).out, run({"table", "runs.jsonl"}).out);
}

TEST_F(TableTest, ComparingAFileWithItselfFindsNothing) {
  const ProgramResult result = run({"compare", "runs.jsonl", "runs.jsonl"});
  EXPECT_EQ(result.status, 0);
  EXPECT_TRUE(contains(result.out, "20 rows in both")) << result.out;
}

TEST_F(TableTest, ComparingSaysWhatChangedAndExitsWithOne) {
  const auto expect_change = [&](const char* what) {
    const ProgramResult result = run({"compare", "runs.jsonl", "other.jsonl"});
    EXPECT_EQ(result.status, 1) << result.out;
    EXPECT_TRUE(contains(result.out, what)) << result.out;
  };
  write_changed([](Json& record, std::size_t i) {
    if (i == 3) record["cost"]["exp"] = 1;
    return true;
  });
  expect_change("exp");
  write_changed([](Json& record, std::size_t i) {
    if (i == 3)
      record["errors"]["q"]["end_relative"] = 2 * record["errors"]["q"]["end_relative"].get<double>();
    return true;
  });
  expect_change("q end_relative");
  write_changed([](Json& record, std::size_t i) {
    record["outcome"] = "ok";
    return i != 3;
  });
  expect_change("Missing (1)");
  EXPECT_EQ(run({"compare", "--common", "runs.jsonl", "other.jsonl"}).status, 0);
  // Round-off is no change, nor is another key of the same run.
  write_changed([](Json& record, std::size_t i) {
    record["errors"]["q"]["end_relative"] = record["errors"]["q"]["end_relative"].get<double>() * (1 + 1e-9);
    record["key"] = "k" + std::to_string(i);
    return true;
  });
  EXPECT_EQ(run({"compare", "runs.jsonl", "other.jsonl"}).status, 0);
}

TEST_F(TableTest, ComparingForeignFilesIsRefused) {
  folder.write("foreign.jsonl", "{\"a\": 1}\n");
  EXPECT_EQ(run({"compare", "runs.jsonl", "foreign.jsonl"}).status, 2);
  EXPECT_EQ(run({"compare", "runs.jsonl", "absent.jsonl"}).status, 2);
}

}  // namespace
}  // namespace liebench
