#include "plots/gnuplot.h"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

namespace liebench {
namespace {

namespace fs = std::filesystem;

/// Sets an environment variable for the length of a test.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* before = getenv(name)) before_ = before;
    setenv(name, value.c_str(), 1);
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;
  ~Variable() {
    if (before_) {
      setenv(name_, before_->c_str(), 1);
    } else {
      unsetenv(name_);
    }
  }

 private:
  const char* name_;
  std::optional<std::string> before_;
};

class Folder : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() /
              (std::string("liebench_gnuplot_") + test->name() + "_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static std::string read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static void write(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }
  std::ptrdiff_t file_count() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }
  /// A shell script in gnuplot's place.
  fs::path impostor(const std::string& script) const {
    const fs::path path = folder_ / "impostor";
    write(path, "#!/bin/sh\n" + script);
    fs::permissions(path, fs::perms::owner_all);
    return path;
  }

  fs::path folder_;
};

template <typename Exception, typename Action>
std::string message_of(Action action) {
  try {
    action();
  } catch (const Exception& error) {
    return error.what();
  }
  ADD_FAILURE() << "no such exception";
  return {};
}

using Gnuplot = Folder;
using PendingFileTest = Folder;

TEST_F(Gnuplot, UsableOneIsAccepted) {
  EXPECT_NO_THROW(require_gnuplot());
}

TEST_F(Gnuplot, MissingOneIsNamedWithItsRemedy) {
  const Variable program("LIEBENCH_GNUPLOT", "/nowhere/gnuplot");
  const std::string message = message_of<GnuplotMissing>([] { require_gnuplot(); });
  EXPECT_NE(message.find("/nowhere/gnuplot"), std::string::npos) << message;
  EXPECT_NE(message.find("apt-get install gnuplot-nox"), std::string::npos) << message;
}

TEST_F(Gnuplot, IsSoughtInPathWhenTheVariableIsEmpty) {
  const Variable program("LIEBENCH_GNUPLOT", "");
  const Variable path("PATH", folder_.string());
  EXPECT_EQ(gnuplot_program(), "gnuplot");
  EXPECT_THROW(run_gnuplot("print 1\n"), GnuplotMissing);
}

TEST_F(Gnuplot, OtherProgramsAreRefused) {
  for (const char* script : {"exit 0\n", "echo nonsense >&2; exit 3\n"}) {
    const Variable program("LIEBENCH_GNUPLOT", impostor(script).string());
    EXPECT_THROW(require_gnuplot(), GnuplotMissing) << script;
  }
}

TEST_F(Gnuplot, OldVersionsAndMissingTerminalsAreRefused) {
  {
    const Variable program(
        "LIEBENCH_GNUPLOT",
        impostor("echo 'liebench version 5.0 terminals svg pdfcairo pngcairo ' >&2\n").string());
    EXPECT_NE(message_of<GnuplotMissing>([] { require_gnuplot(); }).find("too old"), std::string::npos);
  }
  const Variable program("LIEBENCH_GNUPLOT",
                         impostor("echo 'liebench version 5.4 terminals svg png pdfcairo ' >&2\n").string());
  EXPECT_NE(message_of<GnuplotMissing>([] { require_gnuplot(); }).find("pngcairo"), std::string::npos);
}

TEST_F(Gnuplot, FailureCarriesItsWords) {
  const std::string message = message_of<GnuplotError>([] { run_gnuplot("set nonsense\n"); });
  EXPECT_NE(message.find("nrecognized option"), std::string::npos) << message;
}

TEST_F(Gnuplot, EndBySignalIsAFailure) {
  const Variable program("LIEBENCH_GNUPLOT", impostor("kill -9 $$\n").string());
  EXPECT_NE(message_of<GnuplotError>([] { run_gnuplot("\n"); }).find("signal 9"), std::string::npos);
}

TEST_F(Gnuplot, ReturnsWhatItPrints) {
  EXPECT_EQ(run_gnuplot("print 6 * 7\n"), "42");
}

TEST_F(Gnuplot, IgnoresTheUsersLocaleAndSettings) {
  write(folder_ / ".gnuplot", "print 'from the user'\n");
  const Variable home("HOME", folder_.string());
  const Variable locale("LC_ALL", "de_DE.UTF-8");
  EXPECT_EQ(run_gnuplot("print 0.5\n"), "0.5");
}

TEST_F(PendingFileTest, AppearsOnlyWithCommit) {
  const fs::path target = folder_ / "figure.svg";
  PendingFile file(target);
  write(file.temporary(), "whole");
  EXPECT_FALSE(fs::exists(target));
  file.commit();
  EXPECT_EQ(read(target), "whole");
  EXPECT_EQ(file_count(), 1);
}

TEST_F(PendingFileTest, LeavesTheOldFileWhenGivenUp) {
  const fs::path target = folder_ / "figure.svg";
  write(target, "old");
  {
    PendingFile file(target);
    write(file.temporary(), "half");
    const PendingFile moved = std::move(file);
  }
  EXPECT_EQ(read(target), "old");
  EXPECT_EQ(file_count(), 1);
}

TEST_F(PendingFileTest, NamesTheFileThatCannotBeWritten) {
  write(folder_ / "plain", "a file, no folder");
  fs::create_directory(folder_ / "taken.svg");
  for (const fs::path& target :
       {folder_ / "missing" / "figure.svg", folder_ / "plain" / "figure.svg", folder_ / "taken.svg"}) {
    const std::string message = message_of<std::system_error>([&] { const PendingFile file(target); });
    EXPECT_NE(message.find(target.string()), std::string::npos) << message;
  }
}

TEST_F(PendingFileTest, RefusesAFolderWithoutPermission) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
  const std::string message =
      message_of<std::system_error>([&] { const PendingFile file(folder_ / "figure.svg"); });
  fs::permissions(folder_, fs::perms::owner_all);
  EXPECT_NE(message.find("Permission denied"), std::string::npos) << message;
}

}  // namespace
}  // namespace liebench
