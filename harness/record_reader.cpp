#include "harness/record_reader.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdio>
#include <exception>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "harness/errors.h"
#include "harness/large_pages.h"
#include "harness/record_file.h"
#include "harness/record_parser.h"

namespace liebench {

namespace {

// A file in memory without a copy of it; what is no file (a pipe) is read.
class Content {
 public:
  explicit Content(const std::filesystem::path& file);
  ~Content() {
    if (mapped_ != MAP_FAILED) ::munmap(mapped_, size_);
  }
  Content(const Content&) = delete;
  Content& operator=(const Content&) = delete;

  std::string_view text() const {
    return mapped_ != MAP_FAILED ? std::string_view(static_cast<const char*>(mapped_), size_) : text_;
  }

 private:
  void* mapped_ = MAP_FAILED;
  std::size_t size_ = 0;
  std::string text_;
};

Content::Content(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::error_code code;
  if (!stream || std::filesystem::is_directory(file, code))
    throw InputError(file.string(), "cannot be read; a file of records (JSON Lines) is expected here");
  const std::uintmax_t size = std::filesystem::file_size(file, code);
  if (!code && size > 0) {
    const FileDescriptor descriptor(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
    if (descriptor.value() >= 0)
      mapped_ =
          ::mmap(nullptr, std::size_t(size), PROT_READ, MAP_PRIVATE | MAP_POPULATE, descriptor.value(), 0);
    size_ = std::size_t(size);
    if (mapped_ != MAP_FAILED) return;
  }
  text_.assign(std::istreambuf_iterator<char>(stream), {});
}

// What was read of a part of a file.
struct Part {
  std::vector<RecordRow> records;
  std::vector<std::size_t> hashes;  // of their keys
  std::vector<InputError> faults;
  std::exception_ptr failure;  // of the machine
};

// Fills a row, which is a new one; `place()` names the line.
template <class Place>
void read_line(RecordParser& parser, std::string_view line, const Place& place, RecordRow& row) {
  if (parser.parse(line, row)) return;
  // What is wrong with it says the parser that all input goes through.
  const std::string plain = parse_record(line, place()).dump();
  row = {};
  if (!parser.parse(plain, row)) throw InputError(place(), "is not a record of liebench");
}

// Lines of a text from `begin` to `end`, which are at the start of lines.
void read_part(RecordParser& parser, std::string_view text, std::size_t begin, std::size_t end,
               const std::string& file, BadLines bad_lines, Part& part) {
  // Lines are of about one length.
  const std::size_t line_size = std::min(end, text.find('\n', begin)) - begin + 1;
  reserve_in_large_pages(part.records, (end - begin) / line_size * 9 / 8 + 16);
  std::size_t lines = 0;
  std::optional<std::size_t> lines_before;  // counted where something is wrong
  const auto place = [&] {
    if (!lines_before)
      lines_before = std::size_t(std::count(text.begin(), text.begin() + std::ptrdiff_t(begin), '\n'));
    return fmt::format("{}:{}", file, *lines_before + lines);
  };
  for (std::string_view rest = text.substr(begin, end - begin); !rest.empty();) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    ++lines;
    if (line.empty()) continue;
    part.records.emplace_back();
    try {
      read_line(parser, line, place, part.records.back());
      part.hashes.push_back(std::hash<std::string>{}(part.records.back().key));
      continue;
    } catch (const InputError& error) {
      part.faults.push_back(error);
      if (bad_lines == BadLines::reject) return;
    } catch (...) {
      part.failure = std::current_exception();
      return;
    }
    part.records.pop_back();
  }
}

// The parts of a file, in the order of its lines.
std::vector<Part> read_parts(const std::filesystem::path& file, BadLines bad_lines, unsigned threads) {
  const Content content(file);
  const std::string_view text = content.text();
  // Several for each thread: one that is held up by another program leaves some to the others.
  if (threads == 0) threads = std::min(8U, std::thread::hardware_concurrency());
  threads = std::max(threads, 1U);
  constexpr std::size_t least_size = 1U << 20U;  // bytes
  const std::size_t count = std::min<std::size_t>(text.size() / least_size + 1, 4 * threads);
  std::vector<std::size_t> begins{0};
  for (std::size_t i = 1; i < count; ++i) {
    const std::size_t end = text.find('\n', std::max(begins.back(), text.size() / count * i));
    if (end == std::string_view::npos) break;
    begins.push_back(end + 1);
  }
  std::vector<Part> parts(begins.size());
  begins.push_back(text.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    RecordParser parser;
    for (std::size_t i = next++; i < parts.size(); i = next++)
      read_part(parser, text, begins[i], begins[i + 1], file.string(), bad_lines, parts[i]);
  };
  {
    std::vector<std::jthread> list;
    for (std::size_t i = 1; i < std::min<std::size_t>(threads, parts.size()); ++i) list.emplace_back(work);
    work();
  }
  return parts;
}

// Where the row of a key stands among rows, by open addressing.
class KeyPlaces {
 public:
  // There will be at most `most` rows.
  KeyPlaces(const std::vector<RecordRow>& rows, std::size_t most)
      : rows_(rows), slots_(std::bit_ceil(2 * most + 1), Slot{}) {}

  // Where the key is not there it gets the place behind the last row.
  std::size_t find_or_add(const std::string& key, std::size_t hash) {
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t i = hash & mask;; i = (i + 1) & mask) {
      Slot& slot = slots_[i];
      if (slot.place == none) {
        slot = {hash, rows_.size()};
        return slot.place;
      }
      if (slot.hash == hash && rows_[slot.place].key == key) return slot.place;
    }
  }

 private:
  static constexpr std::size_t none = std::size_t(-1);
  struct Slot {
    std::size_t hash = 0;
    std::size_t place = none;
  };
  const std::vector<RecordRow>& rows_;
  std::vector<Slot> slots_;
};

}  // namespace

std::vector<RecordRow> read_records(const std::vector<std::filesystem::path>& files, BadLines bad_lines,
                                    unsigned threads) {
  std::vector<Part> parts;
  for (const std::filesystem::path& file : files)
    for (Part& part : read_parts(file, bad_lines, threads)) parts.push_back(std::move(part));
  std::size_t faults = 0, lines = 0;
  constexpr std::size_t named = 20;
  for (const Part& part : parts) {
    if (part.failure) std::rethrow_exception(part.failure);
    for (const InputError& fault : part.faults) {
      if (bad_lines == BadLines::reject) throw InputError(fault);
      if (faults++ < named) fmt::print(stderr, "{}\n", fault.what());
    }
    lines += part.records.size();
  }
  std::vector<RecordRow> records;
  reserve_in_large_pages(records, lines);
  KeyPlaces places(records, lines);
  for (Part& part : parts)
    for (std::size_t i = 0; i < part.records.size(); ++i) {
      RecordRow& record = part.records[i];
      const std::size_t place = places.find_or_add(record.key, part.hashes[i]);
      if (place == records.size())
        records.push_back(std::move(record));
      else
        records[place] = std::move(record);
    }
  if (faults > named) fmt::print(stderr, "... and {} more\n", faults - named);
  if (faults > 0)
    fmt::print(stderr, "{} bad line{} skipped, {} records used\n", faults, faults == 1 ? "" : "s",
               records.size());
  return records;
}

std::vector<RecordRow> record_rows(const std::vector<Json>& records) {
  RecordParser parser;
  std::vector<RecordRow> rows;
  rows.reserve(records.size());
  const auto place = [&] { return fmt::format("record {}", rows.size()); };
  for (const Json& record : records) read_line(parser, record.dump(), place, rows.emplace_back());
  return rows;
}

}  // namespace liebench
