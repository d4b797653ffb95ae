#pragma once

#include <string>
#include <vector>

#include "plots/figure.h"
#include "plots/scale.h"
#include "plots/text.h"

namespace liebench {

/// Of the text beside a triangle.
constexpr double order_font_size = font_size - 1;

/// Corners in data coordinates: `start` and `end` on the slope, `corner` at the right angle.
struct SlopeTriangle {
  int order = 0;
  Point start;
  Point end;
  Point corner;
  /// Centre of the text.
  Point text_at;
  std::string text = {};
  /// Of its series, where only one has this slope; else grey.
  std::string colour = {};
};

/// One triangle for each of the panel's orders, except where no place is free: covering data would be worse.
std::vector<SlopeTriangle> place_orders(const Panel& panel, Range x, Range y, PlotArea area);

}  // namespace liebench
