#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/cli/commands.h"
#include "harness/cost_accuracy.h"
#include "harness/errors.h"
#include "harness/record_file.h"
#include "harness/record_reader.h"
#include "harness/select.h"
#include "harness/tables.h"

namespace liebench {

namespace {

struct TableOptions {
  std::vector<std::string> files;
  std::string kind = "orders";
  std::string format = "markdown";
  std::string y = "q";
  std::string norm = "end_relative";
  std::vector<double> targets = default_targets;
  double step_size = 0;  // 0: the finest
  bool skip_bad_lines = false;
  std::string out;
};

Table table_of(const std::vector<RecordRow>& records, const TableOptions& options) {
  if (options.kind == "orders") return orders_table(records);
  if (options.kind == "outcomes") return outcomes_table(records);
  if (options.kind == "invariants") return invariants_table(records);
  if (options.kind == "costs") {
    if (options.step_size == 0) return costs_table(records);
    Table costs = costs_table(records, options.step_size);
    if (costs.rows().empty())
      throw InputError("--step-size", fmt::format("no run of step size {} ended well", options.step_size));
    return costs;
  }
  const Quantity quantity{options.y, options.norm};
  if (std::none_of(records.begin(), records.end(),
                   [&](const RecordRow& record) { return error_of(record, quantity).has_value(); }))
    throw InputError("--y", fmt::format("no record has an error of {}; choose another component", options.y));
  return cost_accuracy_table(records, quantity, options.targets);
}

void table(const TableOptions& options) {
  for (const double target : options.targets)
    if (!std::isfinite(target) || target <= 0)
      throw InputError("--target", fmt::format("{} is not allowed; allowed: positive numbers", target));
  const std::vector<RecordRow> records =
      read_records(std::vector<std::filesystem::path>(options.files.begin(), options.files.end()),
                   options.skip_bad_lines ? BadLines::skip : BadLines::reject);
  if (records.empty()) throw InputError(options.files.front(), "holds no records");
  const Table result = table_of(records, options);
  const TableFormat format = options.format == "latex" ? TableFormat::latex
                             : options.format == "csv" ? TableFormat::csv
                                                       : TableFormat::markdown;
  const std::string text = render(result, format);
  if (options.out.empty())
    fmt::print("{}", text);
  else
    write_whole(options.out, text);
}

}  // namespace

void add_table(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("table", "Make a table of records");
  auto options = std::make_shared<TableOptions>();
  command->add_option("files", options->files, "files of records")->required()->type_name("FILE.jsonl...");
  command
      ->add_option(
          "--kind", options->kind,
          "cost-accuracy: what a given error costs, the cheapest curve marked;\n"
          "costs: counts and time of a step;\n"
          "invariants: drift of energy, momentum and constraints, and up to when a chaotic scene is right;\n"
          "orders: observed orders of convergence with window and uncertainty;\n"
          "outcomes: how the runs ended, and where those stood that failed")
      ->check(CLI::IsMember({"cost-accuracy", "costs", "invariants", "orders", "outcomes"}))
      ->capture_default_str();
  command->add_option("--target", options->targets, "cost-accuracy: the errors to reach")
      ->delimiter(',')
      ->type_name("E,...")
      ->default_str("1e-2,1e-3,...,1e-10");
  command->add_option("--y", options->y, "cost-accuracy: the error of which component")
      ->check(CLI::IsMember({"q", "v", "lambda"}))
      ->capture_default_str();
  command->add_option("--norm", options->norm, "cost-accuracy: in which norm")
      ->check(CLI::IsMember({"end_relative", "end_absolute", "max_absolute"}))
      ->capture_default_str();
  command
      ->add_option("--step-size", options->step_size,
                   "costs: of the runs of this step size; the finest that ended well where absent")
      ->check(positive_number())
      ->type_name("H");
  command->add_flag("--skip-bad-lines", options->skip_bad_lines,
                    "name lines that are no records on standard error and use the others");
  command->add_option("--format", options->format, "how it is written")
      ->check(CLI::IsMember({"markdown", "latex", "csv"}))
      ->capture_default_str();
  command->add_option("--out", options->out, "file; standard output where absent")->type_name("FILE");
  command->footer(
      "Examples:\n"
      "  liebench table figure4.jsonl --kind orders --format latex --out orders.tex\n"
      "  liebench table study.jsonl --kind cost-accuracy --y lambda --target 1e-3,1e-6\n"
      "  liebench table study.jsonl --kind costs --step-size 1e-3 --format csv\n"
      "The rules of each table: docs/tables.md");
  command->callback([options] { table(*options); });
}

}  // namespace liebench
