#include "plots/axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "plots/edge_marks.h"

namespace liebench {
namespace {

/// Part of an axis' length left free at an end.
constexpr double pad = 0.05;

/// The extent of the data in axis coordinates (log10 of the values on a logarithmic axis).
struct Extent {
  double lower = std::numeric_limits<double>::infinity();
  double upper = -std::numeric_limits<double>::infinity();

  void include(double value, bool logarithmic) {
    if (!on_axis(value, logarithmic)) return;
    const double coordinate = to_axis(value, logarithmic);
    lower = std::min(lower, coordinate);
    upper = std::max(upper, coordinate);
  }
  void include(const Extent& other) {
    lower = std::min(lower, other.lower);
    upper = std::max(upper, other.upper);
  }
};

Extent x_extent(const Panel& panel) {
  Extent extent;
  for (const Series& series : panel.series) {
    for (const Point& point : series.points) extent.include(point.x, panel.log_x);
    for (const Point& failure : series.failures) extent.include(failure.x, panel.log_x);
  }
  return extent;
}

Extent y_extent(const Panel& panel) {
  Extent extent;
  for (const Series& series : panel.series) {
    for (const Point& point : series.points) extent.include(point.y, panel.log_y);
  }
  return extent;
}

// The pads are parts of the axis' length left free at its ends.
Range padded(Extent extent, bool logarithmic, double pad_lower, double pad_upper) {
  if (extent.lower > extent.upper) extent = {0, 1};
  if (logarithmic) {
    // A logarithmic axis is readable only with two labelled powers of ten on it.
    const double first = std::ceil(extent.lower - 1e-9);
    const double last = std::floor(extent.upper + 1e-9);
    if (last - first < 1) {
      extent.lower = std::floor(extent.lower + 1e-9);
      extent.upper = std::max(std::ceil(extent.upper - 1e-9), extent.lower + 1);
    }
  } else if (extent.upper - extent.lower <=
             1e-12 * std::max(std::abs(extent.lower), std::abs(extent.upper))) {
    const double margin = std::max(std::abs(extent.upper) * 0.1, std::numeric_limits<double>::min() * 1e6);
    extent.lower -= margin;
    extent.upper += margin;
  }
  const double length = (extent.upper - extent.lower) / (1 - pad_lower - pad_upper);
  const double lower = extent.lower - pad_lower * length;
  const double upper = extent.upper + pad_upper * length;
  if (!logarithmic) return {lower, upper};
  return {from_axis(std::max(lower, -307.0), true), from_axis(std::min(upper, 307.9), true)};
}

/// Of all panels with this panel's x label.
Range x_range_of(const Figure& figure, const Panel& panel, std::span<const Extent> extents) {
  if (panel.x_range) return *panel.x_range;
  Extent extent;
  for (std::size_t index = 0; index < extents.size(); ++index) {
    const Panel& other = figure.panels[index];
    if (other.x_label == panel.x_label && other.log_x == panel.log_x) extent.include(extents[index]);
  }
  return padded(extent, panel.log_x, pad, pad);
}

/// Of all panels with this panel's y label in its row; above the data there is room for the failed runs.
Range y_range_of(const Figure& figure, std::size_t index, std::span<const Axes> axes) {
  const Panel& panel = figure.panels[index];
  if (panel.y_range) return *panel.y_range;
  const auto columns = static_cast<std::size_t>(figure.columns);
  Extent extent;
  int levels = 0;
  for (std::size_t other = 0; other < figure.panels.size(); ++other) {
    const Panel& beside = figure.panels[other];
    if (other / columns != index / columns || beside.y_label != panel.y_label || beside.log_y != panel.log_y)
      continue;
    extent.include(y_extent(beside));
    for (const FailureMark& mark : failure_marks(beside, axes[other].x)) {
      levels = std::max(levels, mark.level + 1);
    }
  }
  const double pad_upper = levels > 0 ? failure_room(levels) / axes[index].y.length : pad;
  return padded(extent, panel.log_y, pad, pad_upper);
}

}  // namespace

std::vector<Axes> axes_of(const Figure& figure, PlotArea area) {
  std::vector<Axes> result;
  std::vector<Extent> extents;
  for (const Panel& panel : figure.panels) extents.push_back(x_extent(panel));
  for (const Panel& panel : figure.panels) {
    result.push_back(
        {{x_range_of(figure, panel, extents), panel.log_x, area.width}, {Range{}, panel.log_y, area.height}});
  }
  for (std::size_t index = 0; index < result.size(); ++index) {
    result[index].y.range = y_range_of(figure, index, result);
  }
  return result;
}

std::string logarithmic_ticks(const Scale& scale, double spacing) {
  const double lower = std::log10(scale.range.lower);
  const double upper = std::log10(scale.range.upper);
  const double decade = scale.points_per_unit();
  const int step = std::max(1, static_cast<int>(std::ceil(spacing / decade)));
  const int first = static_cast<int>(std::ceil(lower - 1e-9));
  const int last = static_cast<int>(std::floor(upper + 1e-9));
  std::vector<std::string> ticks;
  for (int exponent = first; exponent <= last; ++exponent) {
    if (exponent % step == 0) {
      ticks.push_back(fmt::format("1e{}", exponent));
    } else if (decade > 3) {
      ticks.push_back(fmt::format("'' 1e{} 1", exponent));
    }
  }
  if (step == 1 && decade > 25) {
    for (int exponent = first - 1; exponent <= last; ++exponent) {
      for (int digit = 2; digit <= 9; ++digit) {
        const double place = exponent + std::log10(digit);
        if (place > lower && place < upper) ticks.push_back(fmt::format("'' {}e{} 1", digit, exponent));
      }
    }
  }
  return fmt::format("({})", fmt::join(ticks, ", "));
}

}  // namespace liebench
