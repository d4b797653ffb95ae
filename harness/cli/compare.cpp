#include "harness/compare.h"

#include <fmt/format.h>

#include "harness/cli/commands.h"
#include "harness/errors.h"
#include "harness/record_reader.h"

namespace liebench {

namespace {

struct CompareOptions {
  std::string before, after;
  double band = default_band;
  bool times = false;
  bool common = false;
  bool skip_bad_lines = false;
};

bool compare(const CompareOptions& options) {
  const BadLines bad_lines = options.skip_bad_lines ? BadLines::skip : BadLines::reject;
  const auto read = [&](const std::string& file) {
    std::vector<RecordRow> records = read_records({file}, bad_lines);
    if (records.empty()) throw InputError(file, "holds no records");
    return records;
  };
  Comparison comparison = compare_records(read(options.before), read(options.after), options.band);
  if (options.common) {
    comparison.missing.clear();
    comparison.added.clear();
    if (comparison.matched == 0)
      throw InputError("--common", "the two files have no run in common: nothing is compared");
  }
  fmt::print("{}", report(comparison));
  return comparison.differs(options.times);
}

}  // namespace

void add_compare(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("compare", "Say what changed between two files of records");
  auto options = std::make_shared<CompareOptions>();
  command->add_option("old", options->before, "file of records")->required()->type_name("OLD.jsonl");
  command->add_option("new", options->after, "file of records")->required()->type_name("NEW.jsonl");
  command->add_flag("--common", options->common, "rows that one of the files lacks are no difference");
  command
      ->add_option("--band", options->band,
                   "errors may differ by 1e-6 of the larger and band * eps * steps * size:\n"
                   "eps the unit round-off, size 1 or, for absolute errors, that of the solution")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_flag("--times", options->times,
                    "a time that changed is a difference, too: rank test at 1 % and more than 10 %");
  command->add_flag("--skip-bad-lines", options->skip_bad_lines,
                    "name lines that are no records on standard error and use the others");
  command->footer(
      "Outcomes and counts must be equal. Exit status: 0 nothing changed, 1 something did.\n"
      "Example:\n  liebench compare results/figure4.jsonl figure4.jsonl");
  command->callback([options, &status] { status = compare(*options) ? 1 : 0; });
}

}  // namespace liebench
