#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace liebench {

/// A bar to the right of a name, its value written at its end.
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

/// Draws into one file each, whose endings (.svg, .pdf, .png) choose the format; as draw() of a figure in all else.
void draw(const BarChart& chart, const std::filesystem::path& output);

}  // namespace liebench
