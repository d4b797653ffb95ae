#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "harness/cli/commands.h"
#include "harness/cli/scene_plan.h"
#include "harness/errors.h"
#include "harness/progress.h"
#include "harness/scene_effects.h"
#include "harness/table.h"
#include "plots/bar_chart.h"
#include "plots/gnuplot.h"

namespace liebench {

namespace {

struct EffectsOptions {
  ScenePlanOptions plan;
  std::string format = "markdown";
  std::string picture;
};

Table effects_table(const std::string& scene, const std::vector<Ablation>& rows, const SimulationPlan& plan) {
  const Ablation& whole = rows.front();
  Table table(
      fmt::format("{}: what each effect costs and changes; {} steps of {:.4g} s", scene, plan.steps,
                  plan.step_size),
      {{.header = "without"},
       {.header = "time a step", .unit = "ns", .kind = ColumnKind::number, .alignment = Alignment::right},
       {.header = "saved",
        .unit = "%",
        .kind = ColumnKind::number,
        .alignment = Alignment::right,
        .digits = 2},
       {.header = "operations a step",
        .kind = ColumnKind::number,
        .alignment = Alignment::right,
        .digits = 5},
       {.header = "moves bodies by", .unit = "m", .kind = ColumnKind::number, .alignment = Alignment::right},
       {.header = "turns bodies by",
        .unit = "rad",
        .kind = ColumnKind::number,
        .alignment = Alignment::right},
       {.header = "outcome"}});
  for (const Ablation& row : rows) {
    Row cells{row.left_out.empty() ? std::string("nothing") : row.left_out};
    if (row.failure) {
      cells.insert(cells.end(), 5, Cell{});
      cells.emplace_back(fmt::format("stopped at {:.4g} s: {}", row.failure->time, row.failure->message));
    } else {
      cells.emplace_back(row.ns_per_step);
      const bool compared = !row.left_out.empty() && !whole.failure;
      cells.push_back(compared ? Cell{100.0 * (1.0 - row.ns_per_step / whole.ns_per_step)} : Cell{});
      cells.emplace_back(row.flops_per_step);
      cells.push_back(compared ? Cell{row.shift} : Cell{});
      cells.push_back(compared ? Cell{row.turn} : Cell{});
      cells.emplace_back(std::string("ok"));
    }
    table.add_row(std::move(cells));
  }
  return table;
}

BarChart effects_chart(const std::string& scene, const std::vector<Ablation>& rows) {
  BarChart chart{.title = scene + ": what each effect adds to the operations of a step",
                 .axis = "share of the operations of the whole scene, %",
                 .bars = {}};
  const Ablation& whole = rows.front();
  for (const Ablation& row : rows) {
    if (row.left_out.empty() || row.failure || whole.failure) continue;
    const double share = 100.0 * (1.0 - row.flops_per_step / whole.flops_per_step);
    chart.bars.push_back(
        {row.left_out, share, fmt::format("{:.1f} %; without it bodies move by {:.2g} m", share, row.shift)});
  }
  return chart;
}

void run_effects(const EffectsOptions& options) {
  if (!options.picture.empty()) require_gnuplot();
  const ScenePlan made = plan_scene(options.plan);
  if (made.plan.chooses_steps)
    throw InputError(
        "--integrator",
        options.plan.integrator + " chooses its steps; what effects cost is compared in the same ones");
  const std::string& name = made.scene.scene.name;
  std::vector<Ablation> rows;
  {
    Progress progress(name + ", effects", 1.0);
    double reached = 0.0;
    rows = ablations(made.scene, made.plan, [&](double done) {
      progress.advance(done - reached);
      reached = done;
    });
  }
  const TableFormat format = options.format == "latex" ? TableFormat::latex
                             : options.format == "csv" ? TableFormat::csv
                                                       : TableFormat::markdown;
  fmt::print("{}", render(effects_table(name, rows, made.plan), format));
  if (options.picture.empty()) return;
  const BarChart chart = effects_chart(name, rows);
  if (chart.bars.empty())
    throw InputError(options.plan.scene, "has no effect that could be left out: nothing to draw");
  draw(chart, options.picture);
}

}  // namespace

void add_effects(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand(
      "effects", "What each effect of a scene costs in time and what leaving it out changes");
  auto options = std::make_shared<EffectsOptions>();
  add_scene_plan(*command, options->plan);
  command->add_option("--format", options->format, "of the table")
      ->type_name("FORMAT")
      ->check(CLI::IsMember({"markdown", "latex", "csv"}))
      ->capture_default_str();
  command
      ->add_option("--picture", options->picture,
                   "bars of what each effect costs; the ending chooses SVG, PDF or PNG")
      ->type_name("FILE.svg|pdf|png")
      ->check([](const std::string& file) {
        const auto ending = std::filesystem::path(file).extension();
        return ending == ".svg" || ending == ".pdf" || ending == ".png"
                   ? std::string()
                   : fmt::format("\"{}\" is not allowed; allowed endings: .svg, .pdf, .png", file);
      });
  command->footer(
      "Examples:\n"
      "  liebench effects builtin:flyball_governor --picture governor.svg\n"
      "  liebench effects scene.json --integrator generalized_alpha --h 1e-4 --t-end 0.5 --format csv\n"
      "Times are medians of interleaved repetitions on this machine; operations are counted and the same "
      "everywhere.");
  command->callback([options] { run_effects(*options); });
}

}  // namespace liebench
