#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/record_parser.h"
#include "harness/strict_json.h"

namespace liebench {

// Writes `text` to `file` whole or not at all: a temporary file beside it, flushed to the disk and renamed.
// Throws MachineError that names the file.
void write_whole(const std::filesystem::path& file, std::string_view text);

// Throws MachineError unless files can be made in the folder, which is created where it is missing.
void require_writable_folder(const std::filesystem::path& folder);

// An open file, closed at the end of its life.
class FileDescriptor {
 public:
  FileDescriptor() = default;
  explicit FileDescriptor(int value) : value_(value) {}
  FileDescriptor(FileDescriptor&& other) noexcept { *this = std::move(other); }
  FileDescriptor& operator=(FileDescriptor&& other) noexcept;
  ~FileDescriptor();
  int value() const { return value_; }

 private:
  int value_ = -1;
};

// Reads one line, a record of some kind; `place` is for the InputError that it throws where the line is none.
using LineReader = std::function<Json(std::string_view line, const std::string& place)>;

// A growing file of records. Each record is appended whole, in one write, when its run ends, so that a run
// that is killed loses nothing that had ended; `sort` then brings the file into the order of the study.
class RecordFile {
 public:
  // Opens or creates the file and reads what is there. A torn last line, left by a machine that failed, is
  // dropped with a message on standard error. Throws InputError where the file holds anything else that is
  // not a record, MachineError where it cannot be written.
  explicit RecordFile(std::filesystem::path file, const LineReader& read = parse_record);

  bool has(const std::string& key) const { return lines_.contains(key); }
  // The record of this key, which is there.
  Json record(const std::string& key) const;
  // Appends a record, or a new version of one that is there.
  void append(const Json& record);
  // Rewrites the file whole: first the records of these keys in this order, then all others in the order they
  // were in.
  void sort(const std::vector<std::string>& keys);

 private:
  void keep(const std::string& key, const std::string& line);

  std::filesystem::path file_;
  FileDescriptor descriptor_;                 // holds the lock
  std::map<std::string, std::string> lines_;  // by key, without the line's end
  std::vector<std::string> sequence_;         // keys in the order of the file
};

}  // namespace liebench
