#include "harness/record_parser.h"

#include <fmt/format.h>
#include <rapidjson/reader.h>
#include <rapidjson/stream.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <unordered_map>
#include <utility>
#include <vector>

#include "harness/errors.h"
#include "harness/record.h"

namespace liebench {

namespace {

// What a value has to be.
enum class Kind : std::uint8_t { text, number, object, other };

// What is kept of a record or checked in it, beside the numbers of number_paths.
struct Field {
  std::string_view path;
  Kind kind;
};
constexpr auto fields = std::to_array<Field>({
    {"schema", Kind::number},
    {"key", Kind::text},
    {"study", Kind::text},
    {"problem", Kind::text},
    {"formulation", Kind::text},
    {"parameters", Kind::object},
    {"integrator", Kind::text},
    {"options", Kind::object},
    {"start", Kind::text},
    {"precision", Kind::text},
    {"t_0", Kind::number},
    {"t_end", Kind::number},
    {"local_steps", Kind::number},
    {"outcome", Kind::text},
    {"reference", Kind::object},
    {"cost", Kind::object},
    {"errors", Kind::object},
    {"failure", Kind::object},
    {"failure/time", Kind::number},
    {"failure/step", Kind::number},
    {"failure/residual", Kind::number},
    {"failure/message", Kind::text},
    {"time/ns_per_step/samples", Kind::other},
});

consteval int field(std::string_view path) {
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (fields[i].path == path) return int(i);
  throw std::invalid_argument("no such field");
}

constexpr auto identity_fields = [] {
  std::array<int, identity_keys.size()> list{};
  for (std::size_t i = 0; i < list.size(); ++i)
    for (std::size_t j = 0; j < fields.size(); ++j)
      if (fields[j].path == identity_keys[i]) list[i] = int(j);
  return list;
}();

// A key of a record, with what is below it.
struct Node {
  std::string name;
  int field = -1;   // index in fields
  int number = -1;  // in number_paths
  std::vector<Node> children{};
  // The child looked for last: keys come in the order of the format.
  mutable std::size_t next = 0;

  const Node* child(std::string_view key) const {
    for (std::size_t n = children.size(), i = 0; i < n; ++i) {
      const std::size_t at = next + i < n ? next + i : next + i - n;
      if (children[at].name != key) continue;
      next = at + 1 < n ? at + 1 : 0;
      return &children[at];
    }
    return nullptr;
  }
};

Node& make_node(Node& root, std::string_view path) {
  Node* node = &root;
  while (!path.empty()) {
    const std::string_view name = path.substr(0, path.find('/'));
    path.remove_prefix(std::min(path.size(), name.size() + 1));
    const auto found = std::find_if(node->children.begin(), node->children.end(),
                                    [&](const Node& child) { return child.name == name; });
    node = found != node->children.end() ? &*found : &node->children.emplace_back(Node{std::string(name)});
  }
  return *node;
}

Node record_tree() {
  Node root;
  for (std::size_t i = 0; i < fields.size(); ++i) make_node(root, fields[i].path).field = int(i);
  for (std::size_t i = 0; i < number_paths.size(); ++i) make_node(root, number_paths[i]).number = int(i);
  return root;
}

// Empty where the number is beyond what a double holds.
std::optional<double> finite_number(std::string_view text) {
  double value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec == std::errc()) return value;
  // Too large, or so small that it is zero or denormal.
  value = std::strtod(std::string(text).c_str(), nullptr);
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

// Only an exponent of three digits, or hundreds of them before it, can make a number too large.
bool surely_finite(std::string_view text) {
  if (text.size() > 300) return false;
  const std::size_t e = text.find_first_of("eE");
  return e == std::string_view::npos || text.size() - e <= 4;
}

}  // namespace

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
    if (!record.contains("agreement_time")) require(record, "errors", &Json::is_object);
  } else {
    require(record, "failure", &Json::is_object);
    require(record["failure"], "time", &Json::is_number);
    require(record["failure"], "message", &Json::is_string);
  }
}

Json parse_record(std::string_view line, const std::string& place) {
  Json record = parse_json(line, place);
  require_record(record, place);
  return record;
}

namespace {

// Events of RapidJSON's parser, which has numbers as they are written, into a row. Of a key given twice the last value
// counts.
class Handler {
 public:
  // `stream` is on a copy of the line, which the parser changes.
  Handler(std::string_view line, rapidjson::InsituStringStream& stream, const Node& root, RecordRow& row)
      : line_(line), stream_(stream), open_{&root}, row_(row) {}

  bool Null() { return scalar(Kind::other, {}); }
  bool Bool(bool) { return scalar(Kind::other, {}); }
  bool RawNumber(const char* text, rapidjson::SizeType length, bool) {
    return scalar(Kind::number, {text, length});
  }
  bool String(const char* text, rapidjson::SizeType length, bool) {
    return scalar(Kind::text, {text, length});
  }
  // Numbers come raw.
  bool Int(int) { return false; }
  bool Uint(unsigned) { return false; }
  bool Int64(std::int64_t) { return false; }
  bool Uint64(std::uint64_t) { return false; }
  bool Double(double) { return false; }

  bool StartObject() {
    if (passed_over_ > 0) {
      ++passed_over_;
      return true;
    }
    if (depth_ == 0) {
      depth_ = 1;
      return true;
    }
    if (at_ != nullptr) note_kind(*at_, Kind::object);
    if (at_ == nullptr || at_->children.empty()) {
      passed_over_ = 1;
      return true;
    }
    open_[depth_++] = at_;
    return true;
  }
  bool StartArray() {
    if (depth_ == 0) return false;
    if (passed_over_++ > 0 || at_ == nullptr) return true;
    note_kind(*at_, Kind::other);
    in_samples_ = at_->field == field("time/ns_per_step/samples");
    return true;
  }
  bool EndObject(rapidjson::SizeType) { return end(); }
  bool EndArray(rapidjson::SizeType) { return end(); }
  bool Key(const char* text, rapidjson::SizeType length, bool) {
    if (passed_over_ > 0) return true;
    if (depth_ == 1) end_member();
    at_ = open_[depth_ - 1]->child({text, length});
    if (at_ != nullptr) forget(*at_);
    if (depth_ == 1) {
      member_ = at_;
      member_begin_ = stream_.Tell();
    }
    return true;
  }

  // Whether it is a record: as require_record has it.
  bool complete() const {
    for (const int needed :
         {field("schema"), field("key"), field("study"), field("problem"), field("formulation"),
          field("integrator"), field("start"), field("precision"), field("outcome"), field("parameters"),
          field("options"), field("reference"), field("cost"), field("t_0"), field("t_end")})
      if (!has(needed)) return false;
    for (const RecordNumber needed :
         {record_number("step_size"), record_number("steps"), record_number("reference/error_estimate")})
      if (!row_[needed]) return false;
    return row_.ended_well()
               ? has(field("errors")) || row_[record_number("agreement_time")].has_value()
               : has(field("failure")) && has(field("failure/time")) && has(field("failure/message"));
  }

  // Key, colon and value as they stand on the line; empty where the record has not got them.
  std::string_view text(int field) const { return texts_[std::size_t(field)]; }

  void keep_failure() {
    if (has(field("failure"))) row_.failure = std::make_shared<const RecordedFailure>(std::move(failure_));
  }

 private:
  bool has(int field) const { return has_[std::size_t(field)]; }
  void note_kind(const Node& node, Kind kind) {
    if (node.field >= 0) has_[std::size_t(node.field)] = kind == fields[std::size_t(node.field)].kind;
  }
  void forget(const Node& node) {
    if (node.field >= 0) {
      has_[std::size_t(node.field)] = false;
      if (node.field == field("failure")) failure_ = {};
      if (node.field == field("time/ns_per_step/samples")) row_.time_samples.clear();
    }
    if (node.number >= 0) row_.numbers[std::size_t(node.number)] = std::numeric_limits<double>::quiet_NaN();
    if (node.number < 0)
      for (const Node& child : node.children) forget(child);
  }
  // The parser tells of a key and of the end of an object before it has moved on from their beginning.
  void end_member() {
    if (member_ == nullptr || member_->field < 0) return;
    std::string_view text = line_.substr(member_begin_, stream_.Tell() - member_begin_);
    text = text.substr(0, text.find_last_not_of(", \t\r\n") + 1);
    texts_[std::size_t(member_->field)] = text;
  }
  bool scalar(Kind kind, std::string_view text) {
    if (depth_ == 0) return false;
    if (passed_over_ == 1 && in_samples_ && kind == Kind::number) {
      const std::optional<double> value = finite_number(text);
      if (value) row_.time_samples.push_back(*value);
      return value.has_value();
    }
    if (passed_over_ > 0 || at_ == nullptr)
      return kind != Kind::number || surely_finite(text) || finite_number(text);
    note_kind(*at_, kind);
    if (kind == Kind::text && at_->field >= 0) keep_text(at_->field, text);
    return kind != Kind::number || keep_number(text);
  }
  void keep_text(int at, std::string_view text) {
    if (at == field("key"))
      row_.key = text;
    else if (at == field("outcome"))
      row_.outcome = text;
    else if (at == field("failure/message"))
      failure_.message = text;
  }
  bool keep_number(std::string_view text) {
    const std::optional<double> value = finite_number(text);
    if (!value) return false;
    if (at_->number >= 0) row_.numbers[std::size_t(at_->number)] = *value;
    if (at_->field == field("schema") && *value != record_schema) return false;
    if (at_->field == field("failure/time")) failure_.time = *value;
    if (at_->field == field("failure/residual")) failure_.residual = *value;
    if (at_->field == field("failure/step")) {
      std::int64_t step = 0;
      const auto result = std::from_chars(text.data(), text.data() + text.size(), step);
      if (result.ec == std::errc() && result.ptr == text.data() + text.size()) failure_.step = step;
    }
    return true;
  }
  bool end() {
    if (passed_over_ > 0) {
      if (--passed_over_ == 0) in_samples_ = false;
    } else {
      if (depth_ == 1) end_member();
      --depth_;
    }
    return true;
  }

  std::string_view line_;
  rapidjson::InsituStringStream& stream_;
  std::array<const Node*, 8> open_;  // the tree is less deep
  std::size_t depth_ = 0;            // of the objects that are open and looked into
  const Node* at_ = nullptr;         // the key whose value comes; null where it is of no interest
  int passed_over_ = 0;              // containers that are open and not looked into
  bool in_samples_ = false;          // the outermost of these is time.ns_per_step.samples
  // The key of the record that was read last.
  const Node* member_ = nullptr;
  std::size_t member_begin_ = 0;
  std::array<bool, fields.size()> has_{};
  std::array<std::string_view, fields.size()> texts_{};
  RecordRow& row_;
  RecordedFailure failure_;
};

// Whether all bytes are printable ASCII.
bool is_plain(std::string_view text) {
  constexpr std::uint64_t high = 0x8080808080808080U, blank = 0x2020202020202020U;
  // A byte below 0x20 borrows: its high bit is set in the difference and not in itself.
  std::uint64_t found = 0;
  while (text.size() >= sizeof found) {
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, text.data(), sizeof bytes);
    found |= bytes | (bytes - blank);
    text.remove_prefix(sizeof bytes);
  }
  for (const char c : text)
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7f) return false;
  return (found & high) == 0;
}

}  // namespace

struct RecordParser::State {
  rapidjson::Reader reader{};
  Node root = record_tree();
  std::string buffer{};
  // By their text.
  std::unordered_map<std::string, std::shared_ptr<const CurveIdentity>> identities{};
  std::unordered_map<std::string, SharedJson> values{};
  // The text of the identity of the line before, and that identity.
  std::string text{};
  std::shared_ptr<const CurveIdentity> last{};
  std::string scratch{};

  std::shared_ptr<const CurveIdentity> identity(const Handler& handler);
  SharedJson shared(std::string_view member);
};

SharedJson RecordParser::State::shared(std::string_view member) {
  const auto [place, fresh] = values.try_emplace(std::string(member));
  if (fresh) place->second = SharedJson(Json::parse(member.substr(member.find('{'))));
  return place->second;
}

// The identity on the line that the handler has read.
std::shared_ptr<const CurveIdentity> RecordParser::State::identity(const Handler& handler) {
  scratch.clear();
  const bool local = !handler.text(field("local_steps")).empty();
  for (const int each : identity_fields)
    if (!local || each != field("t_end")) scratch += handler.text(each);
  if (scratch == text) return last;
  std::swap(text, scratch);
  std::shared_ptr<const CurveIdentity>& place = identities[text];
  if (!place) {
    std::string rest;
    for (const int each : identity_fields) {
      const std::string_view value = handler.text(each);
      if (value.empty() || each == field("parameters") || each == field("options")) continue;
      rest += rest.empty() ? '{' : ',';
      rest += value;
    }
    place = std::make_shared<const CurveIdentity>(identity_of(Json::parse(rest + '}'),
                                                              shared(handler.text(field("parameters"))),
                                                              shared(handler.text(field("options")))));
  }
  return last = place;
}

RecordParser::RecordParser() : state_(std::make_unique<State>()) {}
RecordParser::RecordParser(RecordParser&&) noexcept = default;
RecordParser::~RecordParser() = default;

bool RecordParser::parse(std::string_view line, RecordRow& row) {
  constexpr unsigned flags =
      rapidjson::kParseNumbersAsStringsFlag | rapidjson::kParseInsituFlag | rapidjson::kParseIterativeFlag;
  // Of other characters the parser checks each by itself.
  constexpr unsigned careful_flags = flags | rapidjson::kParseValidateEncodingFlag;
  const bool plain = is_plain(line);
  // A NUL is the parser's end of the text.
  if (!plain && line.find('\0') != std::string_view::npos) return false;
  state_->buffer = line;
  // Its end, and what the parser looks at beyond it.
  state_->buffer.append(16, '\0');
  rapidjson::InsituStringStream stream(state_->buffer.data());
  Handler handler(line, stream, state_->root, row);
  const bool parsed = plain ? !state_->reader.Parse<flags>(stream, handler).IsError()
                            : !state_->reader.Parse<careful_flags>(stream, handler).IsError();
  if (!parsed || !handler.complete()) return false;
  row.curve = state_->identity(handler);
  handler.keep_failure();
  return true;
}

}  // namespace liebench
