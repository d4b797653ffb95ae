#include "harness/record_reader.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <unordered_map>
#include <utility>

#include "harness/errors.h"
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

template <class Record>
struct Keyed {
  std::string key;
  Record record;
};

// What a thread read.
template <class Record>
struct Part {
  std::vector<Keyed<Record>> records;
  std::vector<InputError> faults;
  std::exception_ptr failure;  // of the machine
};

// Readers of lines, one a thread; `place()` names the line.
class RowReader {
 public:
  using Record = RecordRow;
  template <class Place>
  void read(std::string_view line, const Place& place, Keyed<RecordRow>& result) {
    if (parser_.parse(line, result.key, result.record)) return;
    // What is wrong with it says the parser that all input goes through.
    const std::string plain = parse_record(line, place()).dump();
    result.record = {};
    if (!parser_.parse(plain, result.key, result.record))
      throw InputError(place(), "is not a record of liebench");
  }

 private:
  RecordParser parser_;
};

class JsonReader {
 public:
  using Record = Json;
  template <class Place>
  void read(std::string_view line, const Place& place, Keyed<Json>& result) {
    result.record = parse_record(line, place());
    for (const char* unused : {"provenance", "reference", "drift"}) result.record.erase(unused);
    result.key = result.record.at("key").get<std::string>();
  }
};

// Lines of a text from `begin` to `end`, which are at the start of lines.
template <class Reader>
void read_part(Reader& reader, std::string_view text, std::size_t begin, std::size_t end,
               const std::string& file, BadLines bad_lines, Part<typename Reader::Record>& part) {
  // Lines are of about one length.
  const std::size_t line_size = std::min(end, text.find('\n', begin)) - begin + 1;
  part.records.reserve((end - begin) / line_size * 9 / 8 + 16);
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
      reader.read(line, place, part.records.back());
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
template <class Reader>
std::vector<Part<typename Reader::Record>> read_parts(const std::filesystem::path& file, BadLines bad_lines,
                                                      unsigned threads) {
  const Content content(file);
  const std::string_view text = content.text();
  constexpr std::size_t part_size = 1U << 20U;  // bytes
  const std::size_t count = text.size() / part_size + 1;
  std::vector<std::size_t> begins{0};
  for (std::size_t i = 1; i < count; ++i) {
    const std::size_t end = text.find('\n', std::max(begins.back(), text.size() / count * i));
    if (end == std::string_view::npos) break;
    begins.push_back(end + 1);
  }
  std::vector<Part<typename Reader::Record>> parts(begins.size());
  begins.push_back(text.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    Reader reader;
    for (std::size_t i = next++; i < parts.size(); i = next++)
      read_part(reader, text, begins[i], begins[i + 1], file.string(), bad_lines, parts[i]);
  };
  {
    if (threads == 0) threads = std::min(8U, std::thread::hardware_concurrency());
    std::vector<std::jthread> list;
    for (std::size_t i = 1; i < std::min<std::size_t>(threads, parts.size()); ++i) list.emplace_back(work);
    work();
  }
  return parts;
}

template <class Reader>
std::vector<typename Reader::Record> read_all(const std::vector<std::filesystem::path>& files,
                                              BadLines bad_lines, unsigned threads) {
  std::vector<Part<typename Reader::Record>> parts;
  for (const std::filesystem::path& file : files)
    for (auto& part : read_parts<Reader>(file, bad_lines, threads)) parts.push_back(std::move(part));
  std::size_t faults = 0, lines = 0;
  constexpr std::size_t named = 20;
  for (const auto& part : parts) {
    if (part.failure) std::rethrow_exception(part.failure);
    for (const InputError& fault : part.faults) {
      if (bad_lines == BadLines::reject) throw InputError(fault);
      if (faults++ < named) fmt::print(stderr, "{}\n", fault.what());
    }
    lines += part.records.size();
  }
  std::vector<typename Reader::Record> records;
  records.reserve(lines);
  std::unordered_map<std::string_view, std::size_t> place_of;
  place_of.reserve(lines);
  for (auto& part : parts)
    for (auto& [key, record] : part.records) {
      const auto [place, fresh] = place_of.try_emplace(key, records.size());
      if (fresh)
        records.push_back(std::move(record));
      else
        records[place->second] = std::move(record);
    }
  if (faults > named) fmt::print(stderr, "... and {} more\n", faults - named);
  if (faults > 0)
    fmt::print(stderr, "{} bad line{} skipped, {} records used\n", faults, faults == 1 ? "" : "s",
               records.size());
  return records;
}

}  // namespace

std::vector<RecordRow> read_records(const std::vector<std::filesystem::path>& files, BadLines bad_lines,
                                    unsigned threads) {
  return read_all<RowReader>(files, bad_lines, threads);
}

std::vector<Json> read_whole_records(const std::filesystem::path& file, BadLines bad_lines) {
  return read_all<JsonReader>({file}, bad_lines, 0);
}

std::vector<RecordRow> record_rows(const std::vector<Json>& records) {
  RowReader reader;
  std::vector<RecordRow> rows;
  rows.reserve(records.size());
  const auto place = [&] { return fmt::format("record {}", rows.size() + 1); };
  for (const Json& record : records) {
    Keyed<RecordRow> row;
    reader.read(record.dump(), place, row);
    rows.push_back(std::move(row.record));
  }
  return rows;
}

}  // namespace liebench
