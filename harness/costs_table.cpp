#include <cmath>
#include <map>
#include <string>

#include "harness/select.h"
#include "harness/tables.h"

namespace liebench {

namespace {

struct CostColumn {
  const char* pointer;
  const char* header;
  const char* unit;
  bool per_step;  // of the run: divided by its steps
};

constexpr CostColumn cost_columns[] = {
    {"/cost/residuals", "residuals", "", true},
    {"/cost/jacobians", "Jacobians", "", true},
    {"/cost/factorizations", "factorizations", "", true},
    {"/cost/factorizations_by_cause/start", "at the start", "", true},
    {"/cost/factorizations_by_cause/first", "first", "", true},
    {"/cost/factorizations_by_cause/refresh", "refresh", "", true},
    {"/cost/factorizations_by_cause/slow_convergence", "slow convergence", "", true},
    {"/cost/solves", "solves", "", true},
    {"/cost/newton_iterations", "Newton iterations", "", true},
    {"/cost/exp", "exp", "", true},
    {"/cost/log", "log", "", true},
    {"/cost/tangent", "T", "", true},
    {"/cost/tangent_inverse", "T^-1", "", true},
    {"/cost/commutators", "commutators", "", true},
    {"/cost/flops", "flops", "", true},
    {"/cost/flops_by_kind/add", "add", "", true},
    {"/cost/flops_by_kind/multiply", "multiply", "", true},
    {"/cost/flops_by_kind/divide", "divide", "", true},
    {"/cost/flops_by_kind/square_root", "square root", "", true},
    {"/cost/flops_by_kind/transcendental", "transcendental", "", true},
    {"/time/ns_per_step/median", "time", "ns", false},
};

// The finest run that ended well, or that of the step size asked for.
const Json* chosen(const Curve& curve, std::optional<double> step_size) {
  for (auto run = curve.records.rbegin(); run != curve.records.rend(); ++run) {
    if ((*run)->at("outcome") != "ok") continue;
    const double h = (*run)->at("step_size").get<double>();
    if (!step_size || std::abs(h - *step_size) <= 1e-9 * *step_size) return *run;
  }
  return nullptr;
}

}  // namespace

Table costs_table(const std::vector<Json>& records, std::optional<double> step_size) {
  struct Line {
    std::string label;
    double step_size;
    std::int64_t steps;
    std::map<const CostColumn*, double> costs;
  };
  std::vector<Line> lines;
  std::map<const CostColumn*, bool> present;
  for (const Curve& curve : curves(records)) {
    const Json* run = chosen(curve, step_size);
    if (run == nullptr) continue;
    Line line{curve.label, run->at("step_size").get<double>(), run->at("steps").get<std::int64_t>(), {}};
    for (const CostColumn& column : cost_columns) {
      const Json::json_pointer pointer(column.pointer);
      if (!run->contains(pointer) || !run->at(pointer).is_number() || line.steps <= 0) continue;
      line.costs[&column] = run->at(pointer).get<double>() / (column.per_step ? double(line.steps) : 1.0);
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
