#include "harness/order_matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "harness/errors.h"
#include "harness/methods.h"

namespace liebench {

namespace {

bool constrained(const Curve& curve) {
  if (curve.identity->options->contains("form")) return true;
  return std::any_of(curve.records.begin(), curve.records.end(), [](const RecordRow* record) {
    return error_of(*record, {"lambda", "end_relative"}).has_value();
  });
}

std::string form_name(const CurveIdentity& identity, bool has_lambda) {
  const Json& options = *identity.options;
  if (!options.contains("form")) return has_lambda ? "its own" : "unconstrained";
  if (options.at("form") == "stabilized_index2") return "stabilized index 2";
  return options.value("modified_start", false) ? "index 3, modified start" : "index 3";
}

// Velocities in the body frame, in which the constraint of the top is a subalgebra.
bool body_fixed(const CurveIdentity& identity) {
  return identity.formulation == "SE3" || identity.formulation == "S3|xR3" || identity.formulation == "UDQ";
}

std::string measured(const Judgement& judgement, std::optional<double> expected) {
  std::string text = "does not fall";
  if (judgement.fit.estimate)
    text = fmt::format("{:.2f} ± {:.2f}", judgement.fit.estimate->order, judgement.fit.estimate->uncertainty);
  else if (judgement.fit.outcome != OrderOutcome::not_falling)
    text = "no order";
  if (!expected) return "(" + text + ")";
  return judgement.confirmed ? text : fmt::format("**{}, expected {}**", text, *expected);
}

const MethodInfo& known_method(const CurveIdentity& identity) {
  const MethodInfo* method = find_method(identity.integrator);
  if (method == nullptr)
    throw InputError(identity.integrator,
                     "this program has no such integrator, and so no order to expect of it");
  return *method;
}

// Of a method that raises its order from that of its first steps, with h_0 in proportion to tol^{1 / (first_steps + 1)}.
std::optional<double> expected_by_tolerance(const ConvergenceOrders& orders, const CurveIdentity& identity,
                                            const Quantity& quantity) {
  const int p = quantity.component == "q" ? orders.q : quantity.component == "v" ? orders.v : orders.lambda;
  if (orders.first_steps == 0 || body_fixed(identity) || quantity.component == "q") return p;
  const double of_first_step = double(orders.estimate) / (orders.first_steps + 1);
  const double of_first_errors = std::min(double(p), orders.first_steps * of_first_step);
  const bool index3 = identity.form() == "index3", largest = quantity.norm == "max_absolute";
  if (quantity.component == "v") return index3 && largest ? of_first_errors : p;
  if (!index3) return largest ? of_first_errors : p;
  // At the end it depends on how long ago a step changed.
  if (!largest) return std::nullopt;
  return (orders.first_steps - 1) * of_first_step;
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
  const MethodInfo* method = find_method(identity.integrator);
  // A record of a program that has more methods.
  if (method == nullptr) return identity.integrator;
  return method->title(options_from_json(*method, *identity.options));
}

std::optional<double> expected_order(const CurveIdentity& identity, const Quantity& quantity) {
  const Json& options = *identity.options;
  const MethodInfo& method = known_method(identity);
  const ConvergenceOrders orders = method.orders(options_from_json(method, options));
  if (method.chooses_steps) return expected_by_tolerance(orders, identity, quantity);
  // Where the constraint of the top is a subalgebra these lose nothing (docs/theory.md, "Formulations"); HERK3 does, for its lambda is a
  // combination of several stages.
  const bool whole_in_subalgebra =
      identity.integrator == "radau" ||
      (identity.integrator == "half_explicit" && options.value("tableau", "") != "herk3");
  if (body_fixed(identity) && whole_in_subalgebra) return orders.q;
  if (quantity.component != "lambda") return quantity.component == "q" ? orders.q : orders.v;
  const bool reduced = quantity.norm == "max_absolute" && options.contains("modified_start") &&
                       options.at("modified_start") == false && !body_fixed(identity);
  return reduced ? std::max(0, orders.lambda - 1) : orders.lambda;
}

namespace {

// Against the step size; of a method that chooses its steps against the one that a tolerance asks for, tol^{1 / estimate}, which its
// safety factors and its start keep out of; the window is of mean steps.
OrderFit fit_of(const Curve& curve, const Quantity& quantity) {
  const MethodInfo* method = curve.identity ? find_method(curve.identity->integrator) : nullptr;
  if (method == nullptr || !method->chooses_steps) return fit_curve(curve, quantity);
  const ConvergenceOrders orders = method->orders(options_from_json(*method, *curve.identity->options));
  if (orders.estimate == 0) return fit_curve(curve, quantity);
  std::vector<ErrorPoint> points;
  double reference_error = 0.0;
  for (const RecordRow* record : curve.records) {
    const std::optional<double> error = error_of(*record, quantity);
    const std::optional<double> tolerance = (*record)[record_number("options/tolerance")];
    if (!error || !tolerance) continue;
    points.push_back({std::pow(*tolerance, 1.0 / orders.estimate), *error});
    reference_error =
        std::max(reference_error, record->numbers[std::size_t(record_number("reference/error_estimate"))]);
  }
  OrderFit fit = fit_scattered(points, reference_error);
  if (fit.estimate) {
    fit.estimate->h_min = curve.records.back()->step_size();
    fit.estimate->h_max = curve.records.front()->step_size();
  }
  return fit;
}

}  // namespace

Judgement judge(const Curve& curve, const Quantity& quantity, double expected) {
  Judgement judgement{.confirmed = false, .fit = fit_of(curve, quantity)};
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
          {.header = "expected", .kind = ColumnKind::number, .alignment = Alignment::right},
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
  const std::vector<Curve> all = curves(records);
  // Of the formulation, not of the curve: a method without forms whose runs all fail has neither a form nor a lambda to
  // tell it by.
  std::set<std::string> with_lambda;
  for (const Curve& curve : all)
    if (constrained(curve)) with_lambda.insert(curve.identity->formulation);
  for (const Curve& curve : all) {
    const CurveIdentity& id = *curve.identity;
    const std::string& formulation = id.formulation;
    const bool has_lambda = with_lambda.contains(formulation);
    if (!tables.contains(formulation)) {
      order.push_back(formulation);
      std::vector<Column> columns{{.header = "method"}, {.header = "form"}};
      for (const auto& [quantity, title] : quantities())
        if (has_lambda || quantity.component != "lambda") columns.push_back({.header = title});
      columns.push_back({.header = "window in h", .unit = "s"});
      tables.emplace(formulation, Table("", columns));
    }
    Row line{method_name(id), form_name(id, has_lambda)};
    double h_min = 0.0, h_max = 0.0;
    for (const auto& [quantity, title] : quantities()) {
      if (!has_lambda && quantity.component == "lambda") continue;
      const std::optional<double> expected = expected_order(id, quantity);
      const Judgement judgement = judge(curve, quantity, expected.value_or(0.0));
      if (expected) {
        ++matrix.entries;
        matrix.confirmed += judgement.confirmed ? 1 : 0;
      }
      line.push_back(measured(judgement, expected));
      Row row{formulation,
              method_name(id),
              form_name(id, has_lambda),
              id.start,
              describe(quantity),
              Cell{},
              Cell{},
              Cell{},
              Cell{},
              Cell{},
              Cell{},
              Cell{},
              judgement.fit.reason};
      if (expected) {
        row[5] = *expected;
        row[11] = judgement.confirmed;
      }
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
    line.push_back(h_max > 0.0 ? fmt::format("{:.2g} to {:.2g}", h_min, h_max) : "");
    tables.at(formulation).add_row(std::move(line));
  }
  for (const std::string& formulation : order)
    matrix.markdown += fmt::format("### {}\n\n{}\n", formulation, to_markdown(tables.at(formulation)));
  return matrix;
}

}  // namespace liebench
