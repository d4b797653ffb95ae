#include "harness/record_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <string>

#include "harness/errors.h"
#include "tests/harness/sample_records.h"
#include "tests/support/run_program.h"

namespace liebench {
namespace {

namespace fs = std::filesystem;

Json record(double step_size) {
  return sample_record({.step_size = step_size}, sample_result(1, 1, 1));
}
std::string key(const Json& record) {
  return record["key"].get<std::string>();
}

class RecordFileTest : public testing::Test {
 protected:
  const Json a = record(0.1), b = record(0.05), c = record(0.02);
  TemporaryFolder folder;
  fs::path path = folder / "runs.jsonl";
};

using WriteWhole = RecordFileTest;

TEST_F(RecordFileTest, ARecordIsInTheFileAsSoonAsItIsAppended) {
  RecordFile file(path);
  EXPECT_FALSE(file.has(key(a)));
  file.append(a);
  EXPECT_TRUE(file.has(key(a)));
  EXPECT_EQ(read_text(path), a.dump() + "\n");
  file.append(b);
  EXPECT_EQ(read_text(path), a.dump() + "\n" + b.dump() + "\n");
}

TEST_F(RecordFileTest, WhatIsThereIsKnownAfterOpeningAgain) {
  RecordFile(path).append(a);
  RecordFile file(path);
  EXPECT_TRUE(file.has(key(a)));
  EXPECT_FALSE(file.has(key(b)));
  file.append(b);
  EXPECT_EQ(read_text(path), a.dump() + "\n" + b.dump() + "\n");
}

TEST_F(RecordFileTest, SortingPutsTheStudyFirstInItsOrderAndLosesNothing) {
  RecordFile file(path);
  for (const Json& each : {a, b, c}) file.append(each);
  file.sort({key(c), "0123", key(a), key(c)});
  EXPECT_EQ(read_text(path), c.dump() + "\n" + a.dump() + "\n" + b.dump() + "\n");
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"runs.jsonl"});
}

TEST_F(RecordFileTest, ATornLastLineIsDropped) {
  for (const std::size_t length : {std::size_t{1}, b.dump().size() / 2, b.dump().size()}) {
    folder.write("runs.jsonl", a.dump() + "\n" + b.dump().substr(0, length));
    testing::internal::CaptureStderr();
    {
      RecordFile file(path);
      EXPECT_TRUE(file.has(key(a)));
      EXPECT_FALSE(file.has(key(b)));
      file.append(c);
    }
    const std::string message = testing::internal::GetCapturedStderr();
    EXPECT_NE(message.find("runs.jsonl:2: a torn line"), std::string::npos) << message;
    EXPECT_EQ(read_text(path), a.dump() + "\n" + c.dump() + "\n");
  }
}

TEST_F(RecordFileTest, ATornOnlyLineIsDropped) {
  folder.write("runs.jsonl", a.dump().substr(0, 40));
  testing::internal::CaptureStderr();
  RecordFile(path).append(b);
  testing::internal::GetCapturedStderr();
  EXPECT_EQ(read_text(path), b.dump() + "\n");
}

TEST_F(RecordFileTest, AForeignFileIsRefusedAndLeftAsItIs) {
  Json newer = a;
  newer["schema"] = 2;
  const std::vector<std::string> foreign{"{\"name\": \"a study\"}\n",
                                         "{\"name\": \"a study in one line without an end\"}",
                                         "{\n  \"name\": \"a study\"\n}\n",
                                         "notes of a year, one line",
                                         "\x89PNG\r\n\x1a\n binary",
                                         a.dump() + "\nnot a record\n" + b.dump() + "\n",
                                         a.dump() + "\n{\"key\": 3}\n",
                                         a.dump() + "\n{\"key\": \"of something else\"}\n",
                                         newer.dump() + "\n"};
  for (std::size_t i = 0; i < foreign.size(); ++i) {
    const fs::path file = folder.write("foreign" + std::to_string(i), foreign[i]);
    testing::internal::CaptureStderr();
    EXPECT_THROW(RecordFile{file}, InputError) << foreign[i].substr(0, 60);
    testing::internal::GetCapturedStderr();
    EXPECT_TRUE(read_text(file) == foreign[i]) << "changed: " << foreign[i].substr(0, 60);
  }
}

TEST_F(RecordFileTest, ARefusedFileIsNotKeptLocked) {
  folder.write("runs.jsonl", "not a record\n");
  EXPECT_THROW(RecordFile{path}, InputError);
  EXPECT_THROW(RecordFile{path}, InputError);  // and not MachineError: "another liebench is writing"
}

TEST_F(RecordFileTest, TheRefusalNamesTheLine) {
  folder.write("runs.jsonl", a.dump() + "\nnot a record\n");
  try {
    RecordFile file(path);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("runs.jsonl:2"), std::string::npos) << error.what();
  }
}

TEST_F(RecordFileTest, OneAtATimeWritesIt) {
  RecordFile first(path);
  first.append(a);
  EXPECT_THROW(RecordFile{path}, MachineError);
  first.append(b);
  EXPECT_EQ(read_text(path), a.dump() + "\n" + b.dump() + "\n");
}

TEST_F(RecordFileTest, TheFileIsFreeAgainAfterItsWriterIsGone) {
  { RecordFile first(path); }
  EXPECT_NO_THROW(RecordFile{path});
}

// sort() puts a new file in the place of the old one.

TEST_F(RecordFileTest, TheLockHoldsAfterSorting) {
  RecordFile first(path);
  first.append(a);
  first.sort({key(a)});
  EXPECT_THROW(RecordFile{path}, MachineError);
}

TEST_F(RecordFileTest, ARecordAppendedAfterSortingIsInTheFile) {
  RecordFile file(path);
  file.append(a);
  file.sort({key(a)});
  file.append(b);
  EXPECT_EQ(lines_of(read_text(path)).size(), 2u);
}

TEST_F(RecordFileTest, WhereNoFileCanBeTheMachineIsToBlame) {
  EXPECT_THROW(RecordFile(folder / "absent" / "runs.jsonl"), MachineError);
  EXPECT_THROW(RecordFile(folder.path()), MachineError);
  folder.write("plain", "");
  EXPECT_THROW(RecordFile(folder / "plain" / "runs.jsonl"), MachineError);
}

TEST_F(WriteWhole, ReplacesTheOldTextAndLeavesNothingBeside) {
  folder.write("text.md", "old and longer than the new");
  write_whole(folder / "text.md", "new");
  EXPECT_EQ(read_text(folder / "text.md"), "new");
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"text.md"});
}

TEST_F(WriteWhole, ThatFailsLeavesTheOldTextAndNothingBeside) {
  EXPECT_THROW(write_whole(folder / "absent" / "text.md", "new"), MachineError);
  fs::create_directory(folder / "taken");  // a folder in the place of the file: the last step, rename, fails
  folder.write("taken/inside", "");
  EXPECT_THROW(write_whole(folder / "taken", "new"), MachineError);
  EXPECT_EQ(folder.entries(), (std::vector<std::string>{"taken", "taken/inside"}));
}

TEST_F(WriteWhole, AFolderIsMadeWithItsParentsOrRefused) {
  require_writable_folder(folder / "a" / "b");
  EXPECT_EQ(folder.entries(), (std::vector<std::string>{"a", "a/b"})) << "a probe is left";
  folder.write("plain", "");
  EXPECT_THROW(require_writable_folder(folder / "plain"), MachineError);
  EXPECT_THROW(require_writable_folder(folder / "plain" / "below"), MachineError);
}

TEST_F(WriteWhole, AFolderWithoutPermissionIsRefused) {
  if (::geteuid() == 0) GTEST_SKIP() << "to root every folder is writable";
  fs::create_directory(folder / "a");
  fs::permissions(folder / "a", fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THROW(require_writable_folder(folder / "a"), MachineError);
  fs::permissions(folder / "a", fs::perms::owner_all);
}

}  // namespace
}  // namespace liebench
