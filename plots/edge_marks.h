#pragma once

#include <cstddef>
#include <vector>

#include "plots/figure.h"
#include "plots/scale.h"

namespace liebench {

/// What an axis cannot show is marked inside the plot area, this far (in points) from the edge.
constexpr double edge_distance = 6;

/// The x of all runs of a series that failed.
std::vector<double> failures_of(const Series& series);

/// Crosses of runs that failed at (nearly) the same x hang below each other.
struct FailureMark {
  std::size_t series;
  double x;
  int level;

  /// From the lower edge of a plot area of this height.
  double position(double height) const;
};

std::vector<FailureMark> failure_marks(const Panel& panel, const Scale& x);

/// The room that `levels` levels of crosses take at the upper edge.
double failure_room(int levels);

enum class Place { inside, below, above, nowhere };

/// Where a point of a curve is to be drawn; nowhere: it failed, or x is not on its axis.
Place place_of(const Point& point, const Axes& axes);

}  // namespace liebench
