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
    panel.series.push_back(std::move(series));
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

Figure transient_figure(const std::vector<Json>& records, int k) {
  struct Content {
    const char* title;
    const char* label;
    Quantity quantity;
    std::vector<int> orders;
  };
  const std::vector<Content> contents{
      {"multipliers λ, maximum", "maximum error of λ in N", {"lambda", "max_absolute"}, {k - 1, k}},
      {"multipliers λ, at t_{end}", "error of λ at t_{end} in N", {"lambda", "end_absolute"}, {k}},
      {"configuration q, maximum", "maximum error of q", {"q", "max_absolute"}, {k}},
      {"velocity v, maximum", "maximum error of v", {"v", "max_absolute"}, {k}}};
  Figure figure{.title = fmt::format("Global errors for k = {} (constrained heavy top, R^3×SO(3))", k),
                .rows = 2,
                .columns = 2,
                .panels = {}};
  for (const Content& content : contents) {
    Panel panel{.title = content.title, .x_label = step_label, .y_label = content.label};
    for (const bool modified : {false, true})
      add_curves(
          panel, records,
          [&](const Json& r) { return has_option(r, "k", k) && has_option(r, "modified_start", modified); },
          content.quantity, modified ? "starting velocities modified, eq. (56)" : "exact starting velocities",
          modified ? 2 : 0, !modified);
    for (const int order : content.orders) panel.orders.push_back({.order = order});
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
  static const std::vector<PaperFigure> list{{"figure1", {"figure1.json"}},
                                             {"figure2", {"figure2.json"}},
                                             {"figure3", {"figure3.json", "figure3_small_steps.json"}},
                                             {"figure4", {"figure4.json"}}};
  return list;
}

std::map<std::string, Figure> draw_paper_figure(const PaperFigure& figure, const std::vector<Json>& records) {
  if (figure.name == "figure1")
    return {{"figure1", transient_figure(records, 2)},
            {"figure1_k3", transient_figure(records, 3)},
            {"figure1_k4", transient_figure(records, 4)}};
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
