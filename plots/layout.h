#pragma once

#include <vector>

#include "plots/axes.h"
#include "plots/figure.h"
#include "plots/legend.h"
#include "plots/text.h"

namespace liebench {

/// A part of the figure, in points from its lower left corner.
struct Rectangle {
  double left = 0;
  double lower = 0;
  double width = 0;
  double height = 0;
};

struct PanelLayout {
  Axes axes;
  /// The plot area.
  Rectangle plot = {};
  FittedText y_label = {};
  Legend legend = {};
  Rectangle legend_place = {};
};

/// Where everything stands.
struct Layout {
  double width = 0;
  double height = 0;
  std::vector<PanelLayout> panels;
  Legend legend = {};
  Rectangle legend_place = {};
};

/// Throws std::invalid_argument if the figure does not fit itself.
Layout lay_out(const Figure& figure);

}  // namespace liebench
