#include <fmt/format.h>

#include "harness/cli/commands.h"
#include "harness/embedded.h"
#include "harness/errors.h"
#include "harness/methods.h"
#include "harness/problems.h"

namespace liebench {

namespace {

void list(const std::string& what) {
  if (what == "problems") {
    for (const ProblemInfo& problem : problems()) fmt::print("{:<20} {}\n", problem.name, problem.summary);
    return;
  }
  for (const MethodInfo& method : methods()) fmt::print("{:<20} {}\n", method.name, method.summary);
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
  fmt::print("{}: {}\n\nOptions:\n", method.name, method.summary);
  for (const OptionInfo& info : method.options)
    fmt::print("  {:<18} {}\n  {:<18} {}; default {}{}{}\n", info.name, info.meaning, "",
               allowed_values(info), default_text(info),
               info.self_start_fallback
                   ? fmt::format(", with \"start\": \"self\" {}", *info.self_start_fallback != 0.0)
                   : "",
               info.scope == OptionScope::everywhere ? "" : fmt::format("; only with {}", scope_text(info)));
  fmt::print(
      "\n"
      "In a study:\n  {{\"name\": \"{}\"",
      method.name);
  for (const OptionInfo& info : method.options)
    if (info.scope == OptionScope::everywhere) fmt::print(", \"{}\": {}", info.name, default_text(info));
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

void describe(const std::string& name) {
  std::vector<std::string> names{"record", "study"};
  if (name == "record" || name == "study") return fmt::print("{}", embedded_file(name + ".schema.json"));
  for (const MethodInfo& method : methods()) {
    if (method.name == name) return describe_method(method);
    names.emplace_back(method.name);
  }
  for (const ProblemInfo& problem : problems()) {
    if (problem.name == name) return describe_problem(problem);
    names.emplace_back(problem.name);
  }
  throw InputError("describe", fmt::format("unknown name \"{}\"; allowed: {}{}", name, quoted_list(names),
                                           suggestion(name, names)));
}

}  // namespace

void add_list(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("list", "List what the program knows");
  auto what = std::make_shared<std::string>();
  command->add_option("what", *what, "problems or integrators")
      ->required()
      ->check(CLI::IsMember({"problems", "integrators"}));
  command->footer("Example:\n  liebench list integrators");
  command->callback([what] { list(*what); });
}

void add_describe(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand(
      "describe", "Say what an integrator or a problem is and what it takes; record, study: the JSON schema");
  auto name = std::make_shared<std::string>();
  command->add_option("name", *name, "a name from `liebench list`, or record or study")
      ->required()
      ->type_name("NAME");
  command->footer("Example:\n  liebench describe heavy_top");
  command->callback([name] { describe(*name); });
}

}  // namespace liebench
