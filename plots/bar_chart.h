#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace liebench {

/// A bar to the right of a name, its note written behind its end.
struct Bar {
  std::string label;
  double value = 0;
  std::string note = {};
};

/// Horizontal bars, the first on top, over an axis from zero.
struct BarChart {
  std::string title;
  std::string axis;
  std::vector<Bar> bars;
};

/// Where the bars lie in a picture of `width` pixels: between the pixels `left` and `right`, which stand for `from` and `to`.
struct BarLayout {
  double width, left, right, from, to;
  double pixel(double value) const { return left + (value - from) * (right - left) / (to - from); }
};

/// So that zero is in it and the note of each bar ends before `right`.
BarLayout layout(const BarChart& chart);

/// Draws into one file each, whose endings (.svg, .pdf, .png) choose the format; as draw() of a figure in all else.
void draw(const BarChart& chart, const std::filesystem::path& output);

}  // namespace liebench
