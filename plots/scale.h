#pragma once

#include "plots/figure.h"

namespace liebench {

/// Whether an axis can show `value` at all.
bool on_axis(double value, bool logarithmic);

/// The coordinate in which an axis is linear, and back.
double to_axis(double value, bool logarithmic);
double from_axis(double value, bool logarithmic);

/// The way from data to points of an axis, for many of them: the logarithms of its ends are taken once.
struct Positions {
  double lower;
  double span;
  bool logarithmic;
  double length;

  double operator()(double value) const;
};

/// An axis: data to points (1/72 inch) from its lower end, and back.
struct Scale {
  Range range;
  bool logarithmic;
  double length;

  Positions positions() const;
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
