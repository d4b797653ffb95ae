#include "plots/style.h"

#include <array>

namespace liebench {
namespace {

struct Style {
  std::string_view colour;
  int filled_mark;
  int open_mark;
};

// Okabe and Ito's colours without the yellow, which white paper swallows. The first three lie far apart in
// luminance too (L* = 0, 46, 71), so that a figure of three curves survives a grey printer; the others fill
// the gaps.
constexpr std::array<Style, style_count> styles{{
    {"#000000", 7, 6},    // black, circle
    {"#0072B2", 5, 4},    // blue, square
    {"#E69F00", 9, 8},    // orange, triangle
    {"#D55E00", 13, 12},  // vermillion, diamond
    {"#009E73", 11, 10},  // green, triangle downwards
    {"#56B4E9", 15, 14},  // sky blue, pentagon
    {"#CC79A7", 5, 4},    // purple, square
}};

const Style& style_at(int number) {
  const int index = number % style_count;
  return styles[static_cast<std::size_t>(index < 0 ? index + style_count : index)];
}

const Style& style_of(const Series& series) {
  return style_at(series.style);
}

}  // namespace

std::string_view colour_of(const Series& series) {
  return style_of(series).colour;
}

// A second variant's marks are the larger ones: a ring around the filled mark where both agree.
Look look_of(const Series& series) {
  const Style& style = style_of(series);
  const Style& marks = series.mark < 0 ? style : style_at(series.mark);
  if (series.secondary) return {style.colour, "(12,7)", 0.8, marks.open_mark, series.broad ? 1.1 : 0.68};
  if (series.broad) return {style.colour, "1", 3.2, marks.filled_mark, 0.55};
  return {style.colour, "1", 1.4, marks.filled_mark, 0.34};
}

Look failure_look(std::string_view colour, bool secondary) {
  return {colour, "", secondary ? 1.0 : 1.8, 2, 0.6};
}

Look below_look(std::string_view colour) {
  return {colour, "", 1.0, 10, 0.7};
}

Look above_look(std::string_view colour) {
  return {colour, "", 1.0, 8, 0.7};
}

}  // namespace liebench
