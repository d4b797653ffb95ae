#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

// Running the program under test as its user does: arguments in, exit status and both output streams out.

namespace liebench {

// A new folder under the system's temporary folder; it goes with everything in it when the object does.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(std::string_view name) const { return path_ / name; }

  // Writes a file below the folder and returns its path.
  std::filesystem::path write(std::string_view name, std::string_view text) const;

  // Names of all entries, relative to the folder, sorted: "nothing was written" is one comparison.
  std::vector<std::string> entries() const;

 private:
  std::filesystem::path path_;
};

// The bytes of a file. Throws std::runtime_error where it cannot be read.
std::string read_text(const std::filesystem::path& file);

// The lines of a text, each without its end; a last line without an end counts.
std::vector<std::string> lines_of(std::string_view text);

struct ProgramCall {
  std::filesystem::path program;
  std::vector<std::string> arguments{};
  std::filesystem::path folder{};  // working directory; empty: that of the test
  // Added to the environment of the test, from which every LIEBENCH_* is taken out; LC_ALL is C.
  std::map<std::string, std::string> environment{};
  std::string output{};  // standard output goes to this file instead of into ProgramResult
  std::chrono::milliseconds time_limit = std::chrono::seconds(60);
};

struct ProgramResult {
  int status = -1;         // exit status; -1 where the program did not exit by itself
  int signal = 0;          // that ended it, else 0
  bool timed_out = false;  // it was killed because it ran longer than the time limit
  std::string out;         // standard output, bytes
  std::string err;         // standard error, bytes
};

// Starts the program by posix_spawn, with no shell between, waits for its end and returns what it left. Both
// streams are files in memory, so that any amount of output is taken without a deadlock; standard input is
// empty. Throws std::system_error where the program cannot be started.
ProgramResult run_program(const ProgramCall& call);

// The same in two halves, for what happens while it runs. The destructor kills what has not been waited for.
class RunningProgram {
 public:
  explicit RunningProgram(const ProgramCall& call);
  ~RunningProgram();
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  void kill() const;  // SIGKILL: it cannot clean up
  ProgramResult wait();

 private:
  ProgramCall call_;
  pid_t pid_ = -1;
  int out_ = -1;
  int err_ = -1;
};

}  // namespace liebench
