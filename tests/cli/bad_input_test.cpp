#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/cli/program_test.h"

// What the program does with input it cannot use: exit status 2 for the user's mistake and 3 for the machine's,
// one clear message on standard error, nothing on standard output and nothing on the disk. That every mistake
// in a study is found where it is, tests/harness/study_test.cpp says.

namespace liebench {
namespace {

namespace fs = std::filesystem;

class BadInput : public ProgramTest {
 protected:
  // Runs the program, expects the refusal, and that the folder is as it was.
  void expect_refusal(int status, std::vector<std::string> arguments, const std::vector<std::string>& says) {
    ProgramCall refused = call(std::move(arguments));
    for (const auto& [name, value] : environment) refused.environment[name] = value;
    const auto before = folder.entries();
    const ProgramResult result = run_program(refused);
    std::string line;
    for (const std::string& argument : refused.arguments) line += argument + ' ';
    EXPECT_EQ(result.status, status) << line << "\n" << result.err;
    EXPECT_EQ(result.out, "") << line;
    for (const std::string& part : says)
      EXPECT_TRUE(contains(result.err, part))
          << line << "\nnot found: " << part << "\nmessage: " << result.err;
    EXPECT_FALSE(contains(result.err, "exception")) << line << "\n" << result.err;
    EXPECT_EQ(folder.entries(), before) << line << "\nwrote something";
  }

  // The refusal of small_study() with one change.
  void expect_study_refused(const std::string& pointer, const std::string& value,
                            const std::vector<std::string>& says) {
    Json study = small_study();
    study[Json::json_pointer(pointer)] = parse_json(value, "value");
    write_study(study);
    expect_refusal(2, {"run", "study.json", "--out", "out.jsonl"}, says);
    expect_refusal(2, {"run", "study.json"}, says);
  }

  std::map<std::string, std::string> environment;
};

TEST_F(BadInput, AStudyThatCannotBeRunIsRefusedWithItsPlace) {
  expect_study_refused(
      "/integrators/0/name", "\"bliedf2\"",
      {"liebench: /integrators/0/name: unknown integrator \"bliedf2\"", "did you mean \"bliedf2nd\"?"});
  expect_study_refused("/integrators/0/k", "7", {"/integrators/0/k: 7", "an integer from 1 to 6"});
  expect_study_refused("/integrators/0/k", "2.5", {"/integrators/0/k: 2.5", "an integer from 1 to 6"});
  expect_study_refused("/step_sizes/1", "-0.001", {"/step_sizes/1: -0.001", "a positive step size"});
  expect_study_refused("/step_sizes/1", "0", {"/step_sizes/1: 0", "a positive step size"});
  expect_study_refused("/t_end", "-1", {"/t_end: -1", "after t_0 = 0"});
  expect_study_refused("/problems/0/parameters", R"({"inertia": [1, -1, 1]})",
                       {"/problems/0/parameters/inertia: [1,-1,1]", "positive definite"});
  expect_study_refused("/problems/0/parameters", R"({"mass": null})",
                       {"/problems/0/parameters/mass: null", "a positive number"});
  expect_study_refused("/problems/0/parameters", R"({"orientation": [0, 0, 0, 0]})",
                       {"/problems/0/parameters/orientation", "not all zero"});
  expect_study_refused("/step_size", "1", {"/step_size: unknown key", "did you mean \"step_sizes\"?"});
  expect_study_refused("/steps", "1", {"/steps", "not both"});
  expect_study_refused("/step_sizes/0", "1e-15", {"/step_sizes/0: 1e-15", "at most 1e+09"});
}

TEST_F(BadInput, AFileThatIsNotJsonIsRefusedWithLineAndColumn) {
  folder.write("study.json", "{\n  \"name\": \"x\",\n  \"t_end\": NaN\n}\n");
  expect_refusal(2, {"run", "study.json", "--out", "out.jsonl"},
                 {"study.json: not valid JSON", "line 3, column 1"});
  folder.write("study.json", small_study().dump().substr(0, 100));
  expect_refusal(2, {"run", "study.json", "--out", "out.jsonl"},
                 {"study.json: not valid JSON", "line 1, column 101"});
  folder.write("study.json", "{\"t_end\": 1e999}");
  expect_refusal(2, {"run", "study.json", "--out", "out.jsonl"}, {"study.json: ", "1e999"});
  folder.write("study.json", std::string(1000000, '['));
  expect_refusal(2, {"run", "study.json", "--out", "out.jsonl"},
                 {"study.json: ", "nested deeper than 64 levels"});
}

TEST_F(BadInput, AnEmptyFileIsRefusedForWhatItIs) {
  folder.write("study.json", "");
  expect_refusal(2, {"run", "study.json", "--out", "out.jsonl"}, {"study.json: not valid JSON"});
}

TEST_F(BadInput, AFileThatCannotBeAStudyIsRefusedByItsName) {
  expect_refusal(2, {"run", "absent.json", "--out", "out.jsonl"}, {"absent.json", "cannot be read"});
  expect_refusal(2, {"run", ".", "--out", "out.jsonl"}, {"cannot be read"});
  folder.write("large.json", "");
  fs::resize_file(folder / "large.json", 17u << 20);
  expect_refusal(2, {"run", "large.json", "--out", "out.jsonl"},
                 {"large.json", "17825792 bytes", "16777216"});
}

TEST_F(BadInput, WhatNoReferenceCanBeMadeForIsTheUsersMistake) {
  Json study = small_study();
  study["problems"][0]["parameters"]["mass"] = 1e300;
  write_study(study);
  expect_refusal(2, {"run", "study.json", "--out", "out.jsonl"}, {"mass"});
}

TEST_F(BadInput, AnOptionThatCannotBeIsRefusedByItsName) {
  write_study(small_study());
  for (const char* shard : {"3/2", "0/2", "1/0", "x", "2", "1/2x", "-1/2", "1/-2", "1.5/2", "", "1/2/3",
                            "99999999999999999999999/2"})
    expect_refusal(2, {"run", "study.json", "--out", "out.jsonl", "--shard", shard},
                   {"--shard", std::string("\"") + shard + "\"", "I/N"});
  for (const char* jobs : {"0", "-1", "x", "1.5", "100000"})
    expect_refusal(2, {"run", "study.json", "--out", "out.jsonl", "--jobs", jobs},
                   {"--jobs", jobs, "1 to 1024"});
  expect_refusal(2, {"run"}, {"study"});
  expect_refusal(2, {"run", "study.json", "--sharrd", "1/2"}, {"--sharrd"});
  expect_refusal(2, {"table", "study.json", "--kind", "order"}, {"--kind", "order", "orders", "outcomes"});
  expect_refusal(2, {"table", "study.json", "--format", "html"},
                 {"--format", "html", "markdown", "latex", "csv"});
  expect_refusal(2, {"plot", "study.json", "--y", "w", "--out", "x.svg"}, {"--y", "w", "lambda"});
  expect_refusal(2, {"plot", "study.json"}, {"--out"});
  expect_refusal(2, {"plot", "study.json", "--out", "x.gif"}, {"--out", "x.gif", ".svg", ".pdf", ".png"});
  expect_refusal(2, {"list", "problms"}, {"problms", "problems", "integrators"});
  expect_refusal(2, {"describe", "bliedf2"}, {"\"bliedf2\"", "\"heavy_top\"", "did you mean \"bliedf2nd\"?"});
  expect_refusal(2, {"figures", "--only", "figure9"},
                 {"--only", "\"figure9\"", "\"figure1\"", "\"figure4\""});
  expect_refusal(2, {"figures", "--only", "figure2,figur3"},
                 {"--only", "\"figur3\"", "did you mean \"figure3\"?"});
}

TEST_F(BadInput, ACommandThatIsNotThereIsRefusedByItsName) {
  expect_refusal(2, {}, {"subcommand"});
  expect_refusal(2, {"simulat"}, {"simulat"});
  expect_refusal(2, {"rum", "study.json"}, {"rum"});
}

TEST_F(BadInput, AForeignFileIsNoFileOfRecords) {
  const std::string study = small_study().dump();
  const std::string good = [&] {
    write_study(small_study(), "good.json");
    return run({"run", "good.json"}).out;
  }();
  ASSERT_EQ(lines_of(good).size(), 4u);
  const std::string torn = good.substr(0, good.size() - 20);
  const std::vector<std::pair<std::string, std::string>> foreign{
      {study + "\n", ":1"},
      {"{\n \"name\": 1\n}\n", ":1"},
      {good + study + "\n", ":5"},
      {good + "text\n", ":5"},
      {"{\"schema\": 1, \"key\": \"x\"}\n", ":1"},
      {"{\"schema\": 7, \"key\": \"0123456789abcdef0123456789abcdef\"}\n", ":1"}};
  for (const auto& [text, line] : foreign) {
    folder.write("foreign.jsonl", text);
    expect_refusal(2, {"table", "foreign.jsonl"}, {"foreign.jsonl" + line});
    expect_refusal(2, {"table", "foreign.jsonl", "--kind", "outcomes", "--out", "t.md"},
                   {"foreign.jsonl" + line});
    expect_refusal(2, {"plot", "foreign.jsonl", "--out", "x.svg"}, {"foreign.jsonl" + line});
  }
  folder.write("foreign.jsonl", torn);
  expect_refusal(2, {"table", "foreign.jsonl"}, {"foreign.jsonl:4"});
  expect_refusal(2, {"table", "absent.jsonl"}, {"absent.jsonl", "cannot be read"});
}

TEST_F(BadInput, AnEmptyFileHoldsNoRecords) {
  folder.write("empty.jsonl", "");
  expect_refusal(2, {"table", "empty.jsonl"}, {"empty.jsonl", "no records"});
  expect_refusal(2, {"plot", "empty.jsonl", "--out", "x.svg"}, {"empty.jsonl", "no records"});
}

TEST_F(BadInput, RecordsAreNotWrittenOverAForeignFile) {
  write_study(small_study());
  const std::string study_in_one_line = small_study().dump();
  for (const std::string& text : {std::string("{\n  \"mine\": 1\n}\n"), std::string("years of notes\n"),
                                  std::string("years of notes without an end"), study_in_one_line,
                                  std::string("{\"schema\": 1, \"key\": \"x\"}\n")}) {
    folder.write("mine", text);
    expect_refusal(2, {"run", "study.json", "--out", "mine"}, {"mine:1"});
    EXPECT_TRUE(read_text(folder / "mine") == text) << "overwritten: " << text;
  }
  folder.write("self.json", study_in_one_line);
  expect_refusal(2, {"run", "self.json", "--out", "self.json"}, {"self.json"});
  EXPECT_EQ(read_text(folder / "self.json"), study_in_one_line) << "the study was written over";
}

TEST_F(BadInput, AFolderThatCannotBeWrittenIsTheMachinesFault) {
  write_study(small_study());
  folder.write("plain", "");
  expect_refusal(3, {"run", "study.json", "--out", "absent/out.jsonl"}, {"absent/out.jsonl", "No such file"});
  expect_refusal(3, {"run", "study.json", "--out", "plain/out.jsonl"},
                 {"plain/out.jsonl", "Not a directory"});
  expect_refusal(3, {"run", "study.json", "--out", "."}, {".", "directory"});
  expect_refusal(3, {"figures", "--short", "--only", "figure2", "--out", "plain/figures"}, {"plain/figures"});
  expect_refusal(3, {"figures", "--short", "--only", "figure2", "--out", "plain"}, {"plain"});
  folder.write("runs.jsonl", run({"run", "study.json"}).out);
  expect_refusal(3, {"table", "runs.jsonl", "--out", "absent/t.md"}, {"absent/t.md"});
  expect_refusal(3, {"plot", "runs.jsonl", "--out", "absent/x.svg"}, {"absent/x.svg"});
}

TEST_F(BadInput, AFolderWithoutPermissionIsTheMachinesFault) {
  if (::geteuid() == 0) GTEST_SKIP() << "to root every folder is writable";
  write_study(small_study());
  fs::create_directory(folder / "locked");
  fs::permissions(folder / "locked", fs::perms::owner_read | fs::perms::owner_exec);
  expect_refusal(3, {"run", "study.json", "--out", "locked/out.jsonl"},
                 {"locked/out.jsonl", "Permission denied"});
  expect_refusal(3, {"figures", "--short", "--only", "figure2", "--out", "locked"},
                 {"locked", "Permission denied"});
  fs::permissions(folder / "locked", fs::perms::owner_all);
}

TEST_F(BadInput, AMissingGnuplotIsSaidBeforeAnythingRuns) {
  write_study(small_study());
  folder.write("runs.jsonl", run({"run", "study.json"}).out);
  environment["LIEBENCH_GNUPLOT"] = "/nonexistent";
  expect_refusal(3, {"figures", "--short", "--only", "figure2", "--out", "figures"},
                 {"gnuplot", "/nonexistent", "gnuplot-nox", "LIEBENCH_GNUPLOT"});
  expect_refusal(3, {"plot", "runs.jsonl", "--out", "x.svg"}, {"gnuplot", "/nonexistent", "gnuplot-nox"});
}

TEST_F(BadInput, AGnuplotThatFailsLeavesNoPicture) {
  write_study(small_study());
  folder.write("runs.jsonl", run({"run", "study.json"}).out);
  environment["LIEBENCH_GNUPLOT"] = "/bin/false";
  expect_refusal(3, {"plot", "runs.jsonl", "--out", "x.svg"}, {"gnuplot"});
}

TEST_F(BadInput, ResultsThatNobodyCanReadAreNoSuccess) {
  // Standard output on a full disk.
  if (!std::ofstream("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  write_study(small_study());
  folder.write("runs.jsonl", run({"run", "study.json"}).out);
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"run", "study.json"}, {"table", "runs.jsonl"}, {"list", "problems"}, {"describe", "heavy_top"}}) {
    ProgramCall full = call(arguments);
    full.output = "/dev/full";
    const ProgramResult result = run_program(full);
    EXPECT_EQ(result.status, 3) << arguments[0] << ": " << result.err;
    EXPECT_TRUE(contains(result.err, "No space left") || contains(result.err, "cannot write"))
        << arguments[0];
  }
}

}  // namespace
}  // namespace liebench
