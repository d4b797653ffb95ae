#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/cli/program_test.h"

// The hard cases as their users run them.

namespace liebench {
namespace {

using StabilityCommandTest = ProgramTest;

TEST_F(StabilityCommandTest, WritesRecordsPictureAndTablesAndResumes) {
  const ProgramResult first = run({"stability", "--only", "extreme_arguments", "--out", "out"});
  ASSERT_EQ(first.status, 0) << first.err;
  EXPECT_NE(first.out.find("40 trials, 0 surprises"), std::string::npos) << first.out;
  for (const char* ending : {"jsonl", "svg", "pdf", "png", "md", "csv", "tex"})
    EXPECT_GT(std::filesystem::file_size(folder.path() / "out" / (std::string("stability.") + ending)), 100u)
        << ending;
  const std::string before = read_text(folder.path() / "out/stability.jsonl");
  const ProgramResult second = run({"stability", "--only", "extreme_arguments", "--out", "out"});
  EXPECT_EQ(second.status, 0);
  EXPECT_NE(second.err.find("40 trials were there already"), std::string::npos) << second.err;
  EXPECT_EQ(read_text(folder.path() / "out/stability.jsonl"), before);
}

TEST_F(StabilityCommandTest, AnUnknownCaseIsBadInput) {
  const ProgramResult result = run({"stability", "--only", "stifness"});
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.err.find("did you mean \"stiffness\"?"), std::string::npos) << result.err;
}

TEST_F(StabilityCommandTest, CasesAreListedAndDescribed) {
  const ProgramResult list = run({"list", "stability"});
  ASSERT_EQ(list.status, 0);
  EXPECT_EQ(lines_of(list.out).size(), 12u);
  const ProgramResult one = run({"describe", "stiffness"});
  ASSERT_EQ(one.status, 0);
  EXPECT_NE(one.out.find("Criterion: "), std::string::npos) << one.out;
  EXPECT_NE(one.out.find("1e+12 N m/rad, undamped"), std::string::npos) << one.out;
}

TEST_F(StabilityCommandTest, AFileOfOtherRecordsIsRefused) {
  std::filesystem::create_directory(folder.path() / "out");
  folder.write("out/stability.jsonl", "{\"schema\":1,\"key\":\"a\"}\n");
  const ProgramResult result = run({"stability", "--only", "extreme_arguments", "--out", "out"});
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.err.find("stability.jsonl:1"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace liebench
