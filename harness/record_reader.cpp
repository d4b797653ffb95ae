#include "harness/record_reader.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <rapidjson/memorystream.h>
#include <rapidjson/reader.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <thread>
#include <unordered_map>
#include <utility>

#include "harness/errors.h"
#include "harness/record.h"
#include "harness/record_file.h"

namespace liebench {

namespace {

// Throws InputError unless it has what tables and plots rely on.
void require_record(const Json& record, const std::string& place) {
  if (!record.is_object() || !record.contains("schema") || !record.contains("key"))
    throw InputError(place, "is not a record of liebench: the keys \"schema\" and \"key\" are missing");
  if (record["schema"] != record_schema)
    throw InputError(place, fmt::format("record schema {}; this program reads {}", record["schema"].dump(),
                                        record_schema));
  const auto require = [&](const Json& object, const char* key, bool (Json::*is)() const noexcept) {
    const auto found = object.find(key);
    if (found == object.end() || !((*found).*is)())
      throw InputError(
          place, fmt::format("is not a whole record of liebench: \"{}\" is missing or of another type", key));
  };
  for (const char* key :
       {"key", "study", "problem", "formulation", "integrator", "start", "precision", "outcome"})
    require(record, key, &Json::is_string);
  for (const char* key : {"parameters", "options", "reference", "cost"})
    require(record, key, &Json::is_object);
  for (const char* key : {"step_size", "steps", "t_0", "t_end"}) require(record, key, &Json::is_number);
  require(record["reference"], "error_estimate", &Json::is_number);
  if (record["outcome"] == "ok") {
    require(record, "errors", &Json::is_object);
  } else {
    require(record, "failure", &Json::is_object);
    require(record["failure"], "time", &Json::is_number);
    require(record["failure"], "message", &Json::is_string);
  }
}

// Events of rapidjson's parser into a record without what is not kept.
class Builder {
 public:
  Builder(const RecordNeeds& needs, const rapidjson::MemoryStream& stream) : needs_(needs), stream_(stream) {}
  Json take() { return std::move(root_); }
  // Where the object `parameters` stands on the line, if it was left out.
  std::pair<std::size_t, std::size_t> parameters() const { return {parameters_begin_, parameters_end_}; }

  bool Null() { return add(Json(nullptr)); }
  bool Bool(bool b) { return add(Json(b)); }
  bool Int(int i) { return add(Json(std::int64_t{i})); }
  bool Uint(unsigned u) { return add(Json(std::uint64_t{u})); }
  bool Int64(std::int64_t i) { return add(Json(i)); }
  bool Uint64(std::uint64_t u) { return add(Json(u)); }
  bool Double(double d) { return add(Json(d)); }
  bool RawNumber(const char*, rapidjson::SizeType, bool) { return false; }
  bool String(const char* text, rapidjson::SizeType length, bool) {
    if (!skipping()) return add(Json(std::string(text, length)));
    left_out();
    return true;
  }
  bool StartObject() {
    open(Json::object());
    // Of the usual size at once: a container that grows moves what it holds.
    if (!skipping())
      open_.back()->get_ref<Json::object_t&>().reserve(open_.size() == 1      ? 20
                                                       : in_parts_ && !whole_ ? 2
                                                       : section_ == "cost"   ? 17
                                                                              : 4);
    return true;
  }
  bool StartArray() {
    open(Json::array());
    if (!skipping()) open_.back()->get_ref<Json::array_t&>().reserve(3);
    return true;
  }
  bool EndObject(rapidjson::SizeType) { return close(); }
  bool EndArray(rapidjson::SizeType) { return close(); }
  bool Key(const char* text, rapidjson::SizeType length, bool) {
    if (depth_left_out_ > 0) return true;
    const std::string_view key(text, length);
    if (open_.size() == 1) {
      section_ = key;
      in_parts_ = std::find(parts.begin(), parts.end(), key) != parts.end();
      whole_ = in_parts_ && needs_.whole(key);
      in_parameters_ = !needs_.shared_parameters() && key == "parameters";
      if (in_parameters_) parameters_begin_ = stream_.Tell();
      next_left_out_ = in_parameters_ || key == "provenance" || key == "requested_step_size" ||
                       (in_parts_ && key != "errors" && key != "cost" && !needs_.part_of(key));
    } else if (open_.size() == 2) {
      next_left_out_ =
          in_parts_ ? !whole_ && !needs_.entry(section_, key) : section_ == "reference" && key == "method";
    }
    if (next_left_out_) return true;
    // A key given twice keeps its last value, as parse_json has it.
    member_ = &(*open_.back())[std::string(key)];
    return true;
  }

 private:
  bool skipping() const { return depth_left_out_ > 0 || next_left_out_; }
  void left_out() {
    if (depth_left_out_ > 0) return;
    next_left_out_ = false;
    if (std::exchange(in_parameters_, false)) parameters_end_ = stream_.Tell();
  }
  Json* place(Json&& value) {
    if (open_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    if (open_.back()->is_array()) {
      open_.back()->push_back(std::move(value));
      return &open_.back()->back();
    }
    *member_ = std::move(value);
    return member_;
  }
  bool add(Json&& value) {
    if (skipping())
      left_out();
    else
      place(std::move(value));
    return true;
  }
  bool open(Json&& empty) {
    if (skipping())
      ++depth_left_out_;
    else
      open_.push_back(place(std::move(empty)));
    return true;
  }
  bool close() {
    if (depth_left_out_ > 0) {
      --depth_left_out_;
      left_out();
    } else {
      open_.pop_back();
    }
    return true;
  }

  // The sections that are kept by parts; errors and cost at least as empty objects, for a record is checked to have them.
  static constexpr std::array<std::string_view, 4> parts{"errors", "cost", "time", "drift"};

  const RecordNeeds& needs_;
  const rapidjson::MemoryStream& stream_;
  Json root_;
  std::vector<Json*> open_;  // innermost last; a container does not move while one inside it is open
  Json* member_ = nullptr;
  std::string section_;
  bool in_parts_ = false, whole_ = false;
  bool in_parameters_ = false;
  std::size_t parameters_begin_ = 0, parameters_end_ = 0;
  int depth_left_out_ = 0;
  bool next_left_out_ = false;
};

// What a thread read.
struct Part {
  std::vector<Json> records;
  std::vector<InputError> faults;
  std::exception_ptr failure;  // of the machine
  // Where records come without their parameters: the different texts of these, and which of them is whose.
  std::unordered_map<std::string, std::size_t> texts;
  std::vector<std::size_t> parameters;
};

// Adds the record without what is not kept; its faults are named by the parser that all input goes through.
void read_line(std::string_view line, const std::string& place, const RecordNeeds& needs, Part& part) {
  constexpr unsigned flags = rapidjson::kParseFullPrecisionFlag | rapidjson::kParseValidateEncodingFlag |
                             rapidjson::kParseIterativeFlag;
  rapidjson::MemoryStream stream(line.data(), line.size());
  Builder builder(needs, stream);
  rapidjson::Reader reader;
  Json record;
  std::string parameters;
  if (line.find('\0') != std::string_view::npos || reader.Parse<flags>(stream, builder).IsError()) {
    record = parse_record(line, place);
    if (!needs.shared_parameters()) {
      parameters = record.at("parameters").dump();
      record["parameters"] = Json::object();
    }
  } else {
    record = builder.take();
    if (const auto [begin, end] = builder.parameters(); end > begin) {
      // With its last brace, before which the parser tells of the end.
      const std::string_view text = line.substr(begin, end - begin + 1);
      parameters = text.substr(std::min(text.find_first_not_of(": \t"), text.size()));
      record["parameters"] = parameters.starts_with('{') ? Json::object() : Json();
    }
    require_record(record, place);
  }
  if (!needs.shared_parameters())
    part.parameters.push_back(part.texts.try_emplace(std::move(parameters), part.texts.size()).first->second);
  part.records.push_back(std::move(record));
}

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

std::vector<std::string_view> lines_of_file(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    lines.push_back(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return lines;
}

void read_part(const std::vector<std::string_view>& lines, std::size_t begin, std::size_t end,
               const std::string& file, BadLines bad_lines, const RecordNeeds& needs, Part& part) {
  part.records.reserve(end - begin);
  for (std::size_t i = begin; i < end; ++i) {
    if (lines[i].empty()) continue;
    try {
      read_line(lines[i], fmt::format("{}:{}", file, i + 1), needs, part);
    } catch (const InputError& error) {
      part.faults.push_back(error);
      if (bad_lines == BadLines::reject) return;
    } catch (...) {
      part.failure = std::current_exception();
      return;
    }
  }
}

std::vector<Part> read_parts(const std::filesystem::path& file, BadLines bad_lines,
                             const RecordNeeds& needs) {
  const Content content(file);
  const std::vector<std::string_view> lines = lines_of_file(content.text());
  constexpr std::size_t lines_worth_a_thread = 500;
  const std::size_t most = std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, 8);
  std::vector<Part> parts(std::clamp<std::size_t>(lines.size() / lines_worth_a_thread, 1, most));
  const auto start_of = [&](std::size_t part) { return lines.size() * part / parts.size(); };
  const auto read = [&](std::size_t i) {
    read_part(lines, start_of(i), start_of(i + 1), file.string(), bad_lines, needs, parts[i]);
  };
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 1; i < parts.size(); ++i) threads.emplace_back(read, i);
    read(0);
  }
  return parts;
}

}  // namespace

bool RecordNeeds::whole(std::string_view section) const {
  return std::find(paths_.begin(), paths_.end(), section) != paths_.end();
}

bool RecordNeeds::part_of(std::string_view section) const {
  return std::any_of(paths_.begin(), paths_.end(), [&](const std::string& path) {
    return path.starts_with(section) && (path.size() == section.size() || path[section.size()] == '/');
  });
}

bool RecordNeeds::entry(std::string_view section, std::string_view entry) const {
  return std::any_of(paths_.begin(), paths_.end(), [&](const std::string& path) {
    return path.size() == section.size() + 1 + entry.size() && path.starts_with(section) &&
           path[section.size()] == '/' && path.ends_with(entry);
  });
}

Json parse_record(std::string_view line, const std::string& place) {
  Json record = parse_json(line, place);
  require_record(record, place);
  return record;
}

namespace {

// Gives the records of the parts their parameters back, unless all have the same.
void restore_parameters(std::vector<Part>& parts) {
  std::set<std::string_view> texts;
  for (const Part& part : parts)
    for (const auto& text : part.texts) texts.insert(text.first);
  if (texts.size() < 2) return;
  for (Part& part : parts) {
    std::vector<Json> values(part.texts.size());
    for (const auto& [text, index] : part.texts) values[index] = parse_json(text, "parameters");
    for (std::size_t i = 0; i < part.records.size(); ++i)
      part.records[i]["parameters"] = values[part.parameters[i]];
  }
}

}  // namespace

std::vector<Json> read_records(const std::vector<std::filesystem::path>& files, BadLines bad_lines,
                               const RecordNeeds& needs) {
  std::vector<Part> parts;
  for (const std::filesystem::path& file : files)
    for (Part& part : read_parts(file, bad_lines, needs)) parts.push_back(std::move(part));
  std::size_t faults = 0;
  constexpr std::size_t named = 20;
  for (const Part& part : parts) {
    if (part.failure) std::rethrow_exception(part.failure);
    for (const InputError& fault : part.faults) {
      if (bad_lines == BadLines::reject) throw InputError(fault);
      if (faults++ < named) fmt::print(stderr, "{}\n", fault.what());
    }
  }
  if (!needs.shared_parameters()) restore_parameters(parts);
  std::vector<Json> records;
  // The keys are texts on the heap: they stay where they are when their records move.
  std::unordered_map<std::string_view, std::size_t> place_of;
  for (Part& part : parts)
    for (Json& record : part.records) {
      const std::string_view key = record["key"].get_ref<const std::string&>();
      const auto [place, fresh] = place_of.try_emplace(key, records.size());
      if (fresh) {
        records.push_back(std::move(record));
      } else {
        const std::size_t i = place->second;
        place_of.erase(place);
        place_of.emplace(key, i);
        records[i] = std::move(record);
      }
    }
  if (faults > named) fmt::print(stderr, "... and {} more\n", faults - named);
  if (faults > 0)
    fmt::print(stderr, "{} bad line{} skipped, {} records used\n", faults, faults == 1 ? "" : "s",
               records.size());
  return records;
}

std::vector<Json> read_records(const std::filesystem::path& file) {
  return read_records(std::vector<std::filesystem::path>{file});
}

}  // namespace liebench
