#include "plots/region_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string_view>

#include "plots/contour.h"
#include "plots/drawing.h"
#include "plots/gnuplot_script.h"

namespace liebench {
namespace {

// All in points.
constexpr double region_across = 204, region_up = 240;
constexpr double region_left = 40, region_right = 14, region_bottom = 32, region_title_line = 14;
constexpr double region_label = 18, map_edge = 12, map_heading = 30;
constexpr double sample_across = 24, sample_up = 13, sample_space = 6, samples_apart = 24, samples_row = 30;
constexpr double least_tick_space = 34;
// A line that strays no further than this is the same line.
constexpr double line_accuracy = 0.05;

constexpr std::string_view stable_colour = "#bcd9ef", unstable_colour = "#ffffff", nothing_colour = "#dddddd";
constexpr std::string_view region_line = "#0b3c5d";

Field field_of(const RegionMap::Region& region) {
  return {{region.x_from, region.x_to}, {region.y_from, region.y_to}, region.nx, region.ny, region.growth};
}

void check_regions(const RegionMap& map) {
  const auto refuse = [&](const std::string& reason) {
    throw std::invalid_argument(fmt::format("map of regions '{}': {}", map.title, reason));
  };
  if (map.regions.empty()) refuse("it has no region");
  if (map.columns < 1) refuse(fmt::format("{} columns", map.columns));
  if (!std::isfinite(map.tolerance)) refuse("its tolerance is no number");
  for (const RegionMap::Region& region : map.regions) {
    try {
      check(field_of(region));
    } catch (const std::invalid_argument& error) {
      refuse(fmt::format("region '{}': {}", region.title, error.what()));
    }
  }
}

/// The least of 1, 2, 5, 10, ... times a power of ten that is not less.
double round_step(double least) {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= least) return factor * power;
  return 10 * power;
}

double points_per_unit(const RegionMap::Region& region) {
  return std::min(region_across / (region.x_to - region.x_from), region_up / (region.y_to - region.y_from));
}

/// From the piece between `from` and `to`, not from the line through them: where an outline turns back its tip stays.
double distance_from_chord(const Point& point, const Point& from, const Point& to) {
  const double x = to.x - from.x, y = to.y - from.y, squared = x * x + y * y;
  const double along = squared > 0 ? ((point.x - from.x) * x + (point.y - from.y) * y) / squared : 0;
  const double part = std::clamp(along, 0.0, 1.0);
  return std::hypot(point.x - from.x - part * x, point.y - from.y - part * y);
}

/// Without the points that lie within `accuracy` of the line through those that stay.
Outline thinned(const Outline& outline, double accuracy) {
  Outline result;
  const std::size_t count = outline.points.size();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t after = (i + 1) % count, before = (i + count - 1) % count;
    bool needed = i == 0 || outline.crossing[i] != outline.crossing[before] ||
                  outline.crossing[i] != outline.crossing[after];
    for (std::size_t dropped = kept + 1; dropped <= i && !needed; ++dropped) {
      needed = distance_from_chord(outline.points[dropped], outline.points[kept], outline.points[after]) >
               accuracy;
    }
    if (!needed) continue;
    kept = i;
    result.points.push_back(outline.points[i]);
    result.crossing.push_back(outline.crossing[i]);
  }
  return result;
}

/// What is plotted in a panel, from the bottom to the top.
struct RegionData {
  std::string datablocks = {};
  std::vector<std::string> plots = {};

  void add(std::size_t panel, const std::string& lines, const std::string& how) {
    if (lines.empty()) return;
    const std::string name = fmt::format("$region{}_{}", panel, plots.size() + 1);
    datablocks += name + " << EOD\n" + lines + "EOD\n";
    plots.push_back(fmt::format("{} using 1:2 {} notitle", name, how));
  }
};

void add_point(std::string& lines, const Point& point) {
  fmt::format_to(std::back_inserter(lines), "{:.9g} {:.9g}\n", point.x, point.y);
}

/// Squares that have a corner without a value, those beside each other as one.
std::string nothing_lines(const RegionMap::Region& region) {
  std::string lines;
  const auto x_at = [&](int i) {
    return region.x_from + (region.x_to - region.x_from) * std::clamp(i, 0, region.nx - 1) / (region.nx - 1);
  };
  const auto y_at = [&](int j) {
    return region.y_from + (region.y_to - region.y_from) * std::clamp(j, 0, region.ny - 1) / (region.ny - 1);
  };
  for (int j = 0; j < region.ny; ++j) {
    const auto row = region.growth.begin() + std::ptrdiff_t{j} * region.nx;
    const auto nothing = [&](int i) { return std::isnan(row[i]); };
    for (int first = 0, last = 0; first < region.nx; first = last + 1) {
      for (last = first; last < region.nx && nothing(last);) ++last;
      if (last == first) continue;
      for (const auto& [i, k] :
           {std::pair(first - 1, j - 1), {last, j - 1}, {last, j + 1}, {first - 1, j + 1}})
        add_point(lines, {x_at(i), y_at(k)});
      lines += '\n';
    }
  }
  return lines;
}

RegionData region_data(const RegionMap::Region& region, double tolerance, std::size_t number) {
  RegionData data;
  std::vector<Outline> lines = outlines(field_of(region), tolerance);
  for (Outline& line : lines) line = thinned(line, line_accuracy / points_per_unit(region));
  // Lines do not cross: what lies within another is smaller, and is painted over it.
  std::ranges::stable_sort(
      lines, [](double a, double b) { return std::abs(a) > std::abs(b); }, &Outline::signed_area);
  for (std::size_t first = 0, last = 0; first < lines.size(); first = last) {
    const bool area = lines[first].signed_area() > 0;
    std::string painted;
    for (; last < lines.size() && (lines[last].signed_area() > 0) == area; ++last) {
      for (const Point& point : lines[last].points) add_point(painted, point);
      painted += '\n';
    }
    data.add(number, painted,
             fmt::format("with filledcurves closed fillstyle solid noborder fillcolor rgb '{}'",
                         area ? stable_colour : unstable_colour));
  }
  data.add(
      number, nothing_lines(region),
      fmt::format("with filledcurves closed fillstyle solid noborder fillcolor rgb '{}'", nothing_colour));

  std::string axes;
  if (region.x_from < 0 && region.x_to > 0) axes += fmt::format("0 {}\n0 {}\n\n", region.y_from, region.y_to);
  if (region.y_from < 0 && region.y_to > 0) axes += fmt::format("{} 0\n{} 0\n", region.x_from, region.x_to);
  data.add(number, axes, "with lines lc rgb '#808080' lw 0.6 dt 1");

  std::string boundary;
  for (const Outline& line : lines) {
    bool drawn = false;
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      const std::size_t after = (i + 1) % line.points.size();
      if (!line.crossing[i] || !line.crossing[after]) {
        drawn = false;
        continue;
      }
      if (!drawn) {
        boundary += '\n';
        add_point(boundary, line.points[i]);
      }
      add_point(boundary, line.points[after]);
      drawn = true;
    }
  }
  data.add(number, boundary, fmt::format("with lines lc rgb '{}' lw 1.5 dt 1", region_line));
  return data;
}

std::string sample_commands(const RegionMapLayout& at) {
  std::string script;
  for (const RegionMapLayout::Key& key : at.keys) {
    const Rectangle& sample = key.sample;
    script += fmt::format(
        "set object rectangle from screen {:.5f},{:.5f} to screen {:.5f},{:.5f} fillstyle solid border lc "
        "rgb "
        "'{}' fillcolor '{}' lw 1\nset label {} at screen {:.5f},{:.5f} left\n",
        sample.left / at.width, sample.lower / at.height, (sample.left + sample.width) / at.width,
        (sample.lower + sample.height) / at.height, region_line, key.colour, gnuplot_literal(key.name),
        key.text.left / at.width, (key.text.lower + key.text.height / 2) / at.height);
  }
  return script;
}

std::string region_commands(const RegionMap& map, const RegionMapLayout& at, std::size_t index,
                            const RegionData& data) {
  const RegionMap::Region& region = map.regions[index];
  const RegionMapLayout::Panel& panel = at.panels[index];
  std::string script = fmt::format(
      "set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\nset bmargin at screen {:.5f}\nset tmargin "
      "at "
      "screen {:.5f}\n",
      panel.plot.left / at.width, (panel.plot.left + panel.plot.width) / at.width,
      panel.plot.lower / at.height, (panel.plot.lower + panel.plot.height) / at.height);
  script += fmt::format("set xrange [{}:{}]\nset yrange [{}:{}]\nset xtics {}\nset ytics {}\n", region.x_from,
                        region.x_to, region.y_from, region.y_to, panel.tick_step, panel.tick_step);
  script += fmt::format("set xlabel {} offset 0,0.2\nset ylabel {} offset 0.8,0\n",
                        gnuplot_literal(panel.x_labelled ? map.x_label : ""),
                        gnuplot_literal(panel.y_labelled ? map.y_label : ""));
  const std::vector<std::string>& lines = panel.title_text.lines;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    script +=
        fmt::format("set label {} at screen {:.5f},{:.5f} center font ',{}'\n", gnuplot_literal(lines[i]),
                    (panel.title.left + panel.title.width / 2) / at.width,
                    (panel.title.lower + (double(lines.size() - i) - 0.5) * region_title_line) / at.height,
                    panel.title_text.size);
  }
  script += "plot ";
  for (const std::string& plot : data.plots) script += plot + ", \\\n  ";
  // The last one is never seen; it keeps a panel in which nothing is stable a panel.
  return script + "1/0 notitle\nunset label\nunset object\n";
}

}  // namespace

RegionMapLayout layout(const RegionMap& map) {
  check_regions(map);
  RegionMapLayout at;
  const auto columns = std::min(static_cast<std::size_t>(map.columns), map.regions.size());
  const std::size_t rows = (map.regions.size() + columns - 1) / columns;

  double across = 0;
  bool nothing = false;
  for (const RegionMap::Region& region : map.regions) {
    const double scale = points_per_unit(region);
    RegionMapLayout::Panel& panel = at.panels.emplace_back();
    panel.plot.width = scale * (region.x_to - region.x_from);
    panel.plot.height = scale * (region.y_to - region.y_from);
    panel.tick_step = round_step(least_tick_space / scale);
    across = std::max(across, panel.plot.width);
    nothing |= std::ranges::any_of(region.growth, [](double growth) { return std::isnan(growth); });
  }
  const double cell = region_left + across + region_right;
  for (std::size_t i = 0; i < map.regions.size(); ++i)
    at.panels[i].title_text = fit(map.regions[i].title, cell - 8);

  at.keys = {{map.stable_name, std::string(stable_colour)},
             {map.unstable_name, std::string(unstable_colour)}};
  if (nothing) at.keys.push_back({map.nothing_name, std::string(nothing_colour)});
  double key_line = -samples_apart;
  for (const RegionMapLayout::Key& key : at.keys)
    key_line += samples_apart + sample_across + sample_space + text_width(key.name);

  const double side = map.y_label.empty() ? 0 : region_label;
  const double panels = double(columns) * cell + side;
  const double title_width = text_width(map.title) * (font_size + 1) / font_size;
  at.width = std::ceil(std::max({panels, title_width, key_line}) + 2 * map_edge);

  const double left = (at.width - panels) / 2 + side;
  double y = 0;  // downwards from the top
  if (map.title.empty()) {
    y = map_edge;
  } else {
    at.title = {(at.width - title_width) / 2, y, title_width, map_heading};
    y += map_heading;
  }
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t first = row * columns, last = std::min(first + columns, map.regions.size());
    double titles = 0, up = 0;
    for (std::size_t i = first; i < last; ++i) {
      if (!map.regions[i].title.empty())
        titles = std::max(titles, double(at.panels[i].title_text.lines.size()) * region_title_line);
      up = std::max(up, at.panels[i].plot.height);
    }
    y += titles + 6;
    bool x_labelled = false;
    for (std::size_t i = first; i < last; ++i) {
      RegionMapLayout::Panel& panel = at.panels[i];
      const double start = left + double(i - first) * cell;
      panel.plot.left = start + region_left + (across - panel.plot.width) / 2;
      panel.plot.lower = y + panel.plot.height;
      panel.x_labelled = !map.x_label.empty() && i + columns >= map.regions.size();
      panel.y_labelled = !map.y_label.empty() && i == first;
      x_labelled |= panel.x_labelled;
      double width = 0;
      for (const std::string& line : panel.title_text.lines)
        width = std::max(width, text_width(line) * panel.title_text.size / font_size);
      const double height = double(panel.title_text.lines.size()) * region_title_line;
      // Above the middle of its plot area, as far as the cell reaches.
      const double middle = std::clamp(panel.plot.left + panel.plot.width / 2, start + width / 2,
                                       std::max(start + width / 2, start + cell - width / 2));
      panel.title = {middle - width / 2, y - 5, width, height};
    }
    y += up + region_bottom + (x_labelled ? region_label : 0);
  }
  double x = (at.width - key_line) / 2;
  for (RegionMapLayout::Key& key : at.keys) {
    const double lower = y + (samples_row + sample_up) / 2;
    key.sample = {x, lower, sample_across, sample_up};
    key.text = {x + sample_across + sample_space, lower, text_width(key.name), sample_up};
    x = key.text.left + key.text.width + samples_apart;
  }
  y += samples_row + 4;

  at.height = std::ceil(y);
  at.title.lower = at.height - map_heading;
  for (RegionMapLayout::Panel& panel : at.panels) {
    panel.plot.lower = at.height - panel.plot.lower;
    panel.title.lower = at.height - panel.title.lower;
  }
  for (RegionMapLayout::Key& key : at.keys) {
    key.sample.lower = at.height - key.sample.lower;
    key.text.lower = at.height - key.text.lower;
  }
  return at;
}

void draw(const RegionMap& map, std::span<const std::filesystem::path> outputs) {
  const RegionMapLayout at = layout(map);
  for (const std::filesystem::path& output : outputs) terminal_commands(output, at.width, at.height);
  draw_files(outputs, [&](std::span<const std::filesystem::path> temporaries) {
    std::string script = "set encoding utf8\nset samples 2\n";
    std::string picture =
        "set multiplot\nunset key\nset border 31 front lw 0.7 lc rgb '#000000'\nset tics nomirror out scale "
        "0.5\n"
        "set format '%g'\n";
    // Labels and samples belong to the whole picture: they come with the first panel.
    picture +=
        fmt::format("set label {} at screen 0.5,{:.5f} center font ',{}'\n", gnuplot_literal(map.title),
                    (at.title.lower + at.title.height / 2) / at.height, font_size + 1);
    picture += sample_commands(at);
    for (std::size_t i = 0; i < map.regions.size(); ++i) {
      const RegionData data = region_data(map.regions[i], map.tolerance, i + 1);
      script += data.datablocks;
      picture += region_commands(map, at, i, data);
    }
    picture += "unset multiplot\n";
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      script += terminal_commands(outputs[i], at.width, at.height);
      script += fmt::format("set output {}\n", gnuplot_literal(temporaries[i].string()));
      script += picture + "unset output\nreset\n";
    }
    return script;
  });
}

}  // namespace liebench
