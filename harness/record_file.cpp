#include "harness/record_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <set>
#include <sstream>

#include "harness/errors.h"
#include "harness/record.h"

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

}  // namespace

void write_whole(const std::filesystem::path& file, std::string_view text) {
  const std::filesystem::path temporary = file.string() + fmt::format(".{}.tmp", ::getpid());
  const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor < 0) fail(file, "cannot write");
  try {
    write_all(descriptor, text, file);
    if (::fsync(descriptor) != 0 && errno != EINVAL) fail(file, "cannot write");
  } catch (...) {
    ::close(descriptor);
    ::unlink(temporary.c_str());
    throw;
  }
  ::close(descriptor);
  if (::rename(temporary.c_str(), file.c_str()) != 0) {
    const int error = errno;
    ::unlink(temporary.c_str());
    errno = error;
    fail(file, "cannot write");
  }
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

RecordFile::RecordFile(std::filesystem::path file) : file_(std::move(file)) {
  descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (descriptor_ < 0) fail(file_, "cannot write");
  // Two processes on one file would run the same rows twice.
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0)
    throw MachineError(fmt::format("{}: another liebench is writing this file", file_.string()));
  std::ifstream stream(file_, std::ios::binary);
  std::ostringstream content;
  content << stream.rdbuf();
  const std::string text = content.str();
  std::size_t begin = 0, number = 0;
  while (begin < text.size()) {
    ++number;
    const std::size_t end = text.find('\n', begin);
    if (end == std::string::npos) {
      fmt::print(stderr, "{}:{}: a torn line of {} bytes is dropped; its run is done again\n", file_.string(),
                 number, text.size() - begin);
      if (::ftruncate(descriptor_, off_t(begin)) != 0) fail(file_, "cannot write");
      break;
    }
    const std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    if (line.empty()) continue;
    const std::string place = fmt::format("{}:{}", file_.string(), number);
    const Json record = parse_json(line, place);
    if (!record.is_object() || !record.contains("key") || !record["key"].is_string())
      throw InputError(place, "is not a record of liebench; name another file by --out");
    const auto key = record["key"].get<std::string>();
    if (lines_.emplace(key, line).second) sequence_.push_back(key);
  }
}

RecordFile::~RecordFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void RecordFile::append(const Json& record) {
  const std::string line = record.dump();
  const auto key = record.at("key").get<std::string>();
  write_all(descriptor_, line + '\n', file_);
  if (lines_.emplace(key, line).second) sequence_.push_back(key);
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
  write_whole(file_, text);
}

}  // namespace liebench
