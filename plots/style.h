#pragma once

#include <string_view>

#include "plots/figure.h"

namespace liebench {

/// How a curve is drawn, and its sample in the legend.
struct Look {
  std::string_view colour;
  /// Of gnuplot's `dt`; empty: marks alone, no line.
  std::string_view dashes;
  double line_width;
  int mark;
  double mark_size;
};

std::string_view colour_of(const Series& series);
Look look_of(const Series& series);

// Of the marks at the edges, see Series.
Look failure_look(std::string_view colour, bool secondary);
Look below_look(std::string_view colour);
Look above_look(std::string_view colour);

}  // namespace liebench
