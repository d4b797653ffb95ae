#include "plots/edge_marks.h"

#include <algorithm>
#include <cmath>

namespace liebench {
namespace {

constexpr double failure_step = 8;
constexpr int failure_levels = 6;

bool failed(const Point& point) {
  return !std::isfinite(point.y);
}

}  // namespace

std::vector<double> failures_of(const Series& series) {
  std::vector<double> result;
  for (const Point& point : series.failures) result.push_back(point.x);
  for (const Point& point : series.points) {
    if (failed(point)) result.push_back(point.x);
  }
  return result;
}

double FailureMark::position(double height) const {
  return height - edge_distance - failure_step * level;
}

double failure_room(int levels) {
  return levels > 0 ? 2 * edge_distance + failure_step * levels : 0;
}

std::vector<FailureMark> failure_marks(const Panel& panel, const Scale& x) {
  std::vector<FailureMark> result;
  for (std::size_t index = 0; index < panel.series.size(); ++index) {
    for (const double value : failures_of(panel.series[index])) {
      if (!on_axis(value, panel.log_x)) continue;
      const auto beside = std::ranges::count_if(result, [&](const FailureMark& other) {
        return std::abs(x.position(other.x) - x.position(value)) < failure_step;
      });
      result.push_back(
          {index, value, static_cast<int>(std::min<std::ptrdiff_t>(beside, failure_levels - 1))});
    }
  }
  return result;
}

Place place_of(const Point& point, const Axes& axes) {
  if (!on_axis(point.x, axes.x.logarithmic) || failed(point)) return Place::nowhere;
  if (!on_axis(point.y, axes.y.logarithmic) || point.y < axes.y.range.lower) return Place::below;
  return point.y > axes.y.range.upper ? Place::above : Place::inside;
}

}  // namespace liebench
