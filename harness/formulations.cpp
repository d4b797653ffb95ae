#include "harness/formulations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "harness/cost_accuracy.h"
#include "harness/order_matrix.h"
#include "harness/select.h"
#include "harness/table.h"

namespace liebench {

namespace {

const Quantity quantity{"q", "max_absolute"};
constexpr double common_step = 1e-3;   // s
constexpr double common_error = 1e-3;  // m, rad

// One value for each method (row) and formulation (column).
using Values = std::map<std::string, std::map<std::string, double>>;

// The least of each row in bold, and where another is within a percent of it, both.
std::string to_table(const std::vector<std::string>& methods, const std::vector<std::string>& formulations,
                     const Values& values) {
  std::vector<Column> columns{{.header = "method"}};
  for (const std::string& formulation : formulations)
    columns.push_back({.header = formulation, .alignment = Alignment::right});
  Table table("", columns);
  for (const std::string& method : methods) {
    const auto& line = values.at(method);
    double least = INFINITY;
    for (const auto& entry : line) least = std::min(least, entry.second);
    Row row{method};
    for (const std::string& formulation : formulations) {
      const auto value = line.find(formulation);
      if (value == line.end())
        row.push_back(std::string("not reached"));
      else
        row.push_back(value->second <= 1.01 * least ? fmt::format("**{:.2e}**", value->second)
                                                    : fmt::format("{:.2e}", value->second));
    }
    table.add_row(std::move(row));
  }
  return to_markdown(table);
}

}  // namespace

std::string formulations_report(const std::vector<RecordRow>& records) {
  struct Group {
    std::vector<std::string> methods, formulations;
    Values errors, operations;
  };
  const std::vector<std::pair<std::string, std::string>> titles{
      {"", "Unconstrained"}, {"index3", "Index 3"}, {"stabilized_index2", "Stabilized index 2"}};
  std::map<std::string, Group> groups;
  for (const Curve& curve : curves(records)) {
    Group& group = groups[curve.identity->form()];
    const std::string& formulation = curve.identity->formulation;
    const std::string method = method_name(*curve.identity);
    const auto remember = [](std::vector<std::string>& list, const std::string& name) {
      if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
    };
    remember(group.methods, method);
    remember(group.formulations, formulation);
    group.errors[method];
    group.operations[method];
    for (const RecordRow* record : curve.records) {
      const auto error = error_of(*record, quantity);
      if (!error) continue;
      if (std::abs((*record)[record_number("requested_step_size")].value() - common_step) < 1e-9)
        group.errors[method][formulation] = *error;
    }
    const CostEntry cost = cost_of_error(curve, quantity, common_error);
    if (cost.reached && !cost.extrapolated && cost.flops) group.operations[method][formulation] = *cost.flops;
  }
  std::string text = fmt::format(
      "# The formulations of the heavy top\n\n"
      "Written by `liebench figures`; do not edit. The fast top over 2 s in double precision, every method "
      "from its own "
      "start. \"Error\" is the largest error of q over the run, of position [m] and rotation [rad], whatever "
      "stands for "
      "them. \"Operations\" are floating point operations of the whole run, start included, as the audit "
      "counts "
      "them (cost.flops, see [records](records.md)). The least of a row is bold.\n");
  for (const auto& [form, title] : titles) {
    const auto group = groups.find(form);
    if (group == groups.end()) continue;
    text += fmt::format(
        "\n## {}\n\nError at equal step, h = {} s:\n\n{}\nOperations for an error of {}:\n\n{}", title,
        common_step, to_table(group->second.methods, group->second.formulations, group->second.errors),
        common_error, to_table(group->second.methods, group->second.formulations, group->second.operations));
  }
  return text;
}

}  // namespace liebench
