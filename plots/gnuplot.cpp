#include "plots/gnuplot.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

extern char** environ;

namespace liebench {
namespace {

constexpr std::string_view remedy =
    "install it (apt-get install gnuplot-nox) or name the program in LIEBENCH_GNUPLOT";

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

File scratch_file() {
  File file(std::tmpfile());
  if (!file)
    throw std::system_error(errno, std::generic_category(), "cannot make a scratch file for gnuplot");
  return file;
}

std::vector<std::string> child_environment() {
  // LC_ALL keeps the decimal point a point; TZ keeps the zone out of the PDF; the GNU* ones change defaults.
  constexpr std::array<std::string_view, 6> replaced{
      "LC_ALL=", "TZ=", "GNUTERM=", "GNUHELP=", "GNUPLOT_", "GDFONTPATH="};
  std::vector<std::string> result{"LC_ALL=C", "TZ=UTC"};
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view variable = *entry;
    if (std::ranges::none_of(replaced, [&](std::string_view name) { return variable.starts_with(name); })) {
      result.emplace_back(variable);
    }
  }
  return result;
}

std::string content(std::FILE* file) {
  std::rewind(file);
  std::string result;
  std::array<char, 4096> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), file)) {
    result.append(buffer.data(), count);
  }
  while (!result.empty() && std::strchr(" \n\r\t", result.back()) != nullptr) result.pop_back();
  return result;
}

}  // namespace

std::string gnuplot_program() {
  const char* named = std::getenv("LIEBENCH_GNUPLOT");
  return named != nullptr && *named != '\0' ? named : "gnuplot";
}

std::string run_gnuplot(const std::string& script) {
  const std::string program = gnuplot_program();

  // Scratch files in place of pipes: neither side can block the other, however long the script or the
  // complaint.
  const File input = scratch_file();
  const File errors = scratch_file();
  if (std::fwrite(script.data(), 1, script.size(), input.get()) != script.size() ||
      std::fflush(input.get()) != 0) {
    throw std::system_error(errno, std::generic_category(), "cannot write the script for gnuplot");
  }
  std::rewind(input.get());

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(input.get()), STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, fileno(errors.get()), STDERR_FILENO);

  // Not "-": what it reads from its standard input gnuplot reads letter by letter, a system call each.
  std::array<std::string, 3> words{program, "-d", "/dev/stdin"};
  std::array<char*, 4> argv{words[0].data(), words[1].data(), words[2].data(), nullptr};
  std::vector<std::string> environment = child_environment();
  std::vector<char*> envp;
  envp.reserve(environment.size() + 1);
  for (std::string& variable : environment) envp.push_back(variable.data());
  envp.push_back(nullptr);

  pid_t child = 0;
  const int failure = posix_spawnp(&child, program.c_str(), &actions, nullptr, argv.data(), envp.data());
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) {
    throw GnuplotMissing(fmt::format("gnuplot is missing: cannot start '{}' ({}); {}", program,
                                     std::strerror(failure), remedy));
  }

  int status = 0;
  while (waitpid(child, &status, 0) == -1) {
    if (errno != EINTR) throw std::system_error(errno, std::generic_category(), "cannot wait for gnuplot");
  }
  std::string said = content(errors.get());
  if (WIFSIGNALED(status)) {
    throw GnuplotError(
        fmt::format("gnuplot ('{}') was ended by signal {}: {}", program, WTERMSIG(status), said));
  }
  if (WEXITSTATUS(status) != 0) {
    throw GnuplotError(fmt::format("gnuplot ('{}') failed with status {}: {}", program, WEXITSTATUS(status),
                                   said.empty() ? "it gave no reason" : said));
  }
  return said;
}

void require_gnuplot() {
  std::string said;
  try {
    said =
        run_gnuplot("print sprintf('liebench version %.1f terminals %s ', GPVAL_VERSION, GPVAL_TERMINALS)\n");
  } catch (const GnuplotError& error) {
    throw GnuplotMissing(fmt::format("no usable gnuplot: {}; {}", error.what(), remedy));
  }
  double version = 0;
  const std::size_t start = said.find("liebench version ");
  if (start == std::string::npos ||
      std::sscanf(said.c_str() + start, "liebench version %lf", &version) != 1) {
    throw GnuplotMissing(
        fmt::format("no usable gnuplot: '{}' is not gnuplot; {}", gnuplot_program(), remedy));
  }
  // 5.4 is what Debian 12 has and the figures were looked at with.
  if (version < 5.35) {
    throw GnuplotMissing(
        fmt::format("gnuplot {:.1f} is too old, 5.4 or later is needed; {}", version, remedy));
  }
  said += ' ';
  for (const std::string_view terminal : {"svg", "pdfcairo", "pngcairo"}) {
    if (said.find(fmt::format(" {} ", terminal)) == std::string::npos) {
      throw GnuplotMissing(
          fmt::format("'{}' was built without the terminal {}; {}", gnuplot_program(), terminal, remedy));
    }
  }
}

PendingFile::PendingFile(const std::filesystem::path& target) : target_(target) {
  const auto refuse = [&](int error) {
    throw std::system_error(error, std::generic_category(),
                            fmt::format("cannot write '{}'", target.string()));
  };
  if (!target.has_filename()) refuse(EISDIR);
  std::error_code ignored;
  if (std::filesystem::is_directory(target, ignored)) refuse(EISDIR);

  static std::atomic<unsigned> count{0};
  const std::filesystem::path absolute = std::filesystem::absolute(target);
  const std::filesystem::path temporary =
      absolute.parent_path() / fmt::format(".{}.{}.{}.part", absolute.filename().string(), getpid(), count++);
  // Not mkstemp: its mode 0600 would outlive the rename, and a web server could not read the figure.
  const int descriptor = open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor == -1) refuse(errno);
  close(descriptor);
  temporary_ = temporary;
}

PendingFile::PendingFile(PendingFile&& other) noexcept
    : target_(std::exchange(other.target_, {})), temporary_(std::exchange(other.temporary_, {})) {}

PendingFile::~PendingFile() {
  std::error_code ignored;
  if (!temporary_.empty()) std::filesystem::remove(temporary_, ignored);
}

void PendingFile::commit() {
  std::error_code error;
  std::filesystem::rename(temporary_, target_, error);
  if (error) throw std::system_error(error, fmt::format("cannot write '{}'", target_.string()));
  temporary_.clear();
}

}  // namespace liebench
