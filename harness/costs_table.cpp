#include <cmath>
#include <map>
#include <string>

#include "harness/select.h"
#include "harness/tables.h"

namespace liebench {

namespace {

struct CostColumn {
  RecordNumber number;
  const char* header;
  const char* unit;
  bool per_step;  // of the run: divided by its steps
};

constexpr CostColumn cost_columns[] = {
    {record_number("cost/residuals"), "residuals", "", true},
    {record_number("cost/jacobians"), "Jacobians", "", true},
    {record_number("cost/factorizations"), "factorizations", "", true},
    {record_number("cost/factorizations_by_cause/start"), "at the start", "", true},
    {record_number("cost/factorizations_by_cause/first"), "first", "", true},
    {record_number("cost/factorizations_by_cause/refresh"), "refresh", "", true},
    {record_number("cost/factorizations_by_cause/slow_convergence"), "slow convergence", "", true},
    {record_number("cost/solves"), "solves", "", true},
    {record_number("cost/newton_iterations"), "Newton iterations", "", true},
    {record_number("cost/exp"), "exp", "", true},
    {record_number("cost/log"), "log", "", true},
    {record_number("cost/tangent"), "T", "", true},
    {record_number("cost/tangent_inverse"), "T^-1", "", true},
    {record_number("cost/commutators"), "commutators", "", true},
    {record_number("cost/flops"), "flops", "", true},
    {record_number("cost/flops_by_kind/add"), "add", "", true},
    {record_number("cost/flops_by_kind/multiply"), "multiply", "", true},
    {record_number("cost/flops_by_kind/divide"), "divide", "", true},
    {record_number("cost/flops_by_kind/square_root"), "square root", "", true},
    {record_number("cost/flops_by_kind/transcendental"), "transcendental", "", true},
    {record_number("time/ns_per_step/median"), "time", "ns", false},
};

// The finest run that ended well, or that of the step size asked for.
const RecordRow* chosen(const Curve& curve, std::optional<double> step_size) {
  for (auto run = curve.records.rbegin(); run != curve.records.rend(); ++run) {
    if (!(*run)->ended_well()) continue;
    if (!step_size || std::abs((*run)->step_size() - *step_size) <= 1e-9 * *step_size) return *run;
  }
  return nullptr;
}

}  // namespace

Table costs_table(const std::vector<RecordRow>& records, std::optional<double> step_size) {
  struct Line {
    std::string label;
    double step_size;
    std::int64_t steps;
    std::map<const CostColumn*, double> costs;
  };
  std::vector<Line> lines;
  std::map<const CostColumn*, bool> present;
  for (const Curve& curve : curves(records)) {
    const RecordRow* run = chosen(curve, step_size);
    if (run == nullptr) continue;
    Line line{curve.label, run->step_size(), std::int64_t(run->steps()), {}};
    for (const CostColumn& column : cost_columns) {
      const std::optional<double> cost = (*run)[column.number];
      if (!cost || line.steps <= 0) continue;
      line.costs[&column] = *cost / (column.per_step ? double(line.steps) : 1.0);
      present[&column] = true;
    }
    lines.push_back(std::move(line));
  }
  std::vector<Column> columns{
      {.header = "curve"},
      {.header = "h", .unit = "s", .kind = ColumnKind::number, .alignment = Alignment::right},
      {.header = "steps", .kind = ColumnKind::integer, .alignment = Alignment::right}};
  for (const CostColumn& column : cost_columns)
    if (present.contains(&column))
      columns.push_back({.header = column.header,
                         .unit = column.unit,
                         .kind = ColumnKind::number,
                         .alignment = Alignment::right,
                         .digits = 4});
  Table table("Cost of a step: counts of the whole run, its start included, divided by its steps", columns);
  for (const Line& line : lines) {
    Row row{line.label, line.step_size, line.steps};
    for (const CostColumn& column : cost_columns) {
      if (!present.contains(&column)) continue;
      const auto cost = line.costs.find(&column);
      row.push_back(cost == line.costs.end() ? Cell() : Cell(cost->second));
    }
    table.add_row(std::move(row));
  }
  return table;
}

}  // namespace liebench
