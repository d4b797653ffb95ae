#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <thread>

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

// Ended runs of a figure's job that was killed; again where it was faster than the one who kills.
std::string kill_half_way(const ProgramCall& call, const std::filesystem::path& part) {
  for (int attempt = 0; attempt < 10; ++attempt) {
    std::string left;
    RunningProgram running(call);
    for (int i = 0; i < 15000 && lines_of(left).size() < 20; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      try {
        if (std::filesystem::exists(part)) left = read_text(part);
      } catch (const std::runtime_error&) {
        break;  // it has ended in this moment
      }
    }
    running.kill();
    running.wait();
    if (std::filesystem::exists(part)) return read_text(part);
    std::filesystem::remove_all(part.parent_path());
  }
  return "";
}

TEST_F(FiguresTest, AKilledJobGoesOnWhereItStopped) {
  ProgramCall job = call({"figures", "--short", "--only", "figure2", "--jobs", "1", "--out", "out"});
  job.time_limit = std::chrono::minutes(5);
  const std::filesystem::path part = folder / "out/figure2.unfinished.jsonl";
  const std::string left = kill_half_way(job, part);
  const std::size_t ended = lines_of(left).size();
  ASSERT_GE(ended, 20u);
  EXPECT_FALSE(std::filesystem::exists(folder / "out/figure2.jsonl"));
  const ProgramResult result = run_program(job);
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(
      contains(result.err, "figures: goes on where it was stopped, " + std::to_string(ended) + " of "))
      << result.err;
  EXPECT_FALSE(std::filesystem::exists(part));
  const auto lines = lines_of(read_text(folder / "out/figure2.jsonl"));
  EXPECT_GT(lines.size(), ended) << "nothing was left to do";
  for (const std::string& line : lines_of(left))
    EXPECT_EQ(std::count(lines.begin(), lines.end(), line), 1) << "a run that had ended was done again";

  const ProgramResult again = run_program(job);
  EXPECT_EQ(again.err, "") << "a job that ended begins anew";
}

// Figures of two programs would be mixed.
TEST_F(FiguresTest, RecordsOfAnotherProgramAreNoPartOfAKilledJob) {
  ProgramCall job = call({"figures", "--short", "--only", "figure2", "--jobs", "1", "--out", "out"});
  job.time_limit = std::chrono::minutes(5);
  const std::filesystem::path part = folder / "out/figure2.unfinished.jsonl";
  std::string other = kill_half_way(job, part);
  ASSERT_FALSE(other.empty());
  const std::string commit = "\"commit\":\"";
  for (std::size_t at = other.find(commit); at != std::string::npos; at = other.find(commit, at + 1))
    other.insert(at + commit.size(), "not-");
  folder.write("out/figure2.unfinished.jsonl", other);
  const ProgramResult result = run_program(job);
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.err, "");
  EXPECT_FALSE(contains(read_text(folder / "out/figure2.jsonl"), "not-"));
  EXPECT_FALSE(std::filesystem::exists(part));
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
  EXPECT_TRUE(contains(verdict, "**3732 of 3732 claims confirmed.**")) << verdict.substr(0, 2000);
  // Reductions are entries, too.
  EXPECT_TRUE(contains(read_text(folder / "out/verification.csv"),
                       "\"BLieDF2nd, k = 2\",index 3,reference,maximum error "
                       "of lambda in N,1,"));
}

}  // namespace
}  // namespace liebench
