#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

// Reading JSON from users: whatever is not understood is an InputError with the JSON pointer, the value, what
// is allowed and the nearest spelling.

namespace liebench {

using Json = nlohmann::ordered_json;  // keeps the order of keys: records read in the order of docs/records.md

// A text as an error message shows it: its first 60 bytes.
std::string shortened(std::string text);

// The word of `allowed` that a mistyped `word` most likely means; empty where none is near.
std::string nearest(std::string_view word, const std::vector<std::string>& allowed);

// `"a", "b" or "c"`
std::string quoted_list(const std::vector<std::string>& words);

// "; did you mean "x"?" or nothing.
std::string suggestion(std::string_view word, const std::vector<std::string>& allowed);

// Throws InputError with line and column where the text is not JSON. `source` names it: a file.
Json parse_json(std::string_view text, const std::string& source);

inline constexpr std::uintmax_t largest_json_file = 16u << 20;  // bytes

// Throws InputError where the file cannot be read, is not JSON or larger than that; the size is looked at before it is read.
Json read_json_file(const std::filesystem::path& file, std::uintmax_t most_bytes = largest_json_file);

// A value together with the place where it stands.
class JsonView {
 public:
  JsonView(const Json& value, std::string pointer) : value_(&value), pointer_(std::move(pointer)) {}

  const Json& value() const { return *value_; }
  const std::string& pointer() const { return pointer_; }
  bool is_array() const { return value_->is_array(); }
  std::size_t size() const { return value_->size(); }
  bool has(const std::string& key) const { return value_->is_object() && value_->contains(key); }

  // The member or element; the member must be there.
  JsonView operator[](const std::string& key) const;
  JsonView operator[](std::size_t index) const;

  // Checks; each throws InputError.
  void require_object(const std::vector<std::string>& allowed_keys) const;
  void require_key(const std::string& key) const;
  void require_array() const;
  std::string text() const;
  std::string word(const std::vector<std::string>& allowed, std::string_view what) const;
  double number(std::string_view allowed) const;
  double number_in(double least, double most) const;
  int integer_in(int least, int most) const;
  bool boolean() const;

  // Throws InputError: the value is not what is allowed.
  [[noreturn]] void reject(std::string_view allowed, std::string_view hint = {}) const;

 private:
  const Json* value_;
  std::string pointer_;
};

}  // namespace liebench
