#include "harness/cost_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "harness/cost_accuracy.h"
#include "harness/order_matrix.h"
#include "harness/record_plots.h"
#include "harness/select.h"
#include "harness/table.h"

namespace liebench {

namespace {

const Quantity error_of_q{"q", "end_relative"};
constexpr std::array shown_targets{1e-2, 1e-4, 1e-6, 1e-8};

struct Setting {
  const char* formulation;
  const char* form;
  const char* title;
};
constexpr std::array shown_settings{
    Setting{"SO3", "", "Unconstrained, SO(3)"}, Setting{"R3xSO3", "index3", "Index 3, R^3 × SO(3)"},
    Setting{"R3xSO3", "stabilized_index2", "Stabilized index 2, R^3 × SO(3)"}};

std::vector<RecordRow> rows_of(const std::vector<RecordRow>& records, const Setting& setting) {
  std::vector<RecordRow> rows;
  for (const RecordRow& record : records)
    if (record.curve->formulation == setting.formulation && record.curve->form() == setting.form)
      rows.push_back(record);
  return rows;
}

// In a table of several forms those of index 3 say so.
std::string row_name(const std::vector<Curve>& list, const CurveIdentity& identity) {
  const bool several = std::any_of(list.begin(), list.end(), [&](const Curve& curve) {
    return curve.identity->form() != list.front().identity->form();
  });
  return method_name(identity) + (several && identity.form() == "index3" ? ", index 3" : "");
}

}  // namespace

std::string cost_table(const std::vector<RecordRow>& rows, Cost cost) {
  const std::vector<Curve> list = curves(rows);
  std::vector<Column> columns{{.header = "method"}};
  std::vector<std::vector<CostEntry>> entries;
  std::vector<double> least(shown_targets.size(), 1e300);
  for (const double target : shown_targets)
    columns.push_back({.header = fmt::format("{:.0e}", target), .alignment = Alignment::right});
  for (const Curve& curve : list) {
    auto& line = entries.emplace_back();
    for (std::size_t t = 0; t < shown_targets.size(); ++t) {
      line.push_back(cost_of_error(curve, error_of_q, shown_targets[t]));
      if (line.back().reached && !line.back().extrapolated && line.back().*cost)
        least[t] = std::min(least[t], *(line.back().*cost));
    }
  }
  Table table("", columns);
  for (std::size_t i = 0; i < list.size(); ++i) {
    Row row{row_name(list, *list[i].identity)};
    for (std::size_t t = 0; t < shown_targets.size(); ++t) {
      const CostEntry& entry = entries[i][t];
      if (!entry.reached || !(entry.*cost)) {
        row.emplace_back();
        continue;
      }
      const double value = *(entry.*cost);
      const std::string mark = entry.extrapolated ? " e" : entry.remark.empty() ? "" : " c";
      const std::string text = value >= 1e4 ? fmt::format("{:.2e}", value) : fmt::format("{:.3g}", value);
      row.push_back(value <= least[t] ? fmt::format("**{}**{}", text, mark) : text + mark);
    }
    table.add_row(std::move(row));
  }
  return to_markdown(table);
}

namespace {

// Over all formulations and forms.
std::string winners(const std::vector<RecordRow>& records, Cost cost, const char* unit) {
  Table table("", {{.header = "error of q"},
                   {.header = fmt::format("cheapest without constraints [{}]", unit)},
                   {.header = fmt::format("cheapest with constraints [{}]", unit)}});
  const std::vector<Curve> list = curves(records);
  for (const double target : shown_targets) {
    std::array<std::string, 2> best;
    std::array<double, 2> least{1e300, 1e300};
    for (const Curve& curve : list) {
      const std::string form = curve.identity->form();
      const std::size_t constrained = form.empty() ? 0 : 1;
      const CostEntry entry = cost_of_error(curve, error_of_q, target);
      if (!entry.reached || entry.extrapolated || !(entry.*cost) || !(*(entry.*cost) < least[constrained]))
        continue;
      least[constrained] = *(entry.*cost);
      best[constrained] = fmt::format("{:.3g}: {} on {}{}", least[constrained], method_name(*curve.identity),
                                      curve.identity->formulation, form.empty() ? "" : ", " + form);
    }
    Row row{fmt::format("{:.0e}", target)};
    for (const std::string& text : best) {
      row.emplace_back();
      if (!text.empty()) row.back() = text;
    }
    table.add_row(std::move(row));
  }
  return to_markdown(table);
}

}  // namespace

bool all_timed(const std::vector<RecordRow>& records) {
  return std::all_of(records.begin(), records.end(), [](const RecordRow& record) {
    return !record.ended_well() || record[record_number("time/total_ns")];
  });
}

Figure cost_accuracy_figure(const std::vector<RecordRow>& records) {
  std::vector<RecordRow> shown;
  for (const Setting& setting : shown_settings)
    for (RecordRow& record : rows_of(records, setting)) shown.push_back(std::move(record));
  Figure figure = error_figure(shown, dearest_abscissa(shown), error_of_q, true).figure;
  for (std::size_t i = 0; i < figure.panels.size() && i < shown_settings.size(); ++i)
    figure.panels[i].title = shown_settings[i].title;
  figure.title = "What accuracy costs: heavy top over 2 s, every method from its own start";
  return figure;
}

std::string cost_report(const std::vector<RecordRow>& records) {
  const bool times = all_timed(records);
  std::string text =
      "# What accuracy costs\n\n"
      "Written by `liebench figures`; do not edit. The fast heavy top over 2 s in double precision, every "
      "method from "
      "its own start, which is part of the cost. Numbers are interpolated between runs (rules: "
      "[tables](tables.md)); "
      "\"e\": extrapolated by a decade at most; \"c\": at most, for the coarsest run is better already or "
      "the next coarser one failed; a "
      "dash: not "
      "reached. The least of a column is bold. Errors are the relative error of q at the end.\n";
  if (!times) text += "\nNo run was timed (short form): floating point operations only.\n";
  text += "\n## The cheapest of all methods and formulations\n\n";
  if (times) text += "By computing time:\n\n" + winners(records, &CostEntry::time_ms, "ms") + "\n";
  text += "By floating point operations:\n\n" + winners(records, &CostEntry::flops, "operations");
  for (const Setting& setting : shown_settings) {
    const std::vector<RecordRow> rows = rows_of(records, setting);
    if (rows.empty()) continue;
    text += fmt::format("\n## {}\n\n", setting.title);
    if (times)
      text += "Computing time in ms for an error of\n\n" + cost_table(rows, &CostEntry::time_ms) + "\n";
    text += "Floating point operations for an error of\n\n" + cost_table(rows, &CostEntry::flops);
  }
  return text;
}

}  // namespace liebench
