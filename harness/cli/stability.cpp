#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <set>

#include "harness/cli/commands.h"
#include "harness/errors.h"
#include "harness/execute.h"
#include "harness/progress.h"
#include "harness/record_file.h"
#include "harness/stability/linear_growth.h"
#include "harness/stability/report.h"
#include "harness/stability/suite.h"
#include "plots/gnuplot.h"

namespace liebench {

namespace {

struct StabilityOptions {
  std::vector<std::string> only;
  std::string out = "stability";
  int jobs = default_jobs();
  bool quick = false;
};

int stability(const StabilityOptions& options) {
  const std::vector<SuiteTrial> trials = suite(options.only, options.quick);
  if (options.out.empty()) throw InputError("--out", "is empty; a folder is expected");
  require_gnuplot();
  const std::filesystem::path out(options.out);
  require_writable_folder(out);
  RecordFile file(out / "stability.jsonl", parse_stability_record);
  std::vector<SuiteTrial> missing;
  std::vector<std::string> keys;
  double work = 0.0;
  for (const SuiteTrial& trial : trials) {
    keys.push_back(trial.key());
    if (file.has(keys.back())) continue;
    work += trial.trial.work;
    missing.push_back(trial);
  }
  {
    Progress progress("stability", work);
    run_suite(missing, options.jobs, progress, [&](std::size_t, const Json& record) { file.append(record); });
  }
  // Pictures and tables show all that the file holds of the suite, of earlier commands, too; what is not of it any more goes to its end.
  std::vector<std::string> known;
  for (const SuiteTrial& trial : suite({}, false))
    if (std::string key = trial.key(); file.has(key)) known.push_back(std::move(key));
  file.sort(known);
  std::vector<Json> records;
  for (const std::string& key : known) records.push_back(file.record(key));
  const std::vector<std::filesystem::path> pictures{out / "stability.svg", out / "stability.pdf",
                                                    out / "stability.png"};
  draw(stability_map(records), pictures);
  if (options.only.empty() ||
      std::find(options.only.begin(), options.only.end(), "stiffness") != options.only.end()) {
    const std::vector<std::filesystem::path> regions{
        out / "stability_regions.svg", out / "stability_regions.pdf", out / "stability_regions.png"};
    draw(stability_regions(options.jobs), regions);
  }
  write_whole(out / "stability.md", stability_report(records));
  write_whole(out / "stability.csv", to_csv(stability_list(records)));
  std::string latex;
  for (const char* form : {"", "index3", "stabilized_index2"}) {
    const Table matrix = stability_matrix(records, form);
    if (!matrix.rows().empty()) latex += to_latex(matrix) + "\n";
  }
  write_whole(out / "stability.tex", latex);

  int surprises = 0;
  const std::set<std::string> asked(keys.begin(), keys.end());
  for (const Json& record : records)
    if (!plain(record) && asked.contains(record.at("key").get<std::string>()) &&
        (record.at("verdict") == name(Verdict::failed_unexpectedly) ||
         record.at("verdict") == name(Verdict::passed_unexpectedly))) {
      // All of them stand in the tables.
      if (++surprises <= 10)
        fmt::print(stderr, "{}, {}, {}{}: {} where theory says {} ({})\n",
                   record.at("case").get<std::string>(), record.at("variant").get<std::string>(),
                   record.at("subject").get<std::string>(),
                   record.contains("form") ? ", " + record["form"].get<std::string>() : "",
                   record.at("grade").get<std::string>(), record.at("expected").get<std::string>(),
                   record.at("reason").get<std::string>());
    }
  fmt::print("{} trials, {} surprises; {}\n", trials.size(), surprises, (out / "stability.svg").string());
  if (missing.size() < trials.size())
    fmt::print(stderr, "{} trials were there already\n", trials.size() - missing.size());
  return surprises == 0 ? 0 : 1;
}

}  // namespace

void add_stability(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "stability",
      "Hard cases: which method survives what, as theory says or against it; records, picture and tables");
  auto options = std::make_shared<StabilityOptions>();
  command->add_option("--only", options->only, "only these cases; liebench list stability")
      ->delimiter(',')
      ->type_name("CASE,...");
  command
      ->add_option("--out", options->out,
                   "folder for records, picture and tables; what is there is not run again")
      ->type_name("DIR")
      ->capture_default_str();
  command->add_option("--jobs", options->jobs, "trials at a time; the records do not depend on it")
      ->type_name("N")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command->add_flag("--quick", options->quick, "the fast half: no long runs");
  command->footer(
      "Examples:\n  liebench stability                                   all cases, into stability/\n"
      "  liebench stability --only stiffness,singular --out /tmp/s\n"
      "  liebench describe stiffness                          what a case asks, and why\n"
      "Exit status 1: a method did worse, or better, than theory says.");
  command->callback([options, &status] { status = stability(*options); });
}

}  // namespace liebench
