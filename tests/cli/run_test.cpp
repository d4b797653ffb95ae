#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <random>
#include <set>
#include <thread>

#include "harness/embedded.h"
#include "harness/record_reader.h"
#include "tests/cli/program_test.h"
#include "tests/harness/json_schema.h"

// liebench run: a study in, records out.

namespace liebench {
namespace {

using RunTest = ProgramTest;

std::string without_dates(const std::string& text) {
  std::string result;
  for (Json& record : records_of(text)) {
    record["provenance"].erase("date");
    result += record.dump() + '\n';
  }
  return result;
}

// A longer study: 12 runs of 0.01 to 0.2 s.
Json long_study() {
  Json study = small_study();
  study["precision"] = "extended";
  study["step_sizes"] = parse_json(R"({"from": 1e-3, "to": 1e-5, "per_decade": 2})", "test");
  return study;
}

TEST_F(RunTest, EveryRecordIsValidByTheSchemaFailuresToo) {
  Json study = small_study();
  study["integrators"] = parse_json(
      R"([{"name": "bliedf2nd", "k": [1, 2, 3, 4], "correction": [true, false], "modified_start": [true, false]}])",
      "test");
  study["precision"] = {"double", "extended"};
  study["step_sizes"] = {0.1, 0.05, 0.01, 0.002};
  study["t_end"] = 0.4;
  write_study(study, "global.json");
  study.erase("t_end");
  study["steps"] = 1;
  write_study(study, "local.json");
  const JsonSchema schema(embedded_file("record.schema.json"));
  std::set<std::string> outcomes;
  for (const char* name : {"global.json", "local.json"}) {
    const ProgramResult result = run({"run", name});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto lines = lines_of(result.out);
    // On SO(3) there is no modified start: half as many.
    EXPECT_EQ(lines.size(), (16u + 8u) * 2u * 4u);
    for (const std::string& line : lines) {
      ASSERT_EQ(schema.violations(line), "") << line;
      ASSERT_FALSE(contains(line, "null")) << line;
      const Json record = parse_json(line, "record");
      outcomes.insert(record["outcome"].get<std::string>());
      ASSERT_EQ(record.contains("failure"), record["outcome"] != "ok") << line;
      ASSERT_EQ(record.contains("errors"), record["outcome"] == "ok") << line;
      if (record.contains("errors")) {
        ASSERT_EQ(record["errors"].contains("lambda"), record["formulation"] == "R3xSO3") << line;
      }
      if (record.contains("failure")) {
        ASSERT_LE(record["failure"]["step"], record["steps"]) << line;
        ASSERT_NEAR(record["failure"]["time"].get<double>(),
                    record["failure"]["step"].get<double>() * record["step_size"].get<double>(), 1e-12)
            << line;
      }
    }
  }
  EXPECT_TRUE(outcomes.contains("ok"));
  EXPECT_GE(outcomes.size(), 3u) << "the huge step was to fail in at least two ways";
}

TEST_F(RunTest, WritesJsonLinesAloneToStandardOutputAndTheSummaryToStandardError) {
  write_study(small_study());
  const ProgramResult result = run({"run", "study.json"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(records_of(result.out).size(), 4u);
  EXPECT_EQ(result.out.back(), '\n');
  EXPECT_EQ(result.err, "runs: 4 ok\n");  // no bar: this is no terminal
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"study.json"});
}

TEST_F(RunTest, WritesTheRowsInTheOrderOfTheStudyAndTheSameToAFile) {
  write_study(small_study());
  const ProgramResult result = run({"run", "study.json", "--out", "runs.jsonl"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.out, "");
  const std::string text = read_text(folder / "runs.jsonl");
  std::vector<std::string> rows;
  for (const Json& record : records_of(text))
    rows.push_back(record["formulation"].get<std::string>() + " " + record["step_size"].dump());
  EXPECT_EQ(rows, (std::vector<std::string>{"SO3 0.01", "SO3 0.005", "R3xSO3 0.01", "R3xSO3 0.005"}));
  EXPECT_TRUE(without_dates(run({"run", "study.json"}).out) == without_dates(text));
  EXPECT_EQ(folder.entries(), (std::vector<std::string>{"runs.jsonl", "study.json"}));
}

TEST_F(RunTest, NumericalFailuresAreDataAndSummarised) {
  Json study = small_study();
  study["problems"][0]["formulation"] = "SO3";
  study["step_sizes"] = {0.1, 0.01};
  study["t_end"] = 0.4;
  write_study(study);
  const ProgramResult result = run({"run", "study.json"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.err, "runs: 1 ok, 1 rotation_too_large\n");
}

TEST_F(RunTest, AFailureWithoutAResidualSaysNone) {
  // The rotation is too large before a residual was ever computed: absent, never zero.
  Json study = small_study();
  study["problems"][0]["formulation"] = "SO3";
  study["step_sizes"] = {0.1};
  study["t_end"] = 0.4;
  write_study(study);
  const auto records = records_of(run({"run", "study.json"}).out);
  ASSERT_EQ(records.size(), 1u);
  ASSERT_EQ(records[0]["outcome"], "rotation_too_large");
  EXPECT_FALSE(records[0]["failure"].contains("residual")) << records[0]["failure"];
}

TEST_F(RunTest, FailuresInExtendedPrecisionAreSaidByTheProgramAlone) {
  // The arithmetic below must not write to standard error by itself.
  Json study = small_study();
  study["integrators"][0]["k"] = {1, 2};
  study["precision"] = "extended";
  study["step_sizes"] = {0.5, 0.2, 0.1};
  study["t_end"] = 2.0;
  write_study(study);
  const ProgramResult result = run({"run", "study.json"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(lines_of(result.err).size(), 1u) << result.err;
  EXPECT_TRUE(result.err.starts_with("runs: ")) << result.err;
}

TEST_F(RunTest, WritesTheSameBytesWhateverTheNumberOfJobs) {
  Json study = small_study();
  study["integrators"][0]["k"] = {1, 2, 3, 4};
  study["precision"] = {"double", "extended"};
  study["step_sizes"] = {0.1, 0.01, 0.005};  // 0.1 fails
  study["t_end"] = 0.4;
  write_study(study);
  const std::string one = without_dates(run({"run", "study.json", "--jobs", "1"}).out);
  EXPECT_EQ(lines_of(one).size(), 48u);
  EXPECT_TRUE(without_dates(run({"run", "study.json", "--jobs", "2"}).out) == one);
  run({"run", "study.json", "--jobs", "2", "--out", "two.jsonl"});
  EXPECT_TRUE(without_dates(read_text(folder / "two.jsonl")) == one);
}

TEST_F(RunTest, DoesNotRunAgainWhatIsThere) {
  Json study = small_study();
  study["step_sizes"] = {0.01};
  write_study(study, "half.json");
  write_study(small_study());
  EXPECT_EQ(run({"run", "half.json", "--out", "runs.jsonl"}).err, "runs: 2 ok\n");
  // A mark that a second run would take away.
  std::string text = read_text(folder / "runs.jsonl");
  const std::string marked = "\"date\":\"1999-01-01T00:00:00Z\"";
  for (std::size_t at = 0; (at = text.find("\"date\":\"2", at)) != std::string::npos; at += marked.size())
    text.replace(at, marked.size(), marked);
  folder.write("runs.jsonl", text);

  const ProgramResult result = run({"run", "study.json", "--out", "runs.jsonl"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.err, "runs: 2 ok; 2 already there\n");
  const std::string completed = read_text(folder / "runs.jsonl");
  const auto lines = lines_of(completed);
  ASSERT_EQ(lines.size(), 4u);
  for (const std::string& line : lines_of(text)) EXPECT_EQ(std::count(lines.begin(), lines.end(), line), 1);
  EXPECT_EQ(keys_of(completed), keys_of(run({"run", "study.json"}).out)) << "not in the order of the study";

  EXPECT_EQ(run({"run", "study.json", "--out", "runs.jsonl"}).err, "runs: nothing to run; 4 already there\n");
  EXPECT_TRUE(read_text(folder / "runs.jsonl") == completed);
}

TEST_F(RunTest, KeepsRowsOfOtherStudiesInTheFile) {
  Json other = small_study();
  other["name"] = "other";
  other["integrators"][0]["k"] = 3;
  write_study(other, "other.json");
  write_study(small_study());
  run({"run", "other.json", "--out", "runs.jsonl"});
  const std::string before = read_text(folder / "runs.jsonl");
  EXPECT_EQ(run({"run", "study.json", "--out", "runs.jsonl"}).err, "runs: 4 ok\n");
  const std::string after = read_text(folder / "runs.jsonl");
  EXPECT_EQ(lines_of(after).size(), 8u);
  EXPECT_TRUE(after.ends_with(before));
}

TEST_F(RunTest, DropsATornLastLineAndDoesItAgain) {
  write_study(small_study());
  run({"run", "study.json", "--out", "runs.jsonl"});
  const std::string whole = read_text(folder / "runs.jsonl");
  const std::size_t last = whole.size() - lines_of(whole).back().size() - 1;
  for (const std::size_t size : {last + 1, last + 100, whole.size() - 1}) {
    folder.write("runs.jsonl", whole.substr(0, size));
    const ProgramResult result = run({"run", "study.json", "--out", "runs.jsonl"});
    EXPECT_EQ(result.status, 0);
    EXPECT_TRUE(contains(result.err, "runs.jsonl:4: a torn line")) << result.err;
    EXPECT_TRUE(contains(result.err, "runs: 1 ok; 3 already there\n")) << result.err;
    EXPECT_EQ(keys_of(read_text(folder / "runs.jsonl")), keys_of(whole));
    // Of the row that was run again the errors must be the same; all of it: tests/harness/execute_test.cpp.
    EXPECT_EQ(records_of(read_text(folder / "runs.jsonl"))[3]["errors"], records_of(whole)[3]["errors"]);
    EXPECT_TRUE(read_text(folder / "runs.jsonl").starts_with(whole.substr(0, last)));
  }
}

TEST_F(RunTest, LosesNothingThatHadEndedWhenItIsKilled) {
  write_study(long_study());
  std::string left;
  {
    RunningProgram running(call({"run", "study.json", "--out", "runs.jsonl", "--jobs", "1", "--no-timing"}));
    for (int i = 0; i < 15000 && lines_of(left).size() < 3; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      if (std::filesystem::exists(folder / "runs.jsonl")) left = read_text(folder / "runs.jsonl");
    }
    running.kill();
    running.wait();
  }
  left = read_text(folder / "runs.jsonl");
  ASSERT_GE(lines_of(left).size(), 2u);
  const ProgramResult result = run({"run", "study.json", "--out", "runs.jsonl"});
  EXPECT_EQ(result.status, 0) << result.err;
  const auto lines = lines_of(read_text(folder / "runs.jsonl"));
  EXPECT_EQ(lines.size(), 10u);
  for (const std::string& line : lines_of(left.substr(0, left.rfind('\n') + 1)))
    EXPECT_EQ(std::count(lines.begin(), lines.end(), line), 1) << "a row that had ended was run again";
}

// While runs end, while they are timed, while the file is sorted: every row that was there stays, and none is torn.
TEST_F(RunTest, KilledAtAnyMomentManyTimesItLosesNoRowAndTearsNone) {
  Json study = small_study();
  study["integrators"][0]["k"] = {1, 2, 3};
  write_study(study);
  const std::string whole = run({"run", "study.json"}).out;
  std::mt19937 random(20261125);
  std::uniform_int_distribution<int> milliseconds(0, 150);
  std::set<std::string> seen;
  int kills = 0;
  for (int i = 0; i < 40; ++i) {
    RunningProgram running(call({"run", "study.json", "--out", "runs.jsonl", "--jobs", "2"}));
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds(random)));
    running.kill();
    if (running.wait().signal == SIGKILL) ++kills;
    if (!std::filesystem::exists(folder / "runs.jsonl")) continue;
    const std::string left = read_text(folder / "runs.jsonl");
    EXPECT_TRUE(left.empty() || left.back() == '\n') << "a torn row";
    std::set<std::string> keys;
    for (const std::string& key : keys_of(left)) keys.insert(key);
    EXPECT_TRUE(std::includes(keys.begin(), keys.end(), seen.begin(), seen.end())) << "a row is lost";
    seen = keys;
  }
  EXPECT_GE(kills, 10);
  const ProgramResult result = run_program(call({"run", "study.json", "--out", "runs.jsonl"}));
  EXPECT_EQ(result.status, 0) << result.err;
  const auto records = records_of(read_text(folder / "runs.jsonl")), expected = records_of(whole);
  ASSERT_EQ(records.size(), expected.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    EXPECT_EQ(records[i].at("key"), expected[i].at("key"));
    EXPECT_EQ(records[i].at("errors"), expected[i].at("errors"));
    EXPECT_EQ(records[i].at("cost"), expected[i].at("cost"));
    EXPECT_TRUE(records[i].contains("time"));
  }
  // What was swept aside by a kill is no part of the folder for ever.
  EXPECT_EQ(run({"compare", "runs.jsonl", "runs.jsonl"}).status, 0);
}

TEST_F(RunTest, TimesWhatEndedWellInDoubleOnceAndSaysSo) {
  Json study = small_study();
  study["precision"] = {"double", "extended"};
  study["step_sizes"] = {0.1, 0.01};  // 0.1 fails
  study["t_end"] = 0.4;
  write_study(study);
  ASSERT_EQ(run({"run", "study.json", "--out", "runs.jsonl"}).status, 0);
  for (const Json& record : records_of(read_text(folder / "runs.jsonl")))
    EXPECT_FALSE(record.contains("time"));
  const ProgramCall timing = call({"run", "study.json", "--out", "runs.jsonl"});
  EXPECT_TRUE(contains(run_program(timing).err, "runs: nothing to run; 8 already there\n"));
  const std::string timed = read_text(folder / "runs.jsonl");
  const JsonSchema schema(embedded_file("record.schema.json"));
  for (const std::string& line : lines_of(timed)) {
    ASSERT_EQ(schema.violations(line), "") << line;
    const Json record = parse_json(line, "record");
    EXPECT_EQ(record.contains("time"), record.at("precision") == "double" && record.at("outcome") == "ok");
  }
  run_program(timing);
  EXPECT_TRUE(read_text(folder / "runs.jsonl") == timed) << "timed again";
}

TEST_F(RunTest, LosesNothingWhenTheDiskIsFull) {
  Json study = small_study();
  study["integrators"][0]["k"] = {1, 2, 3};  // 12 rows of 1.7 kB
  write_study(study);
  // The shell lets the program's files grow to 16 blocks of 512 bytes.
  ProgramCall limited = call({"-c", "trap '' XFSZ; ulimit -f 16; exec \"$0\" \"$@\"", LIEBENCH_PROGRAM, "run",
                              "study.json", "--out", "runs.jsonl", "--jobs", "1", "--no-timing"});
  limited.program = "/bin/sh";
  const ProgramResult full = run_program(limited);
  EXPECT_EQ(full.status, 3) << full.err;
  EXPECT_TRUE(contains(full.err, "runs.jsonl: cannot write")) << full.err;
  const std::string left = read_text(folder / "runs.jsonl");
  const auto kept = lines_of(left.substr(0, left.rfind('\n') + 1));
  EXPECT_GE(kept.size(), 3u);
  EXPECT_EQ(folder.entries(), (std::vector<std::string>{"runs.jsonl", "study.json"}));

  EXPECT_EQ(run({"run", "study.json", "--out", "runs.jsonl"}).status, 0);
  const auto lines = lines_of(read_text(folder / "runs.jsonl"));
  EXPECT_EQ(lines.size(), 12u);
  for (const std::string& line : kept) EXPECT_EQ(std::count(lines.begin(), lines.end(), line), 1);
}

TEST_F(RunTest, LeavesAFileAloneThatAnotherProcessIsWriting) {
  write_study(small_study());
  run({"run", "study.json", "--out", "runs.jsonl"});
  const std::string before = read_text(folder / "runs.jsonl");
  Json more = small_study();
  more["step_sizes"] = {0.002};
  write_study(more, "more.json");
  const int other = ::open((folder / "runs.jsonl").c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_GE(other, 0);
  ASSERT_EQ(::flock(other, LOCK_EX), 0);
  const ProgramResult result = run({"run", "more.json", "--out", "runs.jsonl"});
  EXPECT_EQ(result.status, 3);
  EXPECT_TRUE(contains(result.err, "runs.jsonl: another liebench is writing this file")) << result.err;
  EXPECT_TRUE(read_text(folder / "runs.jsonl") == before);
  ::close(other);
  EXPECT_EQ(run({"run", "more.json", "--out", "runs.jsonl"}).status, 0);
}

TEST_F(RunTest, TwoAtOnceOnOneFileDoNotMixTheirRows) {
  write_study(long_study());
  RunningProgram first(call({"run", "study.json", "--out", "runs.jsonl", "--jobs", "1", "--no-timing"}));
  for (int i = 0; i < 15000 && !std::filesystem::exists(folder / "runs.jsonl"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  const ProgramResult second =
      run({"run", "study.json", "--out", "runs.jsonl", "--jobs", "1", "--no-timing"});
  const ProgramResult one = first.wait();
  // Whoever comes second stops, or finds the work done.
  EXPECT_EQ(std::min(one.status, second.status), 0) << one.err << second.err;
  for (const ProgramResult& each : {one, second})
    EXPECT_TRUE(each.status == 0 || (each.status == 3 && contains(each.err, "another liebench"))) << each.err;
  const auto keys = keys_of(read_text(folder / "runs.jsonl"));
  EXPECT_EQ(keys.size(), 10u);
  EXPECT_EQ(std::set<std::string>(keys.begin(), keys.end()).size(), 10u);
}

TEST_F(RunTest, TheShardsOfAStudyAreDisjointAndComplete) {
  Json study = small_study();
  study["integrators"][0]["k"] = {1, 2, 3, 4, 2};
  study["step_sizes"] = {0.01, 0.005, 0.002, 0.004};
  write_study(study);
  const auto whole = keys_of(run({"run", "study.json"}).out);
  ASSERT_EQ(whole.size(), 32u);
  for (const int count : {1, 3, 40}) {
    std::vector<std::string> all;
    for (int i = 1; i <= count; ++i) {
      const ProgramResult part =
          run({"run", "study.json", "--shard", std::to_string(i) + "/" + std::to_string(count)});
      EXPECT_EQ(part.status, 0) << part.err;
      const auto keys = keys_of(part.out);
      EXPECT_NEAR(double(keys.size()), 32.0 / count, 1.0) << "unevenly shared";
      all.insert(all.end(), keys.begin(), keys.end());
    }
    EXPECT_EQ(all.size(), whole.size()) << count;
    EXPECT_EQ(std::set<std::string>(all.begin(), all.end()),
              std::set<std::string>(whole.begin(), whole.end()));
  }
}

TEST_F(RunTest, ShardsIntoOneFileEndAsTheWholeStudyDoes) {
  write_study(small_study());
  for (const char* shard : {"2/3", "3/3", "1/3"})
    EXPECT_EQ(run({"run", "study.json", "--out", "runs.jsonl", "--shard", shard}).status, 0);
  const ProgramResult result = run({"run", "study.json", "--out", "runs.jsonl"});
  EXPECT_EQ(result.err, "runs: nothing to run; 4 already there\n");
  EXPECT_EQ(keys_of(read_text(folder / "runs.jsonl")), keys_of(run({"run", "study.json"}).out));
}

TEST_F(RunTest, ADamagedReferenceIsNoticedAndMadeAgain) {
  write_study(small_study());
  const TemporaryFolder cache;
  ProgramCall with_cache = call({"run", "study.json", "--no-timing"});
  with_cache.environment["LIEBENCH_CACHE"] = cache.path().string();
  const std::string good = without_dates(run_program(with_cache).out);
  const auto files = cache.entries();
  ASSERT_EQ(files.size(), 1u);
  std::string bytes = read_text(cache / files[0]);
  bytes[bytes.size() / 2] = char(bytes[bytes.size() / 2] ^ 0x10);
  cache.write(files[0], bytes);
  const ProgramResult result = run_program(with_cache);
  EXPECT_EQ(result.status, 0);
  EXPECT_TRUE(contains(result.err, files[0])) << result.err;
  EXPECT_TRUE(without_dates(result.out) == good);
  EXPECT_EQ(run_program(with_cache).err, "runs: 4 ok\n") << "the file was not made again";
}

}  // namespace
}  // namespace liebench
