#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "harness/cli/commands.h"
#include "harness/embedded.h"
#include "harness/errors.h"
#include "harness/methods.h"
#include "harness/problems.h"
#include "harness/scene_reader.h"
#include "harness/sheets.h"
#include "harness/stability/case.h"
#include "harness/strict_json.h"

namespace liebench {

namespace {

// The effects of scenes are described by their schema.
Json scene_schema() {
  return parse_json(embedded_file("scene.schema.json"), "scene.schema.json");
}
std::vector<Json> effects() {
  const Json schema = scene_schema();
  const Json& list = schema.at("properties").at("effects").at("items").at("oneOf");
  return {list.begin(), list.end()};
}
std::string effect_name(const Json& effect) {
  return effect.at("properties").at("type").at("const");
}

void list(const std::string& what) {
  if (what == "effects") {
    for (const Json& effect : effects())
      fmt::print("{:<20} {}\n", effect_name(effect),
                 effect.at("properties").at("type").at("description").get<std::string>());
    return;
  }
  if (what == "stability") {
    for (const StabilityCase& entry : stability_cases())
      fmt::print("{:<20} {}\n", entry.name, entry.question);
    return;
  }
  if (what == "scenes") {
    for (const std::string& scene : builtin_scenes())
      fmt::print("{:<28} {}\n", scene, read_scene_file(scene).summary);
    return;
  }
  if (what == "problems") {
    for (const ProblemInfo& problem : problems()) fmt::print("{:<20} {}\n", problem.name, problem.summary);
    return;
  }
  for (const MethodInfo& method : methods())
    fmt::print("{:<20} {}{}\n", method.name, method.summary,
               obstacle_to(method).empty() ? "" : "; not in this build");
}

std::string default_text(const OptionInfo& info) {
  return std::visit(
      [](const auto& value) {
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::string>)
          return '"' + value + '"';
        else
          return fmt::format("{}", value);
      },
      option_default(info, false));
}

void describe_method(const MethodInfo& method) {
  const std::string_view obstacle = obstacle_to(method);
  fmt::print("{}: {}\n\nIntegrates {}.{}\n\n{}\n", method.name, method.summary, fits_text(method),
             obstacle.empty() ? "" : fmt::format("\nIt can't run: {}.", obstacle),
             method.options.empty() ? "No options." : "Options:");
  for (const OptionInfo& info : method.options)
    fmt::print("  {:<18} {}\n  {:<18} {}; default {}{}{}\n", info.name, info.meaning, "",
               allowed_values(info), default_text(info),
               info.self_start_fallback
                   ? fmt::format(", with \"start\": \"self\" {}", *info.self_start_fallback != 0.0)
                   : "",
               info.scope == OptionScope::everywhere ? "" : fmt::format("; only with {}", scope_text(info)));
  if (method.outside == nullptr) {
    const std::string declared = declarations_text(method);
    fmt::print("\n{}{}{}", declared, declared.empty() ? "" : "\n\n", sheet_text(method));
  }
  fmt::print(
      "\n"
      "In a study:\n  {{\"name\": \"{}\"",
      method.name);
  for (const OptionInfo& info : method.options)
    if (info.scope == OptionScope::everywhere && !info.unsaid)
      fmt::print(", \"{}\": {}", info.name, default_text(info));
  fmt::print("}}\n");
}

void describe_problem(const ProblemInfo& problem) {
  fmt::print("{}: {}\n\nFormulations:\n", problem.name, problem.summary);
  for (const FormulationInfo& info : problem.formulations)
    fmt::print("  {:<18} {}\n", info.name, info.summary);
  fmt::print("\nParameters:\n");
  for (const ParameterInfo& info : problem.parameters)
    fmt::print("  {:<18} {}{}\n  {:<18} {}; default {}\n", info.name, info.meaning,
               info.unit.empty() ? "" : fmt::format(" [{}]", info.unit), "", info.shape,
               info.fallback.dump());
  fmt::print(
      "\n"
      "In a study:\n  {{\"name\": \"{}\", \"formulation\": \"{}\", \"parameters\": {{\"{}\": {}}}}}\n",
      problem.name, problem.formulations.front().name, problem.parameters.back().name,
      problem.parameters.back().fallback.dump());
}

// What a part of a schema says of its values; of a reference, what that says.
std::string schema_text(const Json& part, const Json& schema) {
  if (part.contains("description")) return part.at("description");
  if (part.contains("$ref"))
    return schema_text(schema.at(Json::json_pointer(part.at("$ref").get<std::string>().substr(1))), schema);
  if (part.contains("allOf")) return schema_text(part.at("allOf").front(), schema);
  if (part.contains("enum")) {
    std::vector<std::string> words;
    for (const Json& word : part.at("enum"))
      words.push_back(word.is_string() ? word.get<std::string>() : word.dump());
    return quoted_list(words);
  }
  return part.value("type", "");
}

void describe_effect(const Json& effect) {
  const Json schema = scene_schema();
  const Json required = effect.value("required", Json::array());
  fmt::print("{}: {}\n\nKeys:\n", effect_name(effect),
             effect.at("properties").at("type").at("description").get<std::string>());
  for (const auto& [key, part] : effect.at("properties").items()) {
    if (key == "type") continue;
    const bool needed = std::find(required.begin(), required.end(), key) != required.end();
    fmt::print("  {:<24} {}{}\n", key, schema_text(part, schema), needed ? "; required" : "");
  }
  fmt::print(
      "\n"
      "In a scene, among its \"effects\":\n  {{\"type\": \"{}\", ...}}   (docs/scenes.md)\n",
      effect_name(effect));
}

void describe_case(const StabilityCase& entry) {
  fmt::print("{}: {}\n\nCriterion: {}.\nTheory: {}.\n\nTrials:\n", entry.name, entry.question,
             entry.criterion, entry.theory);
  std::vector<std::string> variants;
  for (const Trial& trial : entry.trials())
    if (std::find(variants.begin(), variants.end(), trial.variant) == variants.end())
      variants.push_back(trial.variant);
  for (const std::string& variant : variants) fmt::print("  {}\n", variant);
  fmt::print("\nliebench stability --only {}\n", entry.name);
}

void describe(const std::string& name) {
  std::vector<std::string> names{"record", "study", "scene", "stability"};
  if (std::find(names.begin(), names.end(), name) != names.end())
    return fmt::print("{}", embedded_file(name + ".schema.json"));
  if (name == "integrators") return fmt::print("{}", integrators_page());
  names.push_back("integrators");
  for (const MethodInfo& method : methods()) {
    if (method.name == name) return describe_method(method);
    names.emplace_back(method.name);
  }
  for (const ProblemInfo& problem : problems()) {
    if (problem.name == name) return describe_problem(problem);
    names.emplace_back(problem.name);
  }
  for (const Json& effect : effects()) {
    if (effect_name(effect) == name) return describe_effect(effect);
    names.push_back(effect_name(effect));
  }
  for (const StabilityCase& entry : stability_cases()) {
    if (entry.name == name) return describe_case(entry);
    names.emplace_back(entry.name);
  }
  throw InputError("describe", fmt::format("unknown name \"{}\"; allowed: {}{}", name, quoted_list(names),
                                           suggestion(name, names)));
}

}  // namespace

void add_list(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("list", "List what the program knows");
  auto what = std::make_shared<std::string>();
  command->add_option("what", *what, "problems, integrators, effects, scenes or stability")
      ->required()
      ->check(CLI::IsMember({"problems", "integrators", "effects", "scenes", "stability"}));
  command->footer("Example:\n  liebench list integrators");
  command->callback([what] { list(*what); });
}

void add_describe(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand(
      "describe",
      "Say what an integrator, a problem, an effect or a hard case is and what it "
      "takes; integrators: a page with the sheet of each of them; record, study, scene, stability: the "
      "JSON schema");
  auto name = std::make_shared<std::string>();
  command
      ->add_option("name", *name,
                   "a name from `liebench list`, or integrators, record, study, scene or stability")
      ->required()
      ->type_name("NAME");
  command->footer("Example:\n  liebench describe heavy_top");
  command->callback([name] { describe(*name); });
}

}  // namespace liebench
