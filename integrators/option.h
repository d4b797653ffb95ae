#pragma once

#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

// Options of an integrator as plain data, from which studies are validated and `liebench describe` is
// written. Nothing here knows a file format.

namespace liebench {

enum class OptionKind { integer, real, boolean, choice, boolean_or_choice };

// Where an option means something. Elsewhere it is absent, from records too.
enum class OptionScope { everywhere, constrained, index3 };

// One option: an integer or real in [least, most], a boolean, one of a few words, or a boolean or one of a few words;
// `fallback` is its default (for a choice the index of the word).
struct OptionInfo {
  std::string_view name;
  OptionKind kind;
  double fallback = 0.0;
  std::optional<double> self_start_fallback{};  // the default with `start: self`, where it is another
  double least = 0.0;
  double most = 0.0;
  std::array<std::string_view, 4> choices{};  // empty words do not count
  OptionScope scope = OptionScope::everywhere;
  bool unsaid = false;  // absent, too, where it has its default
  std::string_view meaning;
};

// `k` of the multistep methods of order k.
constexpr OptionInfo steps_option(int most) {
  return {.name = "k",
          .kind = OptionKind::integer,
          .fallback = 2,
          .least = 1,
          .most = double(most),
          .meaning = "number of steps, and order"};
}

using OptionValue = std::variant<int, double, bool, std::string>;

// Values of the options of one integrator, checked against its list before. An option that does not apply is absent.
class OptionValues {
 public:
  void set(std::string_view name, OptionValue value) { values_[std::string(name)] = std::move(value); }
  void erase(std::string_view name) {
    if (const auto place = values_.find(name); place != values_.end()) values_.erase(place);
  }
  int integer(std::string_view name) const { return std::get<int>(at(name)); }
  double real(std::string_view name) const { return std::get<double>(at(name)); }
  bool boolean(std::string_view name) const { return std::get<bool>(at(name)); }
  const std::string& choice(std::string_view name) const { return std::get<std::string>(at(name)); }
  bool is_choice(std::string_view name) const { return std::holds_alternative<std::string>(at(name)); }
  bool boolean_or(std::string_view name, bool otherwise) const {
    return has(name) ? boolean(name) : otherwise;
  }
  std::string choice_or(std::string_view name, std::string_view otherwise) const {
    return has(name) ? choice(name) : std::string(otherwise);
  }
  bool has(std::string_view name) const { return values_.find(name) != values_.end(); }
  const std::map<std::string, OptionValue, std::less<>>& all() const { return values_; }

 private:
  const OptionValue& at(std::string_view name) const { return values_.find(name)->second; }
  std::map<std::string, OptionValue, std::less<>> values_;
};

// The shortest decimal that reads back as x.
inline std::string decimal_text(double x) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), x).ptr;
  return {text.data(), end};
}

}  // namespace liebench
