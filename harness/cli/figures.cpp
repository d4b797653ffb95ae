#include "harness/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>

#include "harness/cli/commands.h"
#include "harness/cost_report.h"
#include "harness/embedded.h"
#include "harness/errors.h"
#include "harness/execute.h"
#include "harness/field.h"
#include "harness/formulations.h"
#include "harness/outside/outside_methods.h"
#include "harness/progress.h"
#include "harness/record.h"
#include "harness/record_file.h"
#include "harness/record_reader.h"
#include "harness/study.h"
#include "harness/timing.h"
#include "harness/unfinished.h"
#include "harness/verification.h"
#include "plots/gnuplot.h"

namespace liebench {

namespace {

struct FigureOptions {
  std::vector<std::string> only;
  std::string out = "reproduced";
  int jobs = default_jobs();
  bool short_form = false;
};

// The short form leaves out step sizes below this: seconds instead of minutes, orders less sharp.
constexpr double shortest_step_of_short_form = 1e-4;

// The runs of all studies of a figure.
std::vector<RunSpec> figure_runs(const PaperFigure& figure, bool short_form) {
  std::vector<RunSpec> runs;
  std::vector<std::string_view> files = figure.studies;
  if (outside_obstacle().empty())
    files.insert(files.end(), figure.outside_studies.begin(), figure.outside_studies.end());
  else if (!figure.outside_studies.empty())
    fmt::print(stderr, "{}: without solvers from outside: {}\n", figure.name, outside_obstacle());
  for (const std::string_view file : files) {
    const Study study = read_study(parse_json(embedded_file(file), std::string(file)));
    for (const RunSpec& run : study.runs)
      if (run.local_steps > 0 || !short_form || run.method->chooses_steps ||
          run.requested_step_size >= shortest_step_of_short_form * (1.0 - 1e-12))
        runs.push_back(run);
  }
  return runs;
}

std::string json_lines(const std::vector<Json>& records) {
  std::string text;
  for (const Json& record : records) text += record.dump() + '\n';
  return text;
}

// The times of the figures that show them, after all other runs.
void add_times(const std::vector<PaperFigure>& chosen, const std::vector<RunSpec>& runs,
               const std::vector<std::size_t>& ends, std::vector<Json>& records,
               UnfinishedRecords& unfinished) {
  std::vector<RunSpec> timed;
  std::vector<std::size_t> places;
  for (std::size_t number = 0, i = 0; number < chosen.size(); ++number)
    for (; i < ends[number]; ++i)
      if (chosen[number].timed && is_timed(runs[i]) && records[i].at("outcome") == "ok" &&
          !records[i].contains("time")) {
        timed.push_back(runs[i]);
        places.push_back(i);
      }
  Progress progress("times", double(timed.size()));
  time_runs(timed, TimingRules{}, ReferenceCache(), progress, [&](std::size_t index, const RunTimes& times) {
    Json& record = records[places[index]];
    record = with_time(record, times);
    unfinished.append(timed[index], record);
  });
}

int figures(const FigureOptions& options) {
  std::vector<PaperFigure> chosen;
  std::vector<std::string> names;
  for (const PaperFigure& figure : paper_figures()) names.emplace_back(figure.name);
  for (const std::string& name : options.only)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw InputError("--only", fmt::format("unknown figure \"{}\"; allowed: {}{}", name, quoted_list(names),
                                             suggestion(name, names)));
  for (const PaperFigure& figure : paper_figures())
    if (options.only.empty() ||
        std::find(options.only.begin(), options.only.end(), figure.name) != options.only.end())
      chosen.push_back(figure);
  if (options.out.empty()) throw InputError("--out", "is empty; a folder is expected");
  require_gnuplot();
  const std::filesystem::path out(options.out);
  require_writable_folder(out);

  std::vector<RunSpec> runs;
  std::vector<std::size_t> ends;  // of the runs of each figure
  for (const PaperFigure& figure : chosen) {
    for (RunSpec& run : figure_runs(figure, options.short_form)) runs.push_back(std::move(run));
    ends.push_back(runs.size());
  }
  UnfinishedRecords unfinished(out, runs);
  std::vector<Json> records(runs.size());
  std::vector<RunSpec> missing;
  std::vector<std::size_t> places;
  double work = 0.0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (auto record = unfinished.record(runs[i])) {
      records[i] = *std::move(record);
      if (options.short_form) records[i].erase("time");
      continue;
    }
    missing.push_back(runs[i]);
    places.push_back(i);
    work += expected_work(runs[i]);
  }
  if (missing.size() < runs.size())
    fmt::print(stderr, "figures: goes on where it was stopped, {} of {} runs are there\n",
               runs.size() - missing.size(), runs.size());
  {
    Progress progress("figures", work);
    execute(missing, options.jobs, ReferenceCache(), progress, [&](std::size_t index, const Json& record) {
      unfinished.append(missing[index], record);
      records[places[index]] = record;
    });
  }
  if (!options.short_form) add_times(chosen, runs, ends, records, unfinished);
  const auto failures = std::count_if(records.begin(), records.end(),
                                      [](const Json& record) { return record.at("outcome") != "ok"; });

  const std::vector<RecordRow> all_rows = record_rows(records);
  std::map<std::string, std::vector<RecordRow>> by_study;
  for (std::size_t i = 0; i < runs.size(); ++i) by_study[runs[i].study].push_back(all_rows[i]);
  std::size_t begin = 0;
  for (std::size_t number = 0; number < chosen.size(); ++number) {
    const PaperFigure& figure = chosen[number];
    const auto first = std::ptrdiff_t(begin), last = std::ptrdiff_t(ends[number]);
    begin = ends[number];
    write_whole(out / fmt::format("{}.jsonl", figure.name),
                json_lines({records.begin() + first, records.begin() + last}));
    const std::vector<RecordRow> rows(all_rows.begin() + first, all_rows.begin() + last);
    if (figure.name == "cost_accuracy") write_whole(out / "cost_accuracy.md", cost_report(rows));
    if (figure.name == "field") write_whole(out / "field_tables.md", field_report(rows));
    if (figure.name == "formulations") write_whole(out / "formulations.md", formulations_report(rows));
    std::filesystem::path shown = out / fmt::format("{}.jsonl", figure.name);
    for (const auto& [name, picture] : draw_paper_figure(figure, rows)) {
      std::vector<std::filesystem::path> files;
      for (const char* ending : {"svg", "pdf", "png"})
        files.push_back(out / fmt::format("{}.{}", name, ending));
      draw(picture, files);
      if (name == figure.name) shown = files.front();
    }
    fmt::print("{}: {} runs, {}\n", figure.name, rows.size(), shown.string());
  }
  const std::string note =
      options.short_form
          ? fmt::format(
                "This is the short form: no step size below {} s, so that slopes that settle later "
                "are not shown.",
                shortest_step_of_short_form)
          : "";
  const Verification verification = verify(by_study, note);
  write_whole(out / "verification.md", verification.markdown);
  if (!verification.csv.empty()) write_whole(out / "verification.csv", verification.csv);
  unfinished.remove();
  fmt::print("verification: {} of {} claims confirmed, {}\n", verification.confirmed, verification.claims,
             (out / "verification.md").string());
  if (failures > 0)
    fmt::print("{} of {} runs failed numerically (step size too large); they are marked in the figures\n",
               failures, runs.size());
  return options.short_form || verification.confirmed == verification.claims ? 0 : 1;
}

}  // namespace

void add_figures(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "figures", "Reproduce Figures 1 to 4 of the paper: records, pictures and the table of orders");
  auto options = std::make_shared<FigureOptions>();
  command->add_option("--only", options->only, "only these figures")
      ->delimiter(',')
      ->type_name("figure1,figure3");
  command->add_option("--out", options->out, "folder for records, pictures and verification.md")
      ->type_name("DIR")
      ->capture_default_str();
  command->add_option("--jobs", options->jobs, "runs at a time; the records do not depend on it")
      ->type_name("N")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command->add_flag("--short", options->short_form,
                    fmt::format("leave out step sizes below {} s, and times: seconds instead of minutes",
                                shortest_step_of_short_form));
  command->footer(
      "Examples:\n  liebench figures                          all, into reproduced/\n"
      "  liebench figures --only figure3 --out /tmp/f3\n"
      "A job killed half-way goes on where it stopped when the same command is given again.\n"
      "Exit status 1: a claim of the paper was not confirmed (not with --short); see verification.md.");
  command->callback([options, &status] { status = figures(*options); });
}

}  // namespace liebench
