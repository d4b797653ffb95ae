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
  std::vector<double> places;
  const Positions position = x.positions();
  for (std::size_t index = 0; index < panel.series.size(); ++index) {
    for (const double value : failures_of(panel.series[index])) {
      if (!on_axis(value, panel.log_x)) continue;
      const double place = position(value);
      int level = 0;
      for (std::size_t i = 0; i < places.size() && level < failure_levels - 1; ++i) {
        if (std::abs(places[i] - place) < failure_step) ++level;
      }
      result.push_back({index, value, level});
      places.push_back(place);
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
