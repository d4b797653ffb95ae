#pragma once

#include "plots/figure.h"

namespace liebench {

/// Whether an axis can show `value` at all.
bool on_axis(double value, bool logarithmic);

/// The coordinate in which an axis is linear, and back.
double to_axis(double value, bool logarithmic);
double from_axis(double value, bool logarithmic);

/// An axis: data to points (1/72 inch) from its lower end, and back.
struct Scale {
  Range range;
  bool logarithmic;
  double length;

  double position(double value) const;
  double value(double position) const;
  double points_per_unit() const;
};

/// The axes of a panel.
struct Axes {
  Scale x;
  Scale y;
};

/// The size of a panel's plot area, in points (1/72 inch).
struct PlotArea {
  double width = 0;
  double height = 0;
};

}  // namespace liebench
