#include "harness/methods.h"

#include <fmt/format.h>

#include "integrators/list.h"

namespace liebench {

namespace {

std::vector<std::string> words(const OptionInfo& info) {
  std::vector<std::string> result;
  for (std::string_view choice : info.choices)
    if (!choice.empty()) result.emplace_back(choice);
  return result;
}

template <class... Methods>
std::vector<MethodInfo> infos(IntegratorList<Methods...>) {
  return {MethodInfo{Methods::name, Methods::summary, Methods::option_list}...};
}

}  // namespace

const std::vector<MethodInfo>& methods() {
  static const std::vector<MethodInfo> list = infos(Integrators{});
  return list;
}

OptionValue option_value(const OptionInfo& info, const JsonView& view) {
  switch (info.kind) {
    case OptionKind::integer:
      return view.integer_in(int(info.least), int(info.most));
    case OptionKind::real:
      return view.number_in(info.least, info.most);
    case OptionKind::boolean:
      return view.boolean();
    case OptionKind::choice:
      return view.word(words(info), info.name);
  }
  return {};
}

OptionValue option_default(const OptionInfo& info) {
  switch (info.kind) {
    case OptionKind::integer:
      return int(info.fallback);
    case OptionKind::real:
      return info.fallback;
    case OptionKind::boolean:
      return info.fallback != 0.0;
    case OptionKind::choice:
      return std::string(info.choices[std::size_t(info.fallback)]);
  }
  return {};
}

std::string allowed_values(const OptionInfo& info) {
  switch (info.kind) {
    case OptionKind::integer:
      return fmt::format("an integer from {} to {}", info.least, info.most);
    case OptionKind::real:
      return fmt::format("a number from {} to {}", info.least, info.most);
    case OptionKind::boolean:
      return "true or false";
    case OptionKind::choice:
      return quoted_list(words(info));
  }
  return {};
}

Json options_to_json(const MethodInfo& method, const OptionValues& values) {
  Json j = Json::object();
  for (const OptionInfo& info : method.options)
    std::visit([&](const auto& value) { j[std::string(info.name)] = value; },
               values.all().find(info.name)->second);
  return j;
}

}  // namespace liebench
