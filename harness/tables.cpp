#include "harness/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>

#include "harness/parallel.h"
#include "harness/select.h"

namespace liebench {

namespace {

std::vector<Row> order_rows(const Curve& curve) {
  std::vector<Row> rows;
  for (const char* component : {"q", "v", "lambda"})
    for (const char* norm : {"end_relative", "max_absolute"}) {
      const Quantity quantity{component, norm};
      if (std::none_of(curve.records.begin(), curve.records.end(),
                       [&](const RecordRow* record) { return error_of(*record, quantity).has_value(); }))
        continue;
      const OrderFit fit = fit_curve(curve, quantity);
      if (fit.estimate)
        rows.push_back({curve.label, describe(quantity), fit.estimate->order, fit.estimate->uncertainty,
                        fit.estimate->h_min, fit.estimate->h_max, std::int64_t(fit.estimate->points),
                        fit.estimate->still_changing ? std::string("slope still changing") : std::string()});
      else
        rows.push_back({curve.label, describe(quantity), {}, {}, {}, {}, {}, fit.reason});
    }
  return rows;
}

}  // namespace

Table orders_table(const std::vector<RecordRow>& records) {
  Table table("Observed orders of convergence; window and uncertainty by the rule of docs/orders.md",
              {{.header = "curve"},
               {.header = "error"},
               {.header = "order", .kind = ColumnKind::number, .alignment = Alignment::right, .digits = 4},
               {.header = "±", .kind = ColumnKind::number, .alignment = Alignment::right, .digits = 2},
               {.header = "from h", .unit = "s", .kind = ColumnKind::number, .alignment = Alignment::right},
               {.header = "to h", .unit = "s", .kind = ColumnKind::number, .alignment = Alignment::right},
               {.header = "points", .kind = ColumnKind::integer, .alignment = Alignment::right},
               {.header = "remark"}});
  const std::vector<Curve> list = curves(records);
  std::vector<std::vector<Row>> rows(list.size());
  for_each_in_parallel(list.size(), [&](std::size_t i) { rows[i] = order_rows(list[i]); });
  for (std::vector<Row>& of_curve : rows)
    for (Row& row : of_curve) table.add_row(std::move(row));
  return table;
}

Table outcomes_table(const std::vector<RecordRow>& records) {
  Table table("Outcomes", {{.header = "curve"},
                           {.header = "outcome"},
                           {.header = "runs", .kind = ColumnKind::integer, .alignment = Alignment::right},
                           {.header = "step sizes", .unit = "s"},
                           {.header = "first failure at t",
                            .unit = "s",
                            .kind = ColumnKind::number,
                            .alignment = Alignment::right},
                           {.header = "step", .kind = ColumnKind::integer, .alignment = Alignment::right},
                           {.header = "residual",
                            .kind = ColumnKind::number,
                            .alignment = Alignment::right,
                            .digits = 2,
                            .notation = Notation::scientific},
                           {.header = "message"}});
  for (const Curve& curve : curves(records)) {
    std::map<std::string_view, std::vector<const RecordRow*>> by_outcome;
    for (const RecordRow* record : curve.records) by_outcome[record->outcome].push_back(record);
    for (const auto& [outcome, runs] : by_outcome) {
      const double largest = runs.front()->step_size();
      const double smallest = runs.back()->step_size();
      const std::string sizes = runs.size() == 1 ? fmt::format("{:.3g}", largest)
                                                 : fmt::format("{:.3g} to {:.3g}", largest, smallest);
      Cell time, step, residual, message;
      if (const auto& failure = runs.front()->failure) {
        time = failure->time;
        message = failure->message;
        if (failure->step) step = *failure->step;
        if (failure->residual) residual = *failure->residual;
      }
      table.add_row({curve.label, std::string(outcome), std::int64_t(runs.size()), sizes, time, step,
                     residual, message});
    }
  }
  return table;
}

Table invariants_table(const std::vector<RecordRow>& records) {
  const auto number = [](const char* header, const char* unit, RecordNumber of) {
    return std::pair(Column{.header = header,
                            .unit = unit,
                            .kind = ColumnKind::number,
                            .alignment = Alignment::right,
                            .digits = 2,
                            .notation = Notation::scientific},
                     of);
  };
  std::vector<std::pair<Column, RecordNumber>> columns{
      number("agrees to t", "s", record_number("agreement_time")),
      number("energy", "J", record_number("drift/energy")),
      number("angular momentum", "kg m^2/s", record_number("drift/angular_momentum")),
      number("position constraint", "m", record_number("drift/position_constraint")),
      number("velocity constraint", "m/s", record_number("drift/velocity_constraint")),
      number("group", "", record_number("drift/group"))};
  columns.front().first.notation = Notation::automatic;
  columns.front().first.digits = 4;
  std::erase_if(columns, [&](const auto& column) {
    return std::none_of(records.begin(), records.end(),
                        [&](const RecordRow& record) { return record[column.second].has_value(); });
  });
  std::vector<Column> headers{
      {.header = "curve"},
      {.header = "h", .unit = "s", .kind = ColumnKind::number, .alignment = Alignment::right}};
  for (const auto& column : columns) headers.push_back(column.first);
  Table table("Largest deviations from what the exact solution keeps", headers);
  for (const Curve& curve : curves(records))
    for (const RecordRow* record : curve.records) {
      if (!record->ended_well()) continue;
      Row row{curve.label, record->step_size()};
      for (const auto& column : columns) {
        Cell& cell = row.emplace_back();
        if (const auto value = (*record)[column.second]) cell = *value;
      }
      table.add_row(std::move(row));
    }
  return table;
}

}  // namespace liebench
