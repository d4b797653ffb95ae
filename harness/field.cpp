#include "harness/field.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

#include "harness/cost_report.h"
#include "harness/order_matrix.h"
#include "harness/record_plots.h"
#include "harness/select.h"

namespace liebench {

namespace {

const Quantity end_error{"q", "end_relative"};  // of q

struct Problem {
  const char* title;
  bool (*is)(const CurveIdentity&);
  bool mount = false;
};
bool is_fast(const CurveIdentity& c) {
  return c.parameters->at("angular_velocity").at(1).get<double>() > 10.0;
}
bool is_constrained(const CurveIdentity& c) {
  return c.formulation != "SO3" && c.formulation != "S3";
}
template <bool constrained, bool fast>
bool is_top(const CurveIdentity& c) {
  return c.problem == "heavy_top" && is_constrained(c) == constrained && is_fast(c) == fast;
}
constexpr std::array problems_shown{
    Problem{"fast top, no constraints", is_top<false, true>},
    Problem{"fast top, constrained", is_top<true, true>},
    Problem{"slow top, no constraints", is_top<false, false>},
    Problem{"slow top, constrained", is_top<true, false>},
    Problem{"slow top on a soft mount",
            [](const CurveIdentity& c) { return c.problem == "top_on_soft_mount"; }, true},
    Problem{"slow top on a stiff, damped mount",
            [](const CurveIdentity& c) { return c.problem == "top_on_stiff_mount"; }, true}};

std::vector<RecordRow> rows_of(const std::vector<RecordRow>& records, const Problem& problem) {
  std::vector<RecordRow> rows;
  for (const RecordRow& record : records)
    if (problem.is(*record.curve)) rows.push_back(record);
  return rows;
}

// The members of each family that the picture shows: a colour for a family, a mark for a member.
struct Shown {
  std::string_view integrator;
  std::vector<std::pair<const char*, Json>> options;
  std::string label, tag;
  int style, mark;
  bool outside = false;
  bool on_mounts_only = false;  // where it is what stiffness asks for
};
const std::vector<Shown>& shown() {
  static const std::vector<Shown> list{
      {.integrator = "bliedf2nd",
       .options = {{"k", 2}},
       .label = "BLieDF2nd, k = 2",
       .tag = "B2",
       .style = 0,
       .mark = 3,
       .on_mounts_only = true},
      {"bliedf2nd", {{"k", 4}}, "BLieDF2nd, k = 4", "B4", 0, 0},
      {"bliedf2nd", {{"k", 6}}, "BLieDF2nd, k = 6", "B6", 0, 1},
      {"bliedf2nd_variable", {}, "BLieDF2nd, variable", "Bv", 0, 2},
      {"faltinsen_bdf", {{"k", 4}}, "Faltinsen BDF, k = 4", "F4", 1, 0},
      {"faltinsen_adams", {{"k", 6}}, "Faltinsen Adams, k = 6", "A6", 1, 1},
      {"generalized_alpha", {}, "generalized-α", "gα", 2, 0},
      {"rattlie", {}, "RATTLie", "R", 2, 1},
      {"rkmk", {{"tableau", "rk4"}}, "RKMK rk4", "4", 3, 0},
      {"rkmk", {{"tableau", "butcher6"}}, "RKMK butcher6", "6", 3, 1},
      {"rkmk_variable", {}, "RKMK dopri5, variable", "5v", 3, 2},
      {"half_explicit", {{"tableau", "herk4"}, {"projection", false}}, "HERK4", "H4", 3, 3},
      {"half_explicit", {{"tableau", "hedop5"}, {"projection", false}}, "HEDOP5", "H5", 3, 4},
      {"radau", {}, "Radau IIA, s = 3", "Ra", 4, 0},
      {"gauss", {{"stages", 4}}, "Gauss, s = 4", "G4", 4, 1},
      {"gauss", {{"stages", 8}}, "Gauss, s = 8", "G8", 4, 2},
      {"cvode_bdf", {}, "CVODE BDF", "cb", 5, 0, true},
      {"cvode_adams", {}, "CVODE Adams", "ca", 5, 1, true},
      {"arkode_erk", {}, "ARKODE ERK", "ae", 5, 2, true},
      {"ida", {}, "IDA", "ida", 5, 3, true},
      {"arkode_dirk", {}, "ARKODE DIRK", "ad", 5, 4, true, true}};
  return list;
}

// In the stabilized form, where the method has a choice.
bool is(const CurveIdentity& c, const Shown& shown) {
  if (c.integrator != shown.integrator || c.form() == "index3") return false;
  return std::all_of(shown.options.begin(), shown.options.end(),
                     [&](const auto& option) { return c.has_option(option.first, option.second); });
}

}  // namespace

Figure field_figure(const std::vector<RecordRow>& records) {
  const Abscissa& x = dearest_abscissa(records);
  Figure figure{.title = "What accuracy costs: methods and solvers on the heavy top, from initial values",
                .rows = 3,
                .columns = 2,
                .panels = {}};
  for (const Problem& problem : problems_shown) {
    Panel panel{.title = problem.title, .x_label = std::string(x.label), .y_label = "relative error of q"};
    for (const Shown& each : shown()) {
      if (each.on_mounts_only && !problem.mount) continue;
      Series series{.label = each.label,
                    .style = each.style,
                    .secondary = each.outside,
                    .mark = each.mark,
                    .tag = each.tag};
      // From step to step: where something is stiff a finer one is not always the dearer one.
      std::vector<std::pair<double, Point>> by_step;
      for (const RecordRow& record : records) {
        if (!problem.is(*record.curve) || !is(*record.curve, each)) continue;
        const auto value = value_of(record, x);
        if (const auto error = error_of(record, end_error); error && value)
          by_step.push_back({record.step_size(), {*value, *error}});
      }
      std::sort(by_step.begin(), by_step.end(),
                [](const auto& a, const auto& b) { return a.first > b.first; });
      for (const auto& [step, point] : by_step) series.points.push_back(point);
      if (!series.points.empty()) panel.series.push_back(std::move(series));
    }
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

std::string field_report(const std::vector<RecordRow>& records) {
  const bool times = all_timed(records);
  std::string text =
      "# The field\n\n"
      "Written by `liebench figures`; do not edit. The heavy top over 2 s (on a mount: 1 s) in double "
      "precision, every method "
      "from initial "
      "values alone; errors are the relative error of q at the end. Numbers are interpolated between runs "
      "(rules: "
      "[tables](tables.md)); \"e\": extrapolated by a decade at most; \"c\": at most, for the coarsest run "
      "is better already or the next coarser one failed; a dash: not reached. The least of a column is bold. "
      "Constrained methods with a choice are in "
      "the stabilized "
      "index-2 form unless they say otherwise. [What it shows](field.md), in words.\n";
  if (!times) text += "\nNo run was timed (short form): floating point operations only.\n";
  for (const Problem& problem : problems_shown) {
    const std::vector<RecordRow> rows = rows_of(records, problem);
    if (rows.empty()) continue;
    text += fmt::format("\n## {}{}\n\n", char(std::toupper(problem.title[0])), problem.title + 1);
    if (times)
      text += "Computing time in ms for an error of\n\n" + cost_table(rows, &CostEntry::time_ms) + "\n";
    text += "Floating point operations for an error of\n\n" + cost_table(rows, &CostEntry::flops);
  }
  return text;
}

}  // namespace liebench
