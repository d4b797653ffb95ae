#include "plots/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "plots/figure.h"

namespace liebench {
namespace {

/// Where a line may end: at spaces outside of braces, which enhanced text does not carry over to a new line.
std::vector<std::size_t> line_ends(std::string_view text) {
  std::vector<std::size_t> result;
  int depth = 0;
  for (std::size_t index = 0; index < text.size(); ++index) {
    const char letter = text[index];
    if (letter == '\\') {
      ++index;
    } else if (letter == '{') {
      ++depth;
    } else if (letter == '}') {
      --depth;
    } else if (letter == ' ' && depth == 0) {
      result.push_back(index);
    }
  }
  return result;
}

}  // namespace

std::string gnuplot_literal(std::string_view text) {
  // Single quotes: gnuplot runs no backquoted commands and no escapes in them. One of them is written as two, but of more in a row
  // gnuplot 5.4 loses count: those stand in a string of their own, in double quotes.
  std::string result = "'";
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\'') {
      result += static_cast<unsigned char>(text[i]) < 0x20 ? ' ' : text[i];
      continue;
    }
    const std::size_t end = std::min(text.find_first_not_of('\'', i), text.size());
    if (end - i == 1)
      result += "''";
    else
      result += fmt::format("'.\"{}\".'", text.substr(i, end - i));
    i = end - 1;
  }
  return result + "'";
}

double text_width(std::string_view text) {
  const auto letters = std::ranges::count_if(text, [](char letter) {
    return (static_cast<unsigned char>(letter) & 0xC0U) != 0x80U && letter != '{' && letter != '}' &&
           letter != '_' && letter != '^' && letter != '\\';
  });
  return 0.56 * font_size * static_cast<double>(letters);
}

FittedText fit(std::string_view text, double width) {
  FittedText result{{std::string(text)}};
  double widest = text_width(text);
  if (widest <= width) return result;

  // Two lines that fit are as good as shorter ones; of those, one that ends in a comma reads best.
  std::tuple best{widest, true, widest};
  for (const std::size_t end : line_ends(text)) {
    const std::string_view first = text.substr(0, end);
    const std::string_view second = text.substr(end + 1);
    const double longer = std::max(text_width(first), text_width(second));
    const std::tuple rank{std::max(longer, width), !first.ends_with(','), longer};
    if (rank >= best) continue;
    best = rank;
    widest = longer;
    result.lines = {std::string(first), std::string(second)};
  }
  if (widest > width) result.size = std::floor(10 * font_size * width / widest) / 10;
  return result;
}

std::string plain_text(std::string_view text) {
  std::string result;
  for (const char letter : text) {
    if (std::string_view("\\{}^_@&~").find(letter) != std::string_view::npos) result += '\\';
    result += letter;
  }
  return result;
}

}  // namespace liebench
