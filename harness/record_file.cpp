#include "harness/record_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <set>
#include <utility>

#include "harness/errors.h"

namespace liebench {

namespace {

[[noreturn]] void fail(const std::filesystem::path& file, std::string_view what) {
  throw MachineError(fmt::format("{}: {}: {}", file.string(), what, std::strerror(errno)));
}

void write_all(int descriptor, std::string_view text, const std::filesystem::path& file) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      fail(file, "cannot write");
    }
    text.remove_prefix(std::size_t(written));
  }
}

std::filesystem::path temporary_name(const std::filesystem::path& file) {
  return file.string() + fmt::format(".{}.tmp", ::getpid());
}

// Writes the text into the open temporary file, flushes it to the disk and gives it its name; removes it where that fails.
void replace(int descriptor, const std::filesystem::path& temporary, std::string_view text,
             const std::filesystem::path& file) {
  try {
    write_all(descriptor, text, file);
    if (::fsync(descriptor) != 0 && errno != EINVAL) fail(file, "cannot write");
    if (::rename(temporary.c_str(), file.c_str()) != 0) fail(file, "cannot write");
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
}

bool is_file_of(int descriptor, const std::filesystem::path& file) {
  struct stat opened {
  }, named{};
  return ::fstat(descriptor, &opened) == 0 && ::stat(file.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

// A line that was cut off begins as every record does.
bool begins_like_record(std::string_view text) {
  constexpr std::string_view beginning = R"({"schema":)";
  return text.substr(0, beginning.size()) == beginning.substr(0, text.size());
}

}  // namespace

void write_whole(const std::filesystem::path& file, std::string_view text) {
  const std::filesystem::path temporary = temporary_name(file);
  const FileDescriptor descriptor(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
  if (descriptor.value() < 0) fail(file, "cannot write");
  replace(descriptor.value(), temporary, text, file);
}

void require_writable_folder(const std::filesystem::path& folder) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code)
    throw MachineError(fmt::format("{}: cannot create the folder: {}", folder.string(), code.message()));
  const std::filesystem::path probe = folder / fmt::format(".liebench-{}.tmp", ::getpid());
  const int descriptor = ::open(probe.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (descriptor < 0) fail(folder, "cannot write into the folder");
  ::close(descriptor);
  ::unlink(probe.c_str());
}

FileDescriptor& FileDescriptor::operator=(FileDescriptor&& other) noexcept {
  std::swap(value_, other.value_);
  return *this;
}

FileDescriptor::~FileDescriptor() {
  if (value_ >= 0) ::close(value_);
}

RecordFile::RecordFile(std::filesystem::path file, const LineReader& read) : file_(std::move(file)) {
  std::error_code code;
  // A device would be read without end.
  const auto kind = std::filesystem::status(file_, code).type();
  if (kind != std::filesystem::file_type::not_found && kind != std::filesystem::file_type::regular &&
      kind != std::filesystem::file_type::directory)
    throw InputError(file_.string(), "is not a file; name one by --out");
  do {
    descriptor_ = FileDescriptor(::open(file_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644));
    if (descriptor_.value() < 0) fail(file_, "cannot write");
    // Two processes on one file would run the same rows twice.
    if (::flock(descriptor_.value(), LOCK_EX | LOCK_NB) != 0)
      throw MachineError(fmt::format("{}: another liebench is writing this file", file_.string()));
    // Another one may have put its sorted file in the place of the one opened here before it let go of the lock.
  } while (!is_file_of(descriptor_.value(), file_));
  std::ifstream stream(file_, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(stream), {});
  std::size_t begin = 0, number = 0;
  while (begin < text.size()) {
    ++number;
    const std::size_t end = text.find('\n', begin);
    const std::string place = fmt::format("{}:{}", file_.string(), number);
    if (end == std::string::npos && begins_like_record(text.substr(begin))) {
      fmt::print(stderr, "{}: a torn line of {} bytes is dropped; its run is done again\n", place,
                 text.size() - begin);
      if (::ftruncate(descriptor_.value(), off_t(begin)) != 0) fail(file_, "cannot write");
      break;
    }
    const std::string line = text.substr(begin, end - begin);
    begin = end == std::string::npos ? text.size() : end + 1;
    if (line.empty()) continue;
    const Json record = read(line, place);
    const auto key = record["key"].get<std::string>();
    keep(key, line);
  }
}

// Of two lines of one run the later one holds more: it has been timed.
void RecordFile::keep(const std::string& key, const std::string& line) {
  if (lines_.insert_or_assign(key, line).second) sequence_.push_back(key);
}

Json RecordFile::record(const std::string& key) const {
  return Json::parse(lines_.at(key));
}

void RecordFile::append(const Json& record) {
  const std::string line = record.dump();
  const auto key = record.at("key").get<std::string>();
  const off_t end = ::lseek(descriptor_.value(), 0, SEEK_END);
  try {
    write_all(descriptor_.value(), line + '\n', file_);
  } catch (const MachineError&) {
    // The disk is full, most likely: what did get written of the line goes.
    if (end >= 0 && ::ftruncate(descriptor_.value(), end) != 0) fail(file_, "cannot write");
    throw;
  }
  keep(key, line);
}

void RecordFile::sort(const std::vector<std::string>& keys) {
  std::string text;
  std::set<std::string> written;
  const auto add = [&](const std::string& key) {
    const auto line = lines_.find(key);
    if (line == lines_.end() || !written.insert(key).second) return;
    text += line->second;
    text += '\n';
  };
  for (const std::string& key : keys) add(key);
  for (const std::string& key : sequence_) add(key);
  // The new file is locked before it takes the name of the old one.
  const std::filesystem::path temporary = temporary_name(file_);
  FileDescriptor next(::open(temporary.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0644));
  if (next.value() < 0 || ::flock(next.value(), LOCK_EX | LOCK_NB) != 0) fail(file_, "cannot write");
  replace(next.value(), temporary, text, file_);
  descriptor_ = std::move(next);
}

}  // namespace liebench
