#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace liebench {

/// There is no usable gnuplot; what() says what is missing and how to get it.
class GnuplotMissing : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// gnuplot ran and failed; what() carries its own words.
class GnuplotError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The program that is run: $LIEBENCH_GNUPLOT where it is set and not empty, else `gnuplot`, sought in $PATH.
std::string gnuplot_program();

/// Throws GnuplotMissing unless gnuplot starts, is 5.4 or later and has the terminals svg, pdfcairo and
/// pngcairo. Called before a long computation, so that hours of runs do not end without a picture.
void require_gnuplot();

/// Runs gnuplot on `script` without the user's own settings, in the C locale and UTC, and returns what it
/// wrote to stderr (warnings, print). Throws GnuplotMissing if it cannot be started and GnuplotError if it
/// fails.
std::string run_gnuplot(const std::string& script);

/// A file that appears under its name only when it is whole: written under a temporary name in the folder of
/// `target`, which must exist, and renamed by commit(). Without commit() the destructor removes it, and an
/// older file of that name stays as it was.
class PendingFile {
 public:
  /// Creates the empty temporary file. Throws std::system_error that names `target` if that is not possible.
  explicit PendingFile(const std::filesystem::path& target);
  PendingFile(PendingFile&& other) noexcept;
  PendingFile& operator=(PendingFile&&) = delete;
  ~PendingFile();

  const std::filesystem::path& target() const { return target_; }
  /// Absolute, so that gnuplot never takes it for a pipe ("|...") or a home folder ("~...").
  const std::filesystem::path& temporary() const { return temporary_; }

  /// Throws std::system_error that names the target if the file cannot be renamed.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
};

}  // namespace liebench
