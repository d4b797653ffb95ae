#include "harness/strict_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numeric>
#include <set>

#include "harness/errors.h"

namespace liebench {

namespace {

constexpr int deepest_nesting = 64;

// Levenshtein distance, case ignored.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = std::tolower(static_cast<unsigned char>(a[i - 1])) ==
                        std::tolower(static_cast<unsigned char>(b[j - 1]));
      const std::size_t replaced = diagonal + (same ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

std::string shown(const Json& value) {
  return shortened(value.dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::string escaped(std::string key) {
  std::string result;
  for (char c : key) {
    if (c == '~')
      result += "~0";
    else if (c == '/')
      result += "~1";
    else
      result += c;
  }
  return result;
}

}  // namespace

std::string shortened(std::string text) {
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

std::string nearest(std::string_view word, const std::vector<std::string>& allowed) {
  std::string best;
  std::size_t least = word.size() / 2 + 1;
  for (const std::string& candidate : allowed) {
    // At least the difference of their lengths: a word of a megabyte is compared with none.
    if (word.size() >= candidate.size() + least || candidate.size() >= word.size() + least) continue;
    const std::size_t d = distance(word, candidate);
    if (d < least) {
      least = d;
      best = candidate;
    }
  }
  return best;
}

std::string quoted_list(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
    text += '"' + words[i] + '"';
  }
  return text;
}

std::string suggestion(std::string_view word, const std::vector<std::string>& allowed) {
  const std::string best = nearest(word, allowed);
  return best.empty() ? "" : fmt::format("; did you mean \"{}\"?", best);
}

Json parse_json(std::string_view text, const std::string& source) {
  // The parser recurses: refuse what no study needs before it does. Of two equal keys it would keep one silently.
  std::vector<std::set<std::string>> keys;
  const auto check = [&](int depth, Json::parse_event_t event, Json& parsed) {
    if (depth > deepest_nesting && event != Json::parse_event_t::value)
      throw InputError("", fmt::format("nested deeper than {} levels", deepest_nesting));
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event == Json::parse_event_t::key && !keys.back().insert(parsed.get<std::string>()).second)
      throw InputError(
          "", fmt::format("the key \"{}\" stands twice in one object", shortened(parsed.get<std::string>())));
    return true;
  };
  try {
    return Json::parse(text, check);
  } catch (const InputError& error) {
    throw InputError(source, error.what());
  } catch (const Json::exception& error) {
    std::string reason = error.what();
    // "[json.exception.parse_error.101] parse error at line 1, column 9: syntax error ..." -> from "at line"
    // or "number"
    const std::size_t bracket = reason.find("] ");
    if (bracket != std::string::npos) reason = reason.substr(bracket + 2);
    const bool number =
        reason.find("overflow") != std::string::npos || text.find("NaN") != std::string_view::npos ||
        text.find("nan") != std::string_view::npos || text.find("Infinity") != std::string_view::npos;
    throw InputError(source,
                     "not valid JSON: " + reason +
                         (number ? "; every number must be finite: NaN, Infinity and values beyond 1.8e308 "
                                   "are not allowed"
                                 : ""));
  }
}

Json read_json_file(const std::filesystem::path& file, std::uintmax_t most_bytes) {
  std::error_code code;
  const auto size = std::filesystem::file_size(file, code);
  if (!code && size > most_bytes)
    throw InputError(file.string(), fmt::format("{} bytes; at most {} are allowed", size, most_bytes));
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file, code))
    throw InputError(file.string(), "cannot be read; a JSON file is expected here");
  // A device or a pipe has no size.
  std::string text;
  std::array<char, 1 << 16> part;
  while (stream.read(part.data(), part.size()) || stream.gcount() > 0) {
    text.append(part.data(), std::size_t(stream.gcount()));
    if (text.size() > most_bytes)
      throw InputError(file.string(), fmt::format("more than {} bytes, which are allowed", most_bytes));
  }
  if (stream.bad()) throw InputError(file.string(), "cannot be read; a JSON file is expected here");
  return parse_json(text, file.string());
}

JsonView JsonView::operator[](const std::string& key) const {
  return {(*value_)[key], pointer_ + "/" + escaped(key)};
}

JsonView JsonView::operator[](std::size_t index) const {
  return {(*value_)[index], pointer_ + "/" + std::to_string(index)};
}

void JsonView::reject(std::string_view allowed, std::string_view hint) const {
  throw InputError(pointer_.empty() ? "/" : pointer_,
                   fmt::format("{} is not allowed here; allowed: {}{}", shown(*value_), allowed, hint));
}

void JsonView::require_object(const std::vector<std::string>& allowed_keys) const {
  if (!value_->is_object()) reject("an object with the keys " + quoted_list(allowed_keys));
  for (const auto& item : value_->items())
    if (std::find(allowed_keys.begin(), allowed_keys.end(), item.key()) == allowed_keys.end())
      throw InputError(pointer_ + "/" + escaped(shortened(item.key())),
                       fmt::format("unknown key \"{}\"; allowed: {}{}", shortened(item.key()),
                                   quoted_list(allowed_keys), suggestion(item.key(), allowed_keys)));
}

void JsonView::require_key(const std::string& key) const {
  if (!has(key)) throw InputError(pointer_ + "/" + key, "is missing");
}

void JsonView::require_array() const {
  if (!value_->is_array() || value_->empty()) reject("a list with at least one element");
}

std::string JsonView::text() const {
  if (!value_->is_string()) reject("a text in quotes");
  return value_->get<std::string>();
}

std::string JsonView::word(const std::vector<std::string>& allowed, std::string_view what) const {
  if (!value_->is_string()) reject(quoted_list(allowed));
  const auto word = value_->get<std::string>();
  if (std::find(allowed.begin(), allowed.end(), word) == allowed.end())
    throw InputError(pointer_, fmt::format("unknown {} \"{}\"; allowed: {}{}", what, shortened(word),
                                           quoted_list(allowed), suggestion(word, allowed)));
  return word;
}

double JsonView::number(std::string_view allowed) const {
  if (!value_->is_number()) reject(allowed);
  const double x = value_->get<double>();
  if (!std::isfinite(x)) reject(allowed);
  return x;
}

double JsonView::number_in(double least, double most) const {
  const std::string allowed = fmt::format("a number from {} to {}", least, most);
  const double x = number(allowed);
  if (x < least || x > most) reject(allowed);
  return x;
}

int JsonView::integer_in(int least, int most) const {
  const std::string allowed = fmt::format("an integer from {} to {}", least, most);
  const double x = number(allowed);
  if (x != std::floor(x) || x < least || x > most) reject(allowed);
  return int(x);
}

bool JsonView::boolean() const {
  if (!value_->is_boolean()) reject("true or false");
  return value_->get<bool>();
}

}  // namespace liebench
