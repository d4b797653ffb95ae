#include "harness/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "harness/select.h"

namespace liebench {

namespace {

using Filter = std::function<bool(const Json& record)>;

bool has_option(const Json& record, const char* name, const Json& value) {
  return record.at("options").at(name) == value;
}

// One curve in extended and in double precision: the second shows where round-off takes over.
void add_curves(Panel& panel, const std::vector<Json>& records, const Filter& filter,
                const Quantity& quantity, const std::string& label, int style, bool broad = false) {
  for (const char* precision : {"extended", "double"}) {
    const bool secondary = std::string_view(precision) == "double";
    Series series{.label = label + (secondary ? ", double" : ""),
                  .style = style,
                  .secondary = secondary,
                  .broad = broad};
    for (const Json& record : records) {
      if (record.at("precision") != precision || !filter(record)) continue;
      const double h = record.at("step_size").get<double>();
      if (record.at("outcome") != "ok")
        series.failures.push_back({h, 0.0});
      else if (const auto error = error_of(record, quantity))
        series.points.push_back({h, *error});
    }
    std::sort(series.points.begin(), series.points.end(),
              [](const Point& a, const Point& b) { return a.x > b.x; });
    if (!series.points.empty() || !series.failures.empty()) panel.series.push_back(std::move(series));
  }
}

constexpr const char* step_label = "step size h in s";

Panel orders_panel(const std::vector<Json>& records, std::string title, std::string y_label, bool correction,
                   const Quantity& quantity, const std::vector<int>& orders, const std::string& formulation) {
  Panel panel{.title = std::move(title), .x_label = step_label, .y_label = std::move(y_label)};
  for (int k = 2; k <= 4; ++k)
    add_curves(
        panel, records,
        [&](const Json& r) {
          return r.at("formulation") == formulation && has_option(r, "k", k) &&
                 has_option(r, "correction", correction);
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
Figure transient_figure(const std::vector<Json>& records, std::string title, int order,
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
Figure modified_start_figure(const std::vector<Json>& records, int k) {
  const auto filter = [k](bool modified) {
    return [k, modified](const Json& r) {
      return has_option(r, "k", k) && has_option(r, "modified_start", modified);
    };
  };
  return transient_figure(records,
                          fmt::format("Global errors for k = {} (constrained heavy top, R^3×SO(3))", k), k,
                          {{"exact starting velocities", filter(false), 0, true},
                           {"starting velocities modified, eq. (56)", filter(true), 2, false}});
}

// Theorem 3: the first four steps cover n = k, ..., 2k - 1 for every k <= 4.
Figure first_steps_figure(const std::vector<Json>& records) {
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
          [k](const Json& r) { return has_option(r, "k", k) && has_option(r, "modified_start", true); },
          {component, "max_absolute"}, fmt::format("k = {}", k), k - 2);
      panel.orders.push_back({.order = component == "q" ? k + 1 : k, .near = fmt::format("k = {}", k)});
    }
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

Figure generalized_alpha_figure(const std::vector<Json>& records) {
  const auto filter = [](const char* form, bool modified) {
    return [form, modified](const Json& r) {
      return r.at("formulation") == "R3xSO3" && has_option(r, "form", form) &&
             has_option(r, "modified_start", modified);
    };
  };
  return transient_figure(records, "Generalized-α, ρ_∞ = 0.9 (constrained heavy top, R^3×SO(3))", 2,
                          {{"index 3", filter("index3", false), 0, true},
                           {"index 3, perturbed starting velocity", filter("index3", true), 2, false},
                           {"stabilized index 2", filter("stabilized_index2", false), 1, false}});
}

Figure stabilized_figure(const std::vector<Json>& records) {
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
          panel, records, [k](const Json& r) { return has_option(r, "k", k); }, {component, "max_absolute"},
          fmt::format("k = {}", k), k - 2);
      panel.orders.push_back({.order = k, .near = fmt::format("k = {}", k)});
    }
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

Figure two_columns(const std::vector<Json>& records, const std::string& title, const std::string& formulation,
                   const std::vector<std::pair<Quantity, std::string>>& rows, int offset) {
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
      {"stabilized_index2", {"stabilized_index2.json"}}};
  return list;
}

std::map<std::string, Figure> draw_paper_figure(const PaperFigure& figure, const std::vector<Json>& records) {
  if (figure.name == "figure1")
    return {{"figure1", modified_start_figure(records, 2)},
            {"figure1_k3", modified_start_figure(records, 3)},
            {"figure1_k4", modified_start_figure(records, 4)}};
  if (figure.name == "first_steps") return {{"first_steps", first_steps_figure(records)}};
  if (figure.name == "generalized_alpha") return {{"generalized_alpha", generalized_alpha_figure(records)}};
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
