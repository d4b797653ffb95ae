#include "plots/heat_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "plots/drawing.h"
#include "plots/gnuplot_script.h"
#include "plots/text.h"

namespace liebench {
namespace {

// All in points. Between the cells is white paper: neighbours of one colour stay apart.
constexpr double cell_across = 24, cell_up = 20, cell_space = 2;
constexpr double column_group_space = 11, row_group_space = 7;
constexpr double map_border = 16, map_title = 36, label_space = 7;
constexpr double header_line = 14, header_space = 9;
constexpr double key_space = 6, key_apart = 22, key_row = cell_up + 6, legend_space = 18;
constexpr std::string_view empty_colour = "#f1f1f1";

/// text_width() is that of enhanced text, whose marks take no room; here they are letters.
double plain_width(std::string_view text) {
  std::string letters(text);
  for (char& letter : letters)
    if (std::string_view("{}_^\\").find(letter) != std::string_view::npos) letter = 'x';
  return text_width(letters);
}

bool is_colour(std::string_view text) {
  return text.size() == 7 && text[0] == '#' &&
         text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string_view::npos;
}

/// Black or white, whichever has more contrast (WCAG 2.1, relative luminance) on `colour`.
std::string_view ink_on(const std::string& colour) {
  constexpr std::array weights{0.2126, 0.7152, 0.0722};
  double luminance = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double part = double(std::strtol(colour.substr(1 + 2 * i, 2).c_str(), nullptr, 16)) / 255;
    luminance += weights[i] * (part <= 0.04045 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4));
  }
  return (luminance + 0.05) * (luminance + 0.05) > 1.05 * 0.05 ? "#000000" : "#ffffff";
}

void check_map(const HeatMap& map) {
  const auto refuse = [&](const std::string& reason) {
    throw std::invalid_argument(fmt::format("heat map '{}': {}", map.title, reason));
  };
  if (map.rows.empty() || map.columns.empty()) refuse("it has no cell");
  if (map.cells.size() != map.rows.size())
    refuse(fmt::format("cells of {} rows, labels of {}", map.cells.size(), map.rows.size()));
  if (!map.row_groups.empty() && map.row_groups.size() != map.rows.size())
    refuse(fmt::format("groups of {} rows, labels of {}", map.row_groups.size(), map.rows.size()));
  for (const HeatMap::Kind& kind : map.kinds)
    if (!is_colour(kind.colour)) refuse(fmt::format("kind '{}': no colour: '{}'", kind.name, kind.colour));
  for (std::size_t row = 0; row < map.rows.size(); ++row) {
    if (map.cells[row].size() != map.columns.size()) {
      refuse(fmt::format("row '{}' has {} cells, there are {} columns", map.rows[row], map.cells[row].size(),
                         map.columns.size()));
    }
    for (const int kind : map.cells[row])
      if (kind < -1 || kind >= static_cast<int>(map.kinds.size()))
        refuse(fmt::format("row '{}': there is no kind {}", map.rows[row], kind));
  }
}

const std::string& key_text(const HeatMap& map, int kind) {
  return kind < 0 ? map.empty_name : map.kinds[static_cast<std::size_t>(kind)].name;
}

/// Left to right in lines no wider than `width`, each in its middle; from the height 0 downwards. Returns its height.
double place_keys(const HeatMap& map, std::vector<HeatMapLayout::Key>& keys, double left, double width) {
  double y = 0;
  for (std::size_t first = 0; first < keys.size();) {
    std::size_t last = first;
    double line = 0;
    for (; last < keys.size(); ++last) {
      const double own = cell_across + key_space + plain_width(key_text(map, keys[last].kind));
      const double with_it = line + (last == first ? 0 : key_apart) + own;
      if (last > first && with_it > width) break;
      line = with_it;
    }
    double x = left + (width - line) / 2;
    for (; first < last; ++first) {
      HeatMapLayout::Key& key = keys[first];
      key.sample = {x, y - cell_up, cell_across, cell_up};
      key.text = {x + cell_across + key_space, y - cell_up, plain_width(key_text(map, key.kind)), cell_up};
      x = key.text.left + key.text.width + key_apart;
    }
    y -= key_row;
  }
  return -y;
}

std::string rectangle_command(const Rectangle& place, std::string_view colour) {
  return fmt::format(
      "set object rectangle from {:.2f},{:.2f} to {:.2f},{:.2f} fillstyle solid noborder fillcolor '{}'\n",
      place.left, place.lower, place.left + place.width, place.lower + place.height, colour);
}

std::string text_command(std::string_view text, double x, double y, std::string_view how) {
  return fmt::format("set label {} at {:.2f},{:.2f} {} front\n", gnuplot_literal(plain_text(text)), x, y,
                     how);
}

std::string verdict_commands(const HeatMap& map, int kind, const Rectangle& place) {
  if (kind < 0) return rectangle_command(place, empty_colour);
  const HeatMap::Kind& look = map.kinds[static_cast<std::size_t>(kind)];
  std::string result = rectangle_command(place, look.colour);
  if (!look.glyph.empty()) {
    result +=
        text_command(look.glyph, place.left + place.width / 2, place.lower + place.height / 2,
                     fmt::format("center font ',{}' textcolor rgb '{}'", font_size + 1, ink_on(look.colour)));
  }
  return result;
}

std::string map_commands(const HeatMap& map, const HeatMapLayout& at) {
  // The picture is the plot area: positions are points.
  std::string script = fmt::format(
      "unset key\nunset border\nunset tics\nset lmargin at screen 0\nset rmargin at screen 1\n"
      "set bmargin at screen 0\nset tmargin at screen 1\nset xrange [0:{:.2f}]\nset yrange [0:{:.2f}]\n",
      at.width, at.height);
  script += text_command(map.title, at.title.left + at.title.width / 2, at.title.lower + at.title.height / 2,
                         fmt::format("center font ',{}'", font_size + 1));
  for (const double x : at.separators) {
    script +=
        fmt::format("set arrow from {0:.2f},{1:.2f} to {0:.2f},{2:.2f} nohead lw 0.8 lc rgb '#a0a0a0'\n", x,
                    at.separator.lower, at.separator.upper);
  }
  for (const HeatMapLayout::Header& header : at.headers) {
    const double middle = header.place.left + header.place.width / 2;
    for (std::size_t i = 0; i < header.lines.size(); ++i) {
      const double above = double(header.lines.size() - i) - 0.5;
      script += text_command(header.lines[i], middle, header.place.lower + above * header_line, "center");
    }
  }
  for (std::size_t i = 0; i < map.columns.size(); ++i) {
    const Rectangle& place = at.column_labels[i];
    script +=
        text_command(map.columns[i].label, place.left + place.width / 2, place.lower, "rotate by 90 left");
  }
  for (std::size_t row = 0; row < map.rows.size(); ++row) {
    const Rectangle& place = at.row_labels[row];
    script += text_command(map.rows[row], place.left + place.width, place.lower + place.height / 2, "right");
    for (std::size_t column = 0; column < map.columns.size(); ++column)
      script += verdict_commands(map, map.cells[row][column], at.cells[row][column]);
  }
  for (const HeatMapLayout::Key& key : at.keys) {
    script += verdict_commands(map, key.kind, key.sample);
    script +=
        text_command(key_text(map, key.kind), key.text.left, key.text.lower + key.text.height / 2, "left");
  }
  return script + "plot -1 notitle\n";
}

}  // namespace

HeatMapLayout layout(const HeatMap& map) {
  check_map(map);
  HeatMapLayout at;
  const std::vector<HeatMap::Column>& columns = map.columns;
  constexpr double across = cell_across + cell_space, up = cell_up + cell_space;

  // From left to right.
  double row_label_width = 0;
  for (const std::string& row : map.rows) row_label_width = std::max(row_label_width, plain_width(row));
  std::vector<double> lefts;
  // Whole points: viewers snap the cells of an SVG to pixels, and the spaces between them shall stay equal.
  double x = std::ceil(map_border + row_label_width + label_space);
  std::size_t header_lines = 0;
  for (std::size_t first = 0, last = 0; first < columns.size(); first = last) {
    while (last < columns.size() && columns[last].group == columns[first].group) ++last;
    if (first > 0) {
      at.separators.push_back(x + (column_group_space - cell_space) / 2);
      x += column_group_space;
    }
    const double own = double(last - first) * across;
    double span = own;
    if (const std::string& group = columns[first].group; !group.empty()) {
      // A long header makes its group wider rather than its letters smaller.
      std::vector<std::string> lines = fit(group, own).lines;
      for (const std::string& line : lines) span = std::max(span, plain_width(line));
      span = std::ceil(span);
      lines = fit(group, span).lines;
      header_lines = std::max(header_lines, lines.size());
      at.headers.push_back({std::move(lines), first, last, {x, 0, span - cell_space, 0}});
    }
    for (std::size_t i = first; i < last; ++i)
      lefts.push_back(x + std::floor((span - own) / 2) + double(i - first) * across);
    x += span;
  }
  x -= cell_space;

  bool empty_cells = false;
  for (const std::vector<int>& row : map.cells) empty_cells |= std::ranges::find(row, -1) != row.end();
  for (int kind = 0; kind < static_cast<int>(map.kinds.size()); ++kind) at.keys.push_back({kind});
  if (empty_cells && !map.empty_name.empty()) at.keys.push_back({-1});

  const double title_width = plain_width(map.title) * (font_size + 1) / font_size;
  double content = std::max(x - map_border, title_width);
  for (const HeatMapLayout::Key& key : at.keys)
    content = std::max(content, cell_across + key_space + plain_width(key_text(map, key.kind)));
  at.width = std::ceil(content + 2 * map_border);
  const double shift = std::floor((at.width - map_border - x) / 2);
  for (double& left : lefts) left += shift;
  for (double& separator : at.separators) separator += shift;
  for (HeatMapLayout::Header& header : at.headers) header.place.left += shift;

  // From the bottom to the top.
  const double legend = place_keys(map, at.keys, map_border, at.width - 2 * map_border);
  double y = map_border - (key_row - cell_up);
  for (HeatMapLayout::Key& key : at.keys) {
    key.sample.lower += y + legend;
    key.text.lower += y + legend;
  }
  y += legend + legend_space;
  at.separator.lower = y;
  at.cells.resize(map.rows.size());
  at.row_labels.resize(map.rows.size());
  for (std::size_t row = map.rows.size(); row-- > 0;) {
    const double width = plain_width(map.rows[row]);
    at.row_labels[row] = {lefts.front() - label_space - width, y, width, cell_up};
    for (const double left : lefts) at.cells[row].push_back({left, y, cell_across, cell_up});
    y += up;
    if (row > 0 && !map.row_groups.empty() && map.row_groups[row] != map.row_groups[row - 1])
      y += row_group_space;
  }
  y += label_space - cell_space;
  double column_label_height = 0;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const double height = plain_width(columns[i].label);
    at.column_labels.push_back({lefts[i] + (cell_across - font_size) / 2, y, font_size, height});
    column_label_height = std::max(column_label_height, std::ceil(height));
  }
  y += column_label_height;
  if (!at.headers.empty()) {
    y += header_space;
    for (HeatMapLayout::Header& header : at.headers) {
      header.place.lower = y;
      header.place.height = double(header.lines.size()) * header_line;
    }
    y += double(header_lines) * header_line;
  }
  at.separator.upper = y;
  at.title = {(at.width - title_width) / 2, y, title_width, map.title.empty() ? 0.0 : map_title};
  at.height = std::ceil(y + (map.title.empty() ? map_border : map_title));
  return at;
}

void draw(const HeatMap& map, std::span<const std::filesystem::path> outputs) {
  const HeatMapLayout at = layout(map);
  for (const std::filesystem::path& output : outputs) terminal_commands(output, at.width, at.height);
  draw_files(outputs, [&](std::span<const std::filesystem::path> temporaries) {
    const std::string picture = map_commands(map, at);
    std::string script = "set encoding utf8\nset samples 2\n";
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      script += terminal_commands(outputs[i], at.width, at.height);
      script += fmt::format("set output {}\n", gnuplot_literal(temporaries[i].string()));
      script += picture + "unset output\nreset\n";
    }
    return script;
  });
}

}  // namespace liebench
