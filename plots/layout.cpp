#include "plots/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <stdexcept>

namespace liebench {
namespace {

// All in points. The margins hold "10^{-28}" and a label at font_size; the title's room is given up when no
// panel has one.
constexpr double margin_left = 67;
constexpr double margin_right = 12;
constexpr double margin_bottom = 46;
constexpr double margin_top = 28;
constexpr double margin_top_untitled = 10;
constexpr double figure_title = 22;
/// Of a second line of a y label.
constexpr double label_line = 14;

void check(const Figure& figure) {
  const auto refuse = [&](const std::string& reason) {
    throw std::invalid_argument(fmt::format("figure '{}': {}", figure.title, reason));
  };
  if (figure.rows < 1 || figure.columns < 1 || figure.panels.empty()) refuse("it has no panel");
  if (figure.panels.size() >
      static_cast<std::size_t>(figure.rows) * static_cast<std::size_t>(figure.columns)) {
    refuse(
        fmt::format("{} panels do not fit into {} x {}", figure.panels.size(), figure.rows, figure.columns));
  }
  for (const Panel& panel : figure.panels) {
    const auto check_range = [&](const std::optional<Range>& range, bool logarithmic, char axis) {
      if (range && !(on_axis(range->lower, logarithmic) && on_axis(range->upper, logarithmic) &&
                     range->lower < range->upper)) {
        refuse(
            fmt::format("panel '{}': no {} range: {} to {}", panel.title, axis, range->lower, range->upper));
      }
    };
    check_range(panel.x_range, panel.log_x, 'x');
    check_range(panel.y_range, panel.log_y, 'y');
  }
}

}  // namespace

Layout lay_out(const Figure& figure) {
  check(figure);
  const std::span<const Panel> panels = figure.panels;
  const PlotArea area = figure.columns == 1 ? PlotArea{330, 230} : PlotArea{204, 172};
  const std::vector<Axes> axes = axes_of(figure, area);

  Layout layout;
  std::size_t label_lines = 1;
  for (std::size_t index = 0; index < panels.size(); ++index) {
    layout.panels.push_back({.axes = axes[index], .y_label = fit(panels[index].y_label, area.height)});
    label_lines = std::max(label_lines, layout.panels[index].y_label.lines.size());
  }
  const double left = margin_left + label_line * static_cast<double>(label_lines - 1);
  const double cell_width = left + area.width + margin_right;
  layout.width = figure.columns * cell_width;

  // Of the highest legend below a panel, and of the one below all.
  double own = 0;
  double shared = 0;
  if (figure.shared_legend) {
    layout.legend = legend_of(panels, axes, layout.width - 20, figure.failures);
    shared = layout.legend.height();
    layout.legend_place = {0, 0, layout.width, shared};
  } else {
    for (std::size_t index = 0; index < panels.size(); ++index) {
      Legend& legend = layout.panels[index].legend;
      legend = legend_of(panels.subspan(index, 1), std::span(axes).subspan(index, 1), cell_width - 10,
                         figure.failures);
      own = std::max(own, legend.height());
    }
  }

  const bool titled = std::ranges::any_of(panels, [](const Panel& panel) { return !panel.title.empty(); });
  const double top = titled ? margin_top : margin_top_untitled;
  const double cell_height = top + area.height + margin_bottom + own;
  layout.height = (figure.title.empty() ? 0 : figure_title) + figure.rows * cell_height + shared;
  const auto columns = static_cast<std::size_t>(figure.columns);
  for (std::size_t index = 0; index < panels.size(); ++index) {
    const std::size_t row = index / columns;
    const auto column = static_cast<double>(index % columns);
    PanelLayout& panel = layout.panels[index];
    panel.plot = {column * cell_width + left,
                  shared + (figure.rows - 1 - static_cast<double>(row)) * cell_height + own + margin_bottom,
                  area.width, area.height};
    const double height = panel.legend.height();
    panel.legend_place = {column * cell_width, panel.plot.lower - margin_bottom - height, cell_width, height};
  }
  return layout;
}

}  // namespace liebench
