#include "harness/cost_accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "harness/parallel.h"

namespace liebench {

namespace {

using Value = std::optional<double>;

struct Run {
  double step_size = 0, error = 0;
  Value steps{}, residuals{}, flops{}, time_ms{}, relative{}, mixed{};
  bool next_coarser_failed = false;
};

Value positive(const Value& value) {
  return value && *value > 0 ? value : Value();
}

Value positive_error(const RecordRow& record, const Quantity& quantity) {
  return positive(error_of(record, quantity));
}

// Runs by falling step size. One without a positive error says nothing on a logarithmic scale.
std::vector<Run> runs_of(const Curve& curve, const Quantity& quantity) {
  std::vector<Run> runs;
  bool failed = false;
  for (const RecordRow* record : curve.records) {
    if (!record->ended_well()) {
      failed = true;
      continue;
    }
    const Value error = positive_error(*record, quantity);
    const double h = record->step_size();
    if (!error || (!runs.empty() && runs.back().step_size == h)) continue;
    Run run{.step_size = h, .error = *error, .next_coarser_failed = failed};
    run.steps = record->steps();
    run.residuals = positive((*record)[record_number("cost/residuals")]);
    run.flops = positive((*record)[record_number("cost/flops")]);
    if (const Value ns = positive((*record)[record_number("time/total_ns")])) run.time_ms = *ns * 1e-6;
    run.relative = positive_error(*record, {quantity.component, "end_relative"});
    const Value absolute = positive_error(*record, {quantity.component, "end_absolute"});
    // |e| / (1 + |y|) with |y| = |e| / relative error.
    if (run.relative && absolute) run.mixed = 1.0 / (1.0 / *absolute + 1.0 / *run.relative);
    runs.push_back(run);
    failed = false;
  }
  return runs;
}

// The run with the least error that counts: what is finer stands at the round-off floor. Where what is finer
// falls again by more than ten, that run was a zero crossing of the error, and the search goes on behind it.
std::size_t finest_above_floor(const std::vector<Run>& runs) {
  const auto less = [](const Run& a, const Run& b) { return a.error < b.error; };
  auto least = std::min_element(runs.begin(), runs.end(), less);
  while (least + 1 != runs.end()) {
    const auto behind = std::min_element(least + 1, runs.end(), less);
    const auto peak = std::max_element(least + 1, behind + 1, less);
    if (peak->error <= 10.0 * behind->error) break;
    least = behind;
  }
  return std::size_t(least - runs.begin());
}

// On the straight line through two runs in log cost over log error, at `part` of the way from a to b.
Value between(const Value& a, const Value& b, double part) {
  if (!a || !b) return {};
  if (part == 0.0) return a;
  return std::exp(std::log(*a) + part * (std::log(*b) - std::log(*a)));
}

void interpolate(CostEntry& entry, const Run& a, const Run& b, double part) {
  entry.reached = true;
  entry.step_size = between(a.step_size, b.step_size, part);
  entry.steps = between(a.steps, b.steps, part);
  entry.residuals = between(a.residuals, b.residuals, part);
  entry.flops = between(a.flops, b.flops, part);
  entry.time_ms = between(a.time_ms, b.time_ms, part);
  entry.relative = between(a.relative, b.relative, part);
  entry.mixed = between(a.mixed, b.mixed, part);
}

double part_of_way(const Run& a, const Run& b, double target) {
  return std::log(target / a.error) / std::log(b.error / a.error);
}

CostEntry entry_at(const std::string& label, const std::vector<Run>& runs, double target) {
  CostEntry entry{.curve = label};
  if (runs.empty()) {
    entry.remark = "never reached; no run ended well";
    return entry;
  }
  const std::size_t finest = finest_above_floor(runs);
  if (runs[finest].error > target) {
    // By one decade at most, and never below a floor.
    const bool last = finest + 1 == runs.size() && finest > 0 && !runs[finest].next_coarser_failed;
    if (last && target >= 0.1 * runs[finest].error) {
      const Run& a = runs[finest - 1];
      const Run& b = runs[finest];
      const double slope = std::log(a.error / b.error) / std::log(a.step_size / b.step_size);
      if (slope > 0.5) {
        interpolate(entry, a, b, part_of_way(a, b, target));
        entry.extrapolated = true;
        entry.remark = "extrapolated";
        return entry;
      }
    }
    entry.remark = fmt::format("never reached; best {:.1e}", runs[finest].error);
    return entry;
  }
  std::size_t i = finest;
  while (i > 0 && !runs[i].next_coarser_failed && runs[i - 1].error <= target) --i;
  if (runs[i].next_coarser_failed) {
    interpolate(entry, runs[i], runs[i], 0.0);
    entry.remark = "at most: the next coarser run failed";
  } else if (i == 0) {
    interpolate(entry, runs[i], runs[i], 0.0);
    entry.remark = "at most: the coarsest run reaches it";
  } else {
    interpolate(entry, runs[i], runs[i - 1], part_of_way(runs[i], runs[i - 1], target));
  }
  return entry;
}

using Cost = Value CostEntry::*;

// The cost that all entries which reach the target have.
Cost common_cost(const std::vector<CostEntry>& entries) {
  for (const Cost cost : {&CostEntry::time_ms, &CostEntry::flops})
    if (std::all_of(entries.begin(), entries.end(),
                    [&](const CostEntry& entry) { return !entry.reached || (entry.*cost).has_value(); }))
      return cost;
  return &CostEntry::residuals;
}

Cell cell(const Value& value) {
  return value ? Cell(*value) : Cell();
}
Cell digits(const Value& error) {
  return error ? Cell(-std::log10(*error)) : Cell();
}

// The rows of the curves, with their runs, for one target.
std::vector<Row> target_rows(const std::vector<std::pair<std::string, std::vector<Run>>>& curves,
                             double target, bool has_flops, bool has_time) {
  std::vector<CostEntry> entries;
  entries.reserve(curves.size());
  for (const auto& [label, runs] : curves) entries.push_back(entry_at(label, runs, target));
  const Cost cost = common_cost(entries);
  constexpr double never = 1e300;
  std::stable_sort(entries.begin(), entries.end(), [&](const CostEntry& a, const CostEntry& b) {
    return (a.*cost).value_or(never) < (b.*cost).value_or(never);
  });
  // What was run goes before what was extrapolated.
  const auto cheapest = std::find_if(entries.begin(), entries.end(), [&](const CostEntry& entry) {
    return entry.reached && !entry.extrapolated && (entry.*cost).has_value();
  });
  std::vector<Row> rows;
  rows.reserve(entries.size());
  for (auto entry = entries.begin(); entry != entries.end(); ++entry) {
    Row& row = rows.emplace_back();
    row.reserve(11);
    row.emplace_back(target);
    row.emplace_back(std::move(entry->curve));
    row.push_back(entry == cheapest ? Cell(true) : Cell());
    row.push_back(cell(entry->step_size));
    row.push_back(cell(entry->steps));
    row.push_back(cell(entry->residuals));
    if (has_flops) row.push_back(cell(entry->flops));
    if (has_time) row.push_back(cell(entry->time_ms));
    row.push_back(digits(entry->relative));
    row.push_back(digits(entry->mixed));
    row.emplace_back(std::move(entry->remark));
  }
  return rows;
}

}  // namespace

CostEntry cost_of_error(const Curve& curve, const Quantity& quantity, double target) {
  return entry_at(curve.label, runs_of(curve, quantity), target);
}

Table cost_accuracy_table(const std::vector<RecordRow>& records, const Quantity& quantity,
                          const std::vector<double>& targets) {
  std::vector<std::pair<std::string, std::vector<Run>>> all;
  for (const Curve& curve : curves(records))
    if (auto runs = runs_of(curve, quantity); !runs.empty()) all.emplace_back(curve.label, std::move(runs));
  const auto any = [&](Value Run::*member) {
    return std::any_of(all.begin(), all.end(), [&](const auto& curve) {
      return std::any_of(curve.second.begin(), curve.second.end(),
                         [&](const Run& run) { return (run.*member).has_value(); });
    });
  };
  const bool has_flops = any(&Run::flops), has_time = any(&Run::time_ms);
  const auto number = [](const char* header, const char* unit, int digits) {
    return Column{.header = header,
                  .unit = unit,
                  .kind = ColumnKind::number,
                  .alignment = Alignment::right,
                  .digits = digits};
  };
  std::vector<Column> columns{
      number("target", "", 1),
      {.header = "curve"},
      {.header = "cheapest", .kind = ColumnKind::mark, .alignment = Alignment::centre},
      number("h", "s", 3),
      number("steps", "", 3),
      number("residuals", "", 3)};
  columns.front().notation = Notation::scientific;
  if (has_flops) columns.push_back(number("flops", "", 3));
  if (has_time) columns.push_back(number("time", "ms", 3));
  columns.push_back(number("scd", "", 3));
  columns.push_back(number("mescd", "", 3));
  columns.push_back({.header = "remark"});
  Table table(fmt::format("Cost of a {}; rules in docs/tables.md", describe(quantity)), columns);

  std::vector<double> sorted = targets;
  std::sort(sorted.rbegin(), sorted.rend());
  std::vector<std::vector<Row>> rows(sorted.size());
  for_each_in_parallel(sorted.size(),
                       [&](std::size_t i) { rows[i] = target_rows(all, sorted[i], has_flops, has_time); });
  for (std::vector<Row>& of_target : rows)
    for (Row& row : of_target) table.add_row(std::move(row));
  return table;
}

}  // namespace liebench
