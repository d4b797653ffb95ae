#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "plots/figure.h"
#include "plots/scale.h"

namespace liebench {

/// The tag of a curve beside its last point, in points from the lower left corner of the plot area.
struct CurveTag {
  Point at;
  std::string text;
  std::string_view colour;
};

/// The tags of a panel: beyond the curve's end where the panel has room, else above or below it; those of curves that end
/// near each other stand in a column, none over another.
std::vector<CurveTag> place_tags(const Panel& panel, const Axes& axes);

}  // namespace liebench
