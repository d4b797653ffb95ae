#include "harness/methods.h"

#include <fmt/format.h>

#include <algorithm>

#include "harness/outside/outside_methods.h"
#include "integrators/form.h"
#include "integrators/list.h"
#include "integrators/step_control.h"

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
  return {MethodInfo{Methods::name, Methods::summary, Methods::fits, chooses_steps<Methods>(),
                     Methods::option_list, &Methods::title, &Methods::orders, &is_symmetric<Methods>,
                     &kept_constraints<Methods>}...};
}

std::vector<MethodInfo> all_infos() {
  std::vector<MethodInfo> list = infos(Integrators{});
  for (const OutsideMethod& each : outside_methods())
    list.push_back({.name = each.name,
                    .summary = each.summary,
                    .fits = each.fits,
                    .chooses_steps = true,
                    .options = each.options,
                    .title = each.title,
                    .orders = each.orders,
                    .outside = &each});
  return list;
}

bool fits(const MethodInfo& method, std::string_view problem, bool constrained,
          std::string_view formulation) {
  if (!fits(method.fits, constrained)) return false;
  if (method.outside == nullptr) return true;
  if (problem.empty()) return false;
  return (problem == "heavy_top" && method.outside->formulation == formulation) ||
         (method.outside->scenes && formulation == "scene");
}

}  // namespace

const std::vector<MethodInfo>& methods() {
  static const std::vector<MethodInfo> list = all_infos();
  return list;
}

const MethodInfo* find_method(std::string_view name) {
  const auto place =
      std::find_if(methods().begin(), methods().end(), [&](const MethodInfo& m) { return m.name == name; });
  return place == methods().end() ? nullptr : &*place;
}

bool has_option(const MethodInfo& method, std::string_view option) {
  return std::any_of(method.options.begin(), method.options.end(),
                     [&](const OptionInfo& info) { return info.name == option; });
}

std::string methods_that_choose_steps(bool with_outside) {
  std::vector<std::string> names;
  for (const MethodInfo& method : methods())
    if (method.chooses_steps && (with_outside || method.outside == nullptr)) names.emplace_back(method.name);
  return quoted_list(names);
}

std::string fits_text(const MethodInfo& method) {
  if (method.outside != nullptr)
    return fmt::format("the heavy top in the formulation \"{}\"{}", method.outside->formulation,
                       method.outside->scenes ? " and scenes without joints" : " alone");
  switch (method.fits) {
    case Fits::every_system:
      return "every problem";
    case Fits::without_constraints:
      return "problems without constraints";
    case Fits::with_constraints:
      break;
  }
  return "problems with constraints";
}

std::string misfit(const MethodInfo& method, std::string_view problem, bool constrained,
                   std::string_view formulation) {
  if (fits(method, problem, constrained, formulation)) return {};
  std::vector<std::string> fitting;
  for (const MethodInfo& other : methods())
    if (fits(other, problem, constrained, formulation)) fitting.emplace_back(other.name);
  if (method.outside != nullptr && problem.empty())
    return fmt::format("{} runs in studies alone (liebench run). What fits here: {}", method.name,
                       quoted_list(fitting));
  const bool scene_with_joints =
      method.outside != nullptr && method.outside->scenes && formulation == "scene";
  const std::string_view difference = scene_with_joints           ? "has joints"
                                      : method.outside != nullptr ? "is another"
                                      : constrained               ? "has constraints"
                                                                  : "has none";
  return fmt::format("{} integrates {}; this one {}. What fits it: {}", method.name, fits_text(method),
                     difference, quoted_list(fitting));
}

std::string_view obstacle_to(const MethodInfo& method) {
  return method.outside != nullptr ? outside_obstacle() : "";
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
    case OptionKind::boolean_or_choice: {
      if (view.value().is_boolean()) return view.value().get<bool>();
      const std::vector<std::string> allowed = words(info);
      if (view.value().is_string() &&
          std::find(allowed.begin(), allowed.end(), view.value()) != allowed.end())
        return view.value().get<std::string>();
      view.reject(allowed_values(info),
                  view.value().is_string() ? suggestion(view.value().get<std::string>(), allowed) : "");
    }
  }
  return {};
}

OptionValue option_default(const OptionInfo& info, bool self_start) {
  const double fallback = self_start ? info.self_start_fallback.value_or(info.fallback) : info.fallback;
  switch (info.kind) {
    case OptionKind::integer:
      return int(fallback);
    case OptionKind::real:
      return fallback;
    case OptionKind::boolean:
    case OptionKind::boolean_or_choice:
      return fallback != 0.0;
    case OptionKind::choice:
      return std::string(info.choices[std::size_t(fallback)]);
  }
  return {};
}

bool applies(const OptionInfo& info, bool constrained, const OptionValues& values) {
  switch (info.scope) {
    case OptionScope::everywhere:
      return true;
    case OptionScope::constrained:
      return constrained;
    case OptionScope::index3:
      return constrained && values.choice_or("form", "index3") == "index3";
  }
  return true;
}

bool goes_without_saying(const OptionInfo& info, const OptionValues& values) {
  const auto place = values.all().find(info.name);
  return info.unsaid && place != values.all().end() && place->second == option_default(info);
}

std::string scope_text(const OptionInfo& info) {
  switch (info.scope) {
    case OptionScope::everywhere:
      return "any problem";
    case OptionScope::constrained:
      return "a formulation with constraints";
    case OptionScope::index3:
      return "a formulation with constraints and \"form\": \"index3\"";
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
    case OptionKind::boolean_or_choice:
      return "true, false or " + quoted_list(words(info));
  }
  return {};
}

Json options_to_json(const MethodInfo& method, const OptionValues& values) {
  Json j = Json::object();
  for (const OptionInfo& info : method.options)
    if (const auto place = values.all().find(info.name); place != values.all().end())
      std::visit([&](const auto& value) { j[std::string(info.name)] = value; }, place->second);
  return j;
}

OptionValues options_from_json(const MethodInfo& method, const Json& json) {
  OptionValues values;
  for (const OptionInfo& info : method.options)
    if (const std::string key(info.name); json.contains(key))
      values.set(key, option_value(info, JsonView(json.at(key), "/options/" + key)));
  return values;
}

}  // namespace liebench
