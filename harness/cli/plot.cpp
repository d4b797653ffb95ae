#include <fmt/format.h>

#include <cstdio>

#include "harness/cli/commands.h"
#include "harness/errors.h"
#include "harness/record_plots.h"
#include "harness/record_reader.h"
#include "plots/gnuplot.h"

namespace liebench {

namespace {

struct PlotOptions {
  std::vector<std::string> files;
  std::string kind = "convergence";
  std::string x;
  std::string y = "q";
  std::string norm = "end_relative";
  std::string out;
  bool one_panel = false;
  bool skip_bad_lines = false;
};

RecordFigure make_figure(const PlotOptions& options, const std::vector<RecordRow>& records) {
  if (options.kind == "drift") {
    if (!options.x.empty() && options.x != "step_size")
      throw InputError("--x", "a drift is drawn against step_size; leave it out");
    RecordFigure result = drift_figure(records);
    if (result.figure.panels.empty())
      throw InputError(options.files.front(), "no run ended well, and those that failed have no drift");
    return result;
  }
  const Abscissa& x = !options.x.empty()                 ? abscissa(options.x)
                      : options.kind == "work-precision" ? dearest_abscissa(records)
                                                         : abscissa("step_size");
  RecordFigure result = error_figure(records, x, {options.y, options.norm}, !options.one_panel);
  if (!result.figure.panels.empty()) return result;
  std::vector<std::string> there;
  for (const Abscissa& other : abscissae())
    if (!error_figure(records, other, {options.y, options.norm}, false).figure.panels.empty())
      there.emplace_back(other.name);
  if (there.empty())
    throw InputError("--y", fmt::format("no record has an error of {}; choose another component", options.y));
  throw InputError("--x", fmt::format("no record has \"{}\"; these have: {}", x.name, quoted_list(there)));
}

void plot(const PlotOptions& options) {
  require_gnuplot();
  const std::vector<RecordRow> records =
      read_records(std::vector<std::filesystem::path>(options.files.begin(), options.files.end()),
                   options.skip_bad_lines ? BadLines::skip : BadLines::reject);
  if (records.empty()) throw InputError(options.files.front(), "holds no records");
  const RecordFigure result = make_figure(options, records);
  if (result.left_out > 0)
    fmt::print(stderr, "{} of {} records have no value on this abscissa and are left out\n", result.left_out,
               records.size());
  draw(result.figure, std::vector<std::filesystem::path>{options.out});
}

}  // namespace

void add_plot(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("plot", "Draw records by gnuplot");
  auto options = std::make_shared<PlotOptions>();
  command->add_option("files", options->files, "files of records")->required()->type_name("FILE.jsonl...");
  command
      ->add_option("--kind", options->kind,
                   "convergence: error against step size;\n"
                   "work-precision: error against what it costs;\n"
                   "drift: energy, momentum, constraints and group against step size")
      ->check(CLI::IsMember({"convergence", "work-precision", "drift"}))
      ->capture_default_str();
  std::vector<std::string> names;
  for (const Abscissa& x : abscissae()) names.emplace_back(x.name);
  command
      ->add_option(
          "--x", options->x,
          fmt::format("abscissa: {}; by default step_size, with work-precision the first of time, flops and "
                      "residuals that all runs in double have",
                      fmt::join(names, ", ")))
      ->type_name("NAME");
  command->add_option("--y", options->y, "the error of which component")
      ->check(CLI::IsMember({"q", "v", "lambda"}))
      ->capture_default_str();
  command->add_option("--norm", options->norm, "in which norm")
      ->check(CLI::IsMember({"end_relative", "end_absolute", "max_absolute"}))
      ->capture_default_str();
  command->add_flag("--one-panel", options->one_panel,
                    "all curves in one panel, not a panel for each formulation and form");
  command->add_flag("--skip-bad-lines", options->skip_bad_lines,
                    "name lines that are no records on standard error and use the rest");
  command->add_option("--out", options->out, "picture; the ending chooses SVG, PDF or PNG")
      ->required()
      ->type_name("FILE.svg|pdf|png")
      ->check([](const std::string& file) {
        const auto ending = std::filesystem::path(file).extension();
        return ending == ".svg" || ending == ".pdf" || ending == ".png"
                   ? std::string()
                   : fmt::format("\"{}\" is not allowed; allowed endings: .svg, .pdf, .png", file);
      });
  command->footer(
      "Examples:\n"
      "  liebench plot figure4.jsonl --y lambda --norm max_absolute --out lambda.pdf\n"
      "  liebench plot study.jsonl --kind work-precision --out time.svg\n"
      "  liebench plot study.jsonl --kind work-precision --x flops --y v --out flops.png\n"
      "Failed runs are crosses at the upper edge; the legend says how many failed and how.");
  command->callback([options] { plot(*options); });
}

}  // namespace liebench
