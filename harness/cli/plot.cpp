#include <fmt/format.h>

#include "harness/cli/commands.h"
#include "harness/errors.h"
#include "harness/record_reader.h"
#include "harness/select.h"
#include "plots/figure.h"
#include "plots/gnuplot.h"

namespace liebench {

namespace {

struct PlotOptions {
  std::vector<std::string> files;
  std::string kind = "convergence";
  std::string y = "q";
  std::string norm = "end_relative";
  std::string out;
};

void plot(const PlotOptions& options) {
  require_gnuplot();
  const std::vector<Json> records =
      read_records(std::vector<std::filesystem::path>(options.files.begin(), options.files.end()));
  if (records.empty()) throw InputError(options.files.front(), "holds no records");
  const Quantity quantity{options.y, options.norm};
  Panel panel{.title = "", .x_label = "step size h in s", .y_label = plain_text(describe(quantity))};
  int style = 0;
  for (const Curve& curve : curves(records)) {
    Series series{
        .label = plain_text(curve.label), .style = style % style_count, .secondary = style >= style_count};
    for (const Json* record : curve.records) {
      const double h = record->at("step_size").get<double>();
      if (record->at("outcome") != "ok")
        series.failures.push_back({h, 0.0});
      else if (const auto error = error_of(*record, quantity))
        series.points.push_back({h, *error});
    }
    if (series.points.empty() && series.failures.empty()) continue;
    panel.series.push_back(std::move(series));
    ++style;
  }
  if (panel.series.empty())
    throw InputError("--y", fmt::format("no record has an error of {}; choose another component", options.y));
  draw({.title = "", .rows = 1, .columns = 1, .panels = {std::move(panel)}},
       std::vector<std::filesystem::path>{options.out});
}

}  // namespace

void add_plot(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("plot", "Draw records by gnuplot");
  auto options = std::make_shared<PlotOptions>();
  command->add_option("files", options->files, "files of records")->required()->type_name("FILE.jsonl...");
  command->add_option("--kind", options->kind, "convergence: error against step size")
      ->check(CLI::IsMember({"convergence"}))
      ->capture_default_str();
  command->add_option("--y", options->y, "the error of which component")
      ->check(CLI::IsMember({"q", "v", "lambda"}))
      ->capture_default_str();
  command->add_option("--norm", options->norm, "in which norm")
      ->check(CLI::IsMember({"end_relative", "end_absolute", "max_absolute"}))
      ->capture_default_str();
  command->add_option("--out", options->out, "picture; the ending chooses SVG, PDF or PNG")
      ->required()
      ->type_name("FILE.svg|pdf|png")
      ->check([](const std::string& file) {
        const auto ending = std::filesystem::path(file).extension();
        return ending == ".svg" || ending == ".pdf" || ending == ".png"
                   ? std::string()
                   : fmt::format("\"{}\" is not allowed; allowed endings: .svg, .pdf, .png", file);
      });
  command->footer("Example:\n  liebench plot figure4.jsonl --y lambda --norm max_absolute --out lambda.pdf");
  command->callback([options] { plot(*options); });
}

}  // namespace liebench
