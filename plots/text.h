#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace liebench {

/// In points, of all text but the titles.
constexpr double font_size = 11;

/// `text` as a string of gnuplot's language that runs no commands and has no escapes.
std::string gnuplot_literal(std::string_view text);

/// In points, at font_size. An estimate: gnuplot measures for itself when it sets the text.
double text_width(std::string_view text);

struct FittedText {
  std::vector<std::string> lines = {};
  double size = font_size;
};

/// `text` on one line, or on two where one is longer than `width`; smaller where two are.
FittedText fit(std::string_view text, double width);

}  // namespace liebench
