#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "harness/cli/commands.h"
#include "harness/cli/scene_plan.h"
#include "harness/errors.h"
#include "harness/problems.h"
#include "harness/scene_problem.h"
#include "harness/scene_reader.h"
#include "harness/strict_json.h"
#include "harness/table.h"

namespace liebench {

namespace {

struct CheckProblemOptions {
  std::string problem;
  std::vector<std::string> formulations;
  std::string parameters;
  std::string format = "markdown";
  bool json = false;
};

struct FormulationCheck {
  std::string formulation;
  SystemCheck check;
};

bool is_scene(const std::string& text) {
  return std::filesystem::path(text).extension() == ".json" || text.find('/') != std::string::npos ||
         text.starts_with(builtin_prefix);
}

const ProblemInfo& problem_of(const CheckProblemOptions& options) {
  std::vector<std::string> names;
  for (const ProblemInfo& problem : problems()) {
    if (problem.name == options.problem) return problem;
    names.emplace_back(problem.name);
  }
  if (!is_scene(options.problem))
    throw InputError("check-problem",
                     fmt::format("unknown problem \"{}\"; allowed: {}, or a scene, a file whose name ends in "
                                 ".json{}",
                                 options.problem, quoted_list(names), suggestion(options.problem, names)));
  if (!options.parameters.empty())
    throw InputError("--parameters", "is not allowed for a scene: its parameters stand in its file");
  assembled_scene(options.problem);  // says what was done to it
  return scene_problem(options.problem);
}

// All of them where none is named.
std::vector<std::string> formulations_of(const CheckProblemOptions& options, const ProblemInfo& problem) {
  std::vector<std::string> known;
  for (const FormulationInfo& info : problem.formulations) known.emplace_back(info.name);
  if (options.formulations.empty()) return known;
  for (const std::string& name : options.formulations)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError("--formulation",
                       fmt::format("\"{}\" is no formulation of {}; allowed: {}{}", name, problem.name,
                                   quoted_list(known), suggestion(name, known)));
  return options.formulations;
}

Json parameters_of(const CheckProblemOptions& options, const ProblemInfo& problem) {
  const Json given =
      options.parameters.empty() ? Json::object() : parse_json(options.parameters, "--parameters");
  return problem.complete(JsonView(given, "--parameters "));
}

Table check_table(const ProblemInfo& problem, const FormulationCheck& entry) {
  const SystemCheck& check = entry.check;
  const auto failed =
      std::count_if(check.laws.begin(), check.laws.end(), [](const LawCheck& law) { return !law.holds; });
  Table table(
      fmt::format("{}, {}: {} of {} laws hold; the worst entry of each, of {} points", problem.name,
                  entry.formulation, check.laws.size() - std::size_t(failed), check.laws.size(),
                  check.points),
      {{.header = "law"},
       {.header = "holds", .kind = ColumnKind::mark, .alignment = Alignment::centre},
       {.header = "entry"},
       {.header = "point"},
       {.header = "value", .kind = ColumnKind::number, .alignment = Alignment::right, .digits = 6},
       {.header = "expected", .kind = ColumnKind::number, .alignment = Alignment::right, .digits = 6},
       {.header = "difference", .kind = ColumnKind::number, .alignment = Alignment::right, .digits = 2},
       {.header = "allowed", .kind = ColumnKind::number, .alignment = Alignment::right, .digits = 2},
       {.header = "numbers", .kind = ColumnKind::integer, .alignment = Alignment::right}});
  for (const LawCheck& law : check.laws) {
    // Of a bound there is no difference, and what is allowed is more than it.
    const bool bound = is_bound(law.law);
    table.add_row({std::string(info(law.law).name), law.holds, entry_name(law), point_name(law), law.value,
                   bound ? Cell{} : Cell{law.expected}, bound ? Cell{} : Cell{law.difference()},
                   law.tolerance(), std::int64_t(law.compared)});
  }
  return table;
}

// A number that is none has no place in JSON: its name.
Json number(double x) {
  if (std::isfinite(x)) return x;
  return std::isnan(x) ? "nan" : x < 0.0 ? "-inf" : "inf";
}

Json check_json(const FormulationCheck& entry) {
  Json result;
  result["formulation"] = entry.formulation;
  result["holds"] = entry.check.holds();
  result["points"] = entry.check.points;
  result["differences"] = entry.check.extended ? "extended" : "double";
  result["laws"] = Json::array();
  for (const LawCheck& law : entry.check.laws) {
    Json row;
    row["law"] = info(law.law).name;
    row["formula"] = info(law.law).formula;
    row["holds"] = law.holds;
    row["point"] = law.point;
    if (!law.row.empty()) row["row"] = law.row;
    if (!law.column.empty()) row["column"] = law.column;
    row["value"] = number(law.value);
    if (!is_bound(law.law)) row["expected"] = number(law.expected);
    row["round_off"] = number(law.round_off);
    row["difference_error"] = number(law.difference_error);
    row["compared"] = law.compared;
    result["laws"].push_back(std::move(row));
  }
  return result;
}

bool check_problem(const CheckProblemOptions& options) {
  const ProblemInfo& problem = problem_of(options);
  const std::vector<std::string> formulations = formulations_of(options, problem);
  const Json parameters = parameters_of(options, problem);
  std::vector<FormulationCheck> checks;
  for (const std::string& name : formulations) checks.push_back({name, problem.check(name, parameters)});
  bool holds = true;
  if (options.json) {
    Json result;
    result["problem"] = problem.name;
    result["parameters"] = parameters;
    for (const FormulationCheck& entry : checks) result["formulations"].push_back(check_json(entry));
    fmt::print("{}\n", result.dump(2));
  } else {
    const TableFormat format = options.format == "latex" ? TableFormat::latex
                               : options.format == "csv" ? TableFormat::csv
                                                         : TableFormat::markdown;
    for (const FormulationCheck& entry : checks)
      fmt::print("{}{}", &entry == &checks.front() ? "" : "\n", render(check_table(problem, entry), format));
  }
  for (const FormulationCheck& entry : checks)
    for (const LawCheck& law : entry.check.laws)
      if (!law.holds) {
        holds = false;
        fmt::print(stderr, "{}, {}: {}\n", problem.name, entry.formulation, message(law));
      }
  return holds;
}

}  // namespace

void add_check_problem(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "check-problem",
      "Whether the functions of a problem or scene agree: derivatives, mass, energy, initial values");
  auto options = std::make_shared<CheckProblemOptions>();
  command
      ->add_option("problem", options->problem,
                   "a problem (liebench list problems), or a scene, a JSON file (docs/scenes.md)")
      ->required()
      ->type_name("NAME|SCENE.json");
  command->add_option("--formulation", options->formulations, "only these; all where absent")
      ->delimiter(',')
      ->type_name("NAME,...");
  command
      ->add_option("--parameters", options->parameters,
                   "parameters of the problem as in a study, a JSON object; liebench describe NAME")
      ->type_name("JSON");
  command->add_option("--format", options->format, "of the table")
      ->type_name("FORMAT")
      ->check(CLI::IsMember({"markdown", "latex", "csv"}))
      ->capture_default_str();
  command->add_flag("--json", options->json, "all numbers as one JSON object in place of the table");
  command->footer(
      "Examples:\n"
      "  liebench check-problem heavy_top\n"
      "  liebench check-problem heavy_top --formulation SO3,SE3 --parameters '{\"mass\": 2}'\n"
      "  liebench check-problem builtin:bricard --json\n"
      "The laws, and what is allowed: docs/checks.md. Exit status: 0 all laws hold; 1 one fails, named with "
      "its\n"
      "entry and both numbers on standard error; 2 bad input.");
  command->callback([options, &status] { status = check_problem(*options) ? 0 : 1; });
}

}  // namespace liebench
