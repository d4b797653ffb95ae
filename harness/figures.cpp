#include "harness/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "harness/correction_stability.h"
#include "harness/cost_report.h"
#include "harness/field.h"
#include "harness/formulations.h"
#include "harness/select.h"

namespace liebench {

namespace {

using Filter = std::function<bool(const CurveIdentity& curve)>;

// One curve in extended and in double precision: the second shows where round-off takes over.
void add_curves(Panel& panel, const std::vector<RecordRow>& records, const Filter& filter,
                const Quantity& quantity, const std::string& label, int style, bool broad = false) {
  for (const char* precision : {"extended", "double"}) {
    const bool secondary = std::string_view(precision) == "double";
    Series series{.label = label + (secondary ? ", double" : ""),
                  .style = style,
                  .secondary = secondary,
                  .broad = broad};
    for (const RecordRow& record : records) {
      if (record.curve->precision != precision || !filter(*record.curve)) continue;
      if (!record.ended_well())
        series.failures.push_back({record.step_size(), 0.0});
      else if (const auto error = error_of(record, quantity))
        series.points.push_back({record.step_size(), *error});
    }
    std::sort(series.points.begin(), series.points.end(),
              [](const Point& a, const Point& b) { return a.x > b.x; });
    if (!series.points.empty() || !series.failures.empty()) panel.series.push_back(std::move(series));
  }
}

constexpr const char* step_label = "step size h in s";
constexpr double largest_angle = std::numbers::pi;  // of a step

// |Omega(t_0)| of a study of one heavy top, rad/s.
double initial_speed(const std::vector<RecordRow>& records) {
  double squared = 0.0;
  for (const Json& component : records.front().curve->parameters->at("angular_velocity"))
    squared += component.get<double>() * component.get<double>();
  return std::sqrt(squared);
}

Panel orders_panel(const std::vector<RecordRow>& records, std::string title, std::string y_label,
                   bool correction, const Quantity& quantity, const std::vector<int>& orders,
                   const std::string& formulation) {
  Panel panel{.title = std::move(title), .x_label = step_label, .y_label = std::move(y_label)};
  for (int k = 2; k <= 4; ++k)
    add_curves(
        panel, records,
        [&](const CurveIdentity& c) {
          return c.formulation == formulation && c.has_option("k", k) &&
                 c.has_option("correction", correction);
        },
        quantity, fmt::format("k = {}", k), k - 2);
  for (std::size_t i = 0; i < orders.size(); ++i)
    panel.orders.push_back({.order = orders[i], .near = correction ? fmt::format("k = {}", i + 2) : ""});
  return panel;
}

// A curve of a transient figure: which records, and how it looks.
struct TransientCurve {
  std::string label;
  Filter filter;
  int style;
  bool broad;
};

// Maximum and end error of lambda, maximum errors of q and v; `order` is that of the method.
Figure transient_figure(const std::vector<RecordRow>& records, std::string title, int order,
                        const std::vector<TransientCurve>& curves) {
  struct Content {
    const char* title;
    const char* label;
    Quantity quantity;
    std::vector<int> orders;
  };
  const std::vector<Content> contents{
      {"multipliers λ, maximum", "maximum error of λ in N", {"lambda", "max_absolute"}, {order - 1, order}},
      {"multipliers λ, at t_{end}", "error of λ at t_{end} in N", {"lambda", "end_absolute"}, {order}},
      {"configuration q, maximum", "maximum error of q in m, rad", {"q", "max_absolute"}, {order}},
      {"velocity v, maximum", "maximum error of v in m/s, rad/s", {"v", "max_absolute"}, {order}}};
  Figure figure{.title = std::move(title), .rows = 2, .columns = 2, .panels = {}};
  for (const Content& content : contents) {
    Panel panel{.title = content.title, .x_label = step_label, .y_label = content.label};
    for (const TransientCurve& curve : curves)
      add_curves(panel, records, curve.filter, content.quantity, curve.label, curve.style, curve.broad);
    for (const int slope : content.orders) panel.orders.push_back({.order = slope});
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

// Figure 1 for any k.
Figure modified_start_figure(const std::vector<RecordRow>& records, int k) {
  const auto filter = [k](bool modified) {
    return [k, modified](const CurveIdentity& c) {
      return c.has_option("k", k) && c.has_option("modified_start", modified);
    };
  };
  return transient_figure(records,
                          fmt::format("Global errors for k = {} (constrained heavy top, R^3×SO(3))", k), k,
                          {{"exact starting velocities", filter(false), 0, true},
                           {"starting velocities modified, eq. (56)", filter(true), 2, false}});
}

// Theorem 3: the first four steps cover n = k, ..., 2k - 1 for every k <= 4.
Figure first_steps_figure(const std::vector<RecordRow>& records) {
  Figure figure{
      .title = "Largest errors of the first four steps, starting velocities by eq. (56) (R^3×SO(3))",
      .rows = 1,
      .columns = 3,
      .panels = {}};
  const std::vector<std::pair<std::string, std::string>> components{
      {"q", "error of q in m, rad"}, {"v", "error of v in m/s, rad/s"}, {"lambda", "error of λ in N"}};
  for (const auto& [component, label] : components) {
    Panel panel{.title = "", .x_label = step_label, .y_label = label};
    for (int k = 2; k <= 4; ++k) {
      add_curves(
          panel, records,
          [k](const CurveIdentity& c) {
            return c.has_option("k", k) && c.has_option("modified_start", true);
          },
          {component, "max_absolute"}, fmt::format("k = {}", k), k - 2);
      panel.orders.push_back({.order = component == "q" ? k + 1 : k, .near = fmt::format("k = {}", k)});
    }
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

Figure generalized_alpha_figure(const std::vector<RecordRow>& records) {
  const auto filter = [](const char* form, bool modified) {
    return [form, modified](const CurveIdentity& c) {
      return c.formulation == "R3xSO3" && c.has_option("form", form) &&
             modified == c.has_option("modified_start", true);
    };
  };
  return transient_figure(records, "Generalized-α, ρ_∞ = 0.9 (constrained heavy top, R^3×SO(3))", 2,
                          {{"index 3", filter("index3", false), 0, true},
                           {"index 3, perturbed starting velocity", filter("index3", true), 2, false},
                           {"stabilized index 2", filter("stabilized_index2", false), 1, false}});
}

Figure stabilized_figure(const std::vector<RecordRow>& records) {
  Figure figure{.title = "BLieDF2nd in the stabilized index-2 form (heavy top, R^3×SO(3))",
                .rows = 1,
                .columns = 2,
                .panels = {}};
  const std::vector<std::pair<std::string, std::string>> components{{"q", "maximum error of q in m, rad"},
                                                                    {"lambda", "maximum error of λ in N"}};
  for (const auto& [component, label] : components) {
    Panel panel{.title = "", .x_label = step_label, .y_label = label};
    for (int k = 2; k <= 4; ++k) {
      add_curves(
          panel, records, [k](const CurveIdentity& c) { return c.has_option("k", k); },
          {component, "max_absolute"}, fmt::format("k = {}", k), k - 2);
      panel.orders.push_back({.order = k, .near = fmt::format("k = {}", k)});
    }
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

Figure faltinsen_figure(const std::vector<RecordRow>& records) {
  const auto filter = [](const char* variant, const char* form, bool modified) {
    return [=](const CurveIdentity& c) {
      return c.has_option("variant", variant) && c.has_option("form", form) &&
             modified == c.has_option("modified_start", true);
    };
  };
  return transient_figure(
      records, "Faltinsen BDF, k = 2 (constrained heavy top, R^3×SO(3))", 2,
      {{"index 3", filter("exact", "index3", false), 0, true},
       {"index 3, modified starting velocities", filter("exact", "index3", true), 2, false},
       {"the same, variant bch", filter("bch", "index3", true), 3, false},
       {"stabilized index 2", filter("exact", "stabilized_index2", false), 1, false}});
}

// Errors against h |Omega|, with the predicted bounds of the correction term.
Figure correction_stability_figure(const std::vector<RecordRow>& records) {
  Figure figure{
      .title = "The correction term in the index-3 form: predicted bounds and blow-up (R^3×SO(3), 2 s)",
      .rows = 2,
      .columns = 2,
      .panels = {}};
  for (int k = 3; k <= 6; ++k) {
    Panel panel{.title = fmt::format("k = {}", k),
                .x_label = "h |Ω|",
                .y_label = "largest error of v in m/s, rad/s",
                .y_range = Range{1e-9, 1e6}};
    for (const bool implicit : {false, true}) {
      const Json value = implicit ? Json("implicit") : Json(true);
      const int style = implicit ? 1 : 3;
      const char* label = implicit ? "L_k implicit" : "L_k explicit";
      add_curves(
          panel, records,
          [&](const CurveIdentity& c) { return c.has_option("k", k) && c.has_option("correction", value); },
          {"v", "max_absolute"}, label, style);
      const double bound = correction_stability_bound(k, implicit, largest_angle);
      if (bound < largest_angle)
        panel.lines.push_back(
            {bound, fmt::format("{} {:.3g}", implicit ? "implicit" : "explicit", bound), style});
    }
    for (Series& series : panel.series) {
      for (Point& point : series.points) point.x *= initial_speed(records);
      for (Point& point : series.failures) point.x *= initial_speed(records);
      series.label = series.label.substr(0, series.label.find(", double"));
      series.secondary = false;
    }
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

// Above: error at equal step; below: at equal cost. Unconstrained, index 3, stabilized index 2.
Figure formulations_figure(const std::vector<RecordRow>& records) {
  Figure figure{
      .title = "BLieDF2nd, k = 3, in all formulations of the heavy top (double precision, own start)",
      .rows = 2,
      .columns = 3,
      .panels = {}};
  const std::vector<std::pair<const char*, const char*>> forms{
      {"", "unconstrained"}, {"index3", "index 3"}, {"stabilized_index2", "stabilized index 2"}};
  const std::vector<const char*> formulations{"SO3", "S3", "R3xSO3", "R3xS3", "SE3", "S3|xR3", "UDQ"};
  for (const bool cost : {false, true})
    for (const auto& [form, title] : forms) {
      Panel panel{.title = cost ? "" : title,
                  .x_label = cost ? "floating point operations of the run" : step_label,
                  .y_label = "largest error of q in m, rad"};
      for (std::size_t i = 0; i < formulations.size(); ++i) {
        // Those with rotation matrices lie beneath: with quaternions the curves are the same.
        const bool matrices = formulations[i] == std::string_view("SO3") ||
                              formulations[i] == std::string_view("R3xSO3") ||
                              formulations[i] == std::string_view("SE3");
        Series series{.label = plain_text(formulations[i]), .style = int(i), .broad = matrices};
        for (const RecordRow& record : records) {
          const CurveIdentity& c = *record.curve;
          if (c.integrator != "bliedf2nd" || !c.has_option("k", 3) || c.formulation != formulations[i] ||
              c.form() != form)
            continue;
          const double x = cost ? record[record_number("cost/flops")].value() : record.step_size();
          if (const auto error = error_of(record, {"q", "max_absolute"}))
            series.points.push_back({x, *error});
          else
            series.failures.push_back({x, 0.0});
        }
        if (!series.points.empty() || !series.failures.empty()) panel.series.push_back(std::move(series));
      }
      if (!cost) panel.orders.push_back({.order = 3});
      figure.panels.push_back(std::move(panel));
    }
  return figure;
}

Figure two_columns(const std::vector<RecordRow>& records, const std::string& title,
                   const std::string& formulation, const std::vector<std::pair<Quantity, std::string>>& rows,
                   int offset) {
  Figure figure{.title = title, .rows = int(rows.size()), .columns = 2, .panels = {}};
  for (const auto& [quantity, label] : rows) {
    figure.panels.push_back(orders_panel(records, "L_k by eq. (22)", label, true, quantity,
                                         {2 + offset, 3 + offset, 4 + offset}, formulation));
    figure.panels.push_back(
        orders_panel(records, "L_k = 0", label, false, quantity, {2 + offset}, formulation));
  }
  return figure;
}

}  // namespace

const std::vector<PaperFigure>& paper_figures() {
  // Without L_k the unconstrained k = 3 shows its order 2 only below h = 2e-6 s: its errors of order 2 and 3 are of
  // opposite sign and cancel near h = 1.5e-5 s.
  static const std::vector<PaperFigure> list{
      {"figure1", {"figure1.json"}},
      {"figure2", {"figure2.json"}},
      {"figure3", {"figure3.json", "figure3_small_steps.json"}},
      {"figure4", {"figure4.json"}},
      {"first_steps", {"first_steps.json"}},
      {"generalized_alpha", {"generalized_alpha.json", "generalized_alpha_so3.json"}},
      {"stabilized_index2", {"stabilized_index2.json"}},
      {"faltinsen_bdf", {"faltinsen_bdf.json"}},
      {"correction_stability", {"correction_stability.json"}},
      {"formulations", {"formulations.json"}},
      {"cost_accuracy", {"cost_accuracy.json"}, true},
      {"field",
       {"field_unconstrained.json", "field_constrained.json", "field_tolerance.json",
        "field_tolerance_constrained.json", "field_mount.json", "field_mount_tolerance.json"},
       true,
       {"field_outside.json", "field_outside_constrained.json", "field_outside_mount.json"}},
      {"verification",
       {"verification.json", "verification_own_start.json", "verification_unconstrained.json",
        "verification_constrained.json", "verification_half_explicit.json", "verification_tolerance.json",
        "verification_tolerance_constrained.json"}}};
  return list;
}

std::map<std::string, Figure> draw_paper_figure(const PaperFigure& figure,
                                                const std::vector<RecordRow>& records) {
  if (figure.name == "figure1")
    return {{"figure1", modified_start_figure(records, 2)},
            {"figure1_k3", modified_start_figure(records, 3)},
            {"figure1_k4", modified_start_figure(records, 4)}};
  if (figure.name == "first_steps") return {{"first_steps", first_steps_figure(records)}};
  if (figure.name == "generalized_alpha") return {{"generalized_alpha", generalized_alpha_figure(records)}};
  if (figure.name == "verification") return {};
  if (figure.name == "faltinsen_bdf") return {{"faltinsen_bdf", faltinsen_figure(records)}};
  if (figure.name == "correction_stability")
    return {{"correction_stability", correction_stability_figure(records)}};
  if (figure.name == "cost_accuracy") return {{"cost_accuracy", cost_accuracy_figure(records)}};
  if (figure.name == "field") return {{"field", field_figure(records)}};
  if (figure.name == "formulations") return {{"formulations", formulations_figure(records)}};
  if (figure.name == "stabilized_index2") return {{"stabilized_index2", stabilized_figure(records)}};
  if (figure.name == "figure2")
    return {{"figure2",
             two_columns(records, "Local errors in q after one step (constrained heavy top, R^3×SO(3))",
                         "R3xSO3", {{{"q", "end_absolute"}, "error of q after one step"}}, 1)}};
  if (figure.name == "figure3")
    return {{"figure3",
             two_columns(records, "Global errors in q at t_{end} = 2 s (unconstrained heavy top, SO(3))",
                         "SO3", {{{"q", "end_relative"}, "relative error of q"}}, 0)}};
  return {{"figure4",
           two_columns(records, "Global errors at t_{end} = 2 s (constrained heavy top, R^3×SO(3))", "R3xSO3",
                       {{{"q", "end_relative"}, "relative error of q"},
                        {{"lambda", "end_relative"}, "relative error of λ"}},
                       0)}};
}

}  // namespace liebench
