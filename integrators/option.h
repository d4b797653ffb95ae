#pragma once

#include <array>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

// Options of an integrator as plain data, from which studies are validated and `liebench describe` is
// written. Nothing here knows a file format.

namespace liebench {

enum class OptionKind { integer, real, boolean, choice };

// One option: an integer or real in [least, most], a boolean, or one of a few words; `fallback` is its
// default (for a choice the index of the word).
struct OptionInfo {
  std::string_view name;
  OptionKind kind;
  double fallback = 0.0;
  double least = 0.0;
  double most = 0.0;
  std::array<std::string_view, 4> choices{};  // empty words do not count
  std::string_view meaning;
};

using OptionValue = std::variant<int, double, bool, std::string>;

// Values of all options of one integrator, checked against its list before.
class OptionValues {
 public:
  void set(std::string_view name, OptionValue value) { values_[std::string(name)] = std::move(value); }
  int integer(std::string_view name) const { return std::get<int>(at(name)); }
  double real(std::string_view name) const { return std::get<double>(at(name)); }
  bool boolean(std::string_view name) const { return std::get<bool>(at(name)); }
  const std::string& choice(std::string_view name) const { return std::get<std::string>(at(name)); }
  const std::map<std::string, OptionValue, std::less<>>& all() const { return values_; }

 private:
  const OptionValue& at(std::string_view name) const { return values_.find(name)->second; }
  std::map<std::string, OptionValue, std::less<>> values_;
};

}  // namespace liebench
