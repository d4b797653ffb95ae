#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "harness/cli/commands.h"
#include "harness/errors.h"
#include "harness/record.h"
#include "harness/record_file.h"
#include "harness/select.h"
#include "harness/tables.h"

namespace liebench {

namespace {

struct TableOptions {
  std::vector<std::string> files;
  std::string kind = "orders";
  std::string format = "markdown";
  std::string out;
};

void table(const TableOptions& options) {
  std::vector<Json> records;
  for (const std::string& file : options.files)
    for (Json& record : read_records(file)) records.push_back(std::move(record));
  if (records.empty()) throw InputError(options.files.front(), "holds no records");
  const Table result = options.kind == "orders" ? orders_table(records) : outcomes_table(records);
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
      ->add_option("--kind", options->kind,
                   "orders: observed orders of convergence with window and uncertainty;\n"
                   "outcomes: how the runs ended, and where those stood that failed")
      ->check(CLI::IsMember({"orders", "outcomes"}))
      ->capture_default_str();
  command->add_option("--format", options->format, "how it is written")
      ->check(CLI::IsMember({"markdown", "latex", "csv"}))
      ->capture_default_str();
  command->add_option("--out", options->out, "file; standard output where absent")->type_name("FILE");
  command->footer("Example:\n  liebench table figure4.jsonl --kind orders --format latex --out orders.tex");
  command->callback([options] { table(*options); });
}

}  // namespace liebench
