#include "harness/order_matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace liebench {

namespace {

std::string form_name(const CurveIdentity& identity) {
  const Json& options = *identity.options;
  if (!options.contains("form")) return "unconstrained";
  if (options.at("form") == "stabilized_index2") return "stabilized index 2";
  return options.at("modified_start") == true ? "index 3, modified start" : "index 3";
}

// Velocities in the body frame, in which the constraint of the top is a subalgebra.
bool body_fixed(const CurveIdentity& identity) {
  return identity.formulation == "SE3" || identity.formulation == "S3|xR3" || identity.formulation == "UDQ";
}

std::string measured(const Judgement& judgement, int expected) {
  std::string text = "does not fall";
  if (judgement.fit.estimate)
    text = fmt::format("{:.2f} ± {:.2f}", judgement.fit.estimate->order, judgement.fit.estimate->uncertainty);
  else if (judgement.fit.outcome != OrderOutcome::not_falling)
    text = "no order";
  return judgement.confirmed ? text : fmt::format("**{}, expected {}**", text, expected);
}

const std::vector<std::pair<Quantity, std::string>>& quantities() {
  static const std::vector<std::pair<Quantity, std::string>> list{
      {{"q", "end_relative"}, "q end"},           {{"q", "max_absolute"}, "q max"},
      {{"v", "end_relative"}, "v end"},           {{"v", "max_absolute"}, "v max"},
      {{"lambda", "end_relative"}, "lambda end"}, {{"lambda", "max_absolute"}, "lambda max"}};
  return list;
}

}  // namespace

std::string method_name(const CurveIdentity& identity) {
  const Json& options = *identity.options;
  if (identity.integrator == "generalized_alpha")
    return fmt::format("generalized-alpha, rho_inf = {}", options.at("rho_inf").get<double>());
  const int k = options.at("k").get<int>();
  if (identity.integrator == "faltinsen_bdf")
    return fmt::format("Faltinsen BDF {}, k = {}", options.at("variant").get<std::string>(), k);
  const Json& correction = options.at("correction");
  const char* suffix = correction == "implicit" ? ", L_k implicit" : correction == false ? ", L_k = 0" : "";
  return fmt::format("BLieDF2nd, k = {}{}", k, suffix);
}

int expected_order(const CurveIdentity& identity, const Quantity& quantity) {
  const Json& options = *identity.options;
  int order = 2;
  if (options.contains("k")) {
    order = options.at("k").get<int>();
    if (options.contains("correction") && options.at("correction") == false) order = std::min(order, 2);
  }
  const bool reduced = quantity.component == "lambda" && quantity.norm == "max_absolute" &&
                       options.contains("form") && options.at("form") == "index3" &&
                       options.at("modified_start") == false && !body_fixed(identity);
  return reduced ? order - 1 : order;
}

Judgement judge(const Curve& curve, const Quantity& quantity, int expected) {
  Judgement judgement{.confirmed = false, .fit = fit_curve(curve, quantity)};
  if (judgement.fit.estimate) {
    const OrderEstimate& e = *judgement.fit.estimate;
    const double allowed = std::min(widest_order_tolerance, std::max(order_tolerance, 2.0 * e.uncertainty));
    judgement.confirmed = std::abs(e.order - expected) <= allowed;
  } else {
    judgement.confirmed = expected == 0 && judgement.fit.outcome == OrderOutcome::not_falling;
  }
  return judgement;
}

std::vector<Column> order_matrix_columns() {
  return {{.header = "formulation"},
          {.header = "method"},
          {.header = "form"},
          {.header = "start"},
          {.header = "error"},
          {.header = "expected", .kind = ColumnKind::integer, .alignment = Alignment::right},
          {.header = "measured", .kind = ColumnKind::number, .alignment = Alignment::right, .digits = 4},
          {.header = "uncertainty", .kind = ColumnKind::number, .alignment = Alignment::right, .digits = 2},
          {.header = "h_min", .unit = "s", .kind = ColumnKind::number, .alignment = Alignment::right},
          {.header = "h_max", .unit = "s", .kind = ColumnKind::number, .alignment = Alignment::right},
          {.header = "points", .kind = ColumnKind::integer, .alignment = Alignment::right},
          {.header = "confirmed", .kind = ColumnKind::mark},
          {.header = "remark"}};
}

OrderMatrix order_matrix(const std::vector<RecordRow>& records) {
  OrderMatrix matrix;
  std::vector<std::string> order;  // formulations, as they come
  std::map<std::string, Table> tables;
  for (const Curve& curve : curves(records)) {
    const CurveIdentity& id = *curve.identity;
    const std::string& formulation = id.formulation;
    const bool constrained = id.options->contains("form");
    if (!tables.contains(formulation)) {
      order.push_back(formulation);
      std::vector<Column> columns{{.header = "method"}, {.header = "form"}};
      for (const auto& [quantity, title] : quantities())
        if (constrained || quantity.component != "lambda") columns.push_back({.header = title});
      columns.push_back({.header = "window in h", .unit = "s"});
      tables.emplace(formulation, Table("", columns));
    }
    Row line{method_name(id), form_name(id)};
    double h_min = 0.0, h_max = 0.0;
    for (const auto& [quantity, title] : quantities()) {
      if (!constrained && quantity.component == "lambda") continue;
      const int expected = expected_order(id, quantity);
      const Judgement judgement = judge(curve, quantity, expected);
      ++matrix.entries;
      matrix.confirmed += judgement.confirmed ? 1 : 0;
      line.push_back(measured(judgement, expected));
      Row row{formulation,
              method_name(id),
              form_name(id),
              id.start,
              describe(quantity),
              std::int64_t(expected),
              Cell{},
              Cell{},
              Cell{},
              Cell{},
              Cell{},
              judgement.confirmed,
              judgement.fit.reason};
      if (judgement.fit.estimate) {
        const OrderEstimate& e = *judgement.fit.estimate;
        row[6] = e.order;
        row[7] = e.uncertainty;
        row[8] = e.h_min;
        row[9] = e.h_max;
        row[10] = std::int64_t(e.points);
        h_min = h_min > 0.0 ? std::min(h_min, e.h_min) : e.h_min;
        h_max = std::max(h_max, e.h_max);
      }
      matrix.rows.push_back(std::move(row));
    }
    line.push_back(fmt::format("{:.2g} to {:.2g}", h_min, h_max));
    tables.at(formulation).add_row(std::move(line));
  }
  for (const std::string& formulation : order)
    matrix.markdown += fmt::format("### {}\n\n{}\n", formulation, to_markdown(tables.at(formulation)));
  return matrix;
}

}  // namespace liebench
