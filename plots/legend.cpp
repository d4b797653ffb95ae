#include "plots/legend.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "plots/edge_marks.h"
#include "plots/text.h"

namespace liebench {
namespace {

constexpr double legend_gap = 20;
constexpr std::string_view legend_grey = "#404040";

bool any_failure(const Panel& panel) {
  return std::ranges::any_of(panel.series, [](const Series& series) { return !failures_of(series).empty(); });
}

bool any_at_edge(const Panel& panel, const Axes& axes) {
  for (const Series& series : panel.series) {
    for (const Point& point : series.points) {
      const Place place = place_of(point, axes);
      if (place == Place::below || place == Place::above) return true;
    }
  }
  return false;
}

}  // namespace

double Legend::height() const {
  return entries.empty() ? 0 : legend_row * static_cast<double>(rows) + 8;
}

double Legend::width() const {
  const std::vector<double> widths = column_widths();
  return std::accumulate(widths.begin(), widths.end(), -legend_gap);
}

std::vector<double> Legend::column_widths() const {
  std::vector<double> result((entries.size() + rows - 1) / rows, 0.0);
  for (std::size_t index = 0; index < entries.size(); ++index) {
    double& width = result[index / rows];
    width = std::max(width, legend_sample + 6 + text_width(entries[index].label) + legend_gap);
  }
  return result;
}

Legend legend_of(std::span<const Panel> panels, std::span<const Axes> axes, double width,
                 const std::string& failures_text) {
  std::vector<std::tuple<std::string, std::string, int, bool, int>> seen;
  std::vector<const Series*> primary;
  std::vector<const Series*> secondary;
  bool failures = false;
  bool edges = false;
  for (std::size_t index = 0; index < panels.size(); ++index) {
    for (const Series& series : panels[index].series) {
      const auto key = std::tuple(series.tag, series.label, series.style, series.secondary, series.mark);
      if (series.label.empty() || std::ranges::find(seen, key) != seen.end()) continue;
      seen.push_back(key);
      (series.secondary ? secondary : primary).push_back(&series);
    }
    failures = failures || any_failure(panels[index]);
    edges = edges || any_at_edge(panels[index], axes[index]);
  }

  // The two variants of a style stand below each other, what needs no style in a column of its own.
  Legend result;
  const bool paired = !primary.empty() && primary.size() == secondary.size();
  const auto add = [&](const Series* series) {
    result.entries.push_back(
        {look_of(*series), series->tag.empty() ? series->label : series->tag + "  " + series->label});
  };
  for (std::size_t index = 0; index < primary.size(); ++index) {
    add(primary[index]);
    if (paired) add(secondary[index]);
  }
  if (!paired) std::ranges::for_each(secondary, add);

  if (failures)
    result.entries.push_back(
        {failure_look(legend_grey, false), failures_text.empty() ? "failed run" : failures_text});
  if (edges) result.entries.push_back({below_look(legend_grey), "beyond the axis"});

  const std::size_t step = paired ? 2 : 1;
  for (result.rows = step; result.rows < result.entries.size() && result.width() > width;)
    result.rows += step;
  return result;
}

}  // namespace liebench
