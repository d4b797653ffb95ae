#include "plots/gnuplot_script.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "plots/curve_tags.h"
#include "plots/edge_marks.h"
#include "plots/layout.h"
#include "plots/slope_triangles.h"
#include "plots/style.h"
#include "plots/text.h"

namespace liebench {
namespace {

constexpr std::size_t marks_per_line = 24;
// A panel with more points than this is drawn in lines alone: marks would cover each other, and the file would be large.
constexpr std::size_t most_marks = 2000;
// Beyond, curves of one look share a datablock: gnuplot looks for a datablock among all others.
constexpr std::size_t most_datablocks = 200;
// Points of a curve that lie closer than this (1/72 inch) are one.
constexpr double least_distance = 0.3;
constexpr double tag_font_size = 8;

std::string plot_style(const Look& look, std::size_t point_count, bool marked) {
  if (!marked && !look.dashes.empty())
    return fmt::format("with lines lc rgb '{}' lw {} dt {}", look.colour, look.line_width, look.dashes);
  const std::string mark =
      fmt::format("lc rgb '{}' lw {} pt {} ps {}", look.colour, look.line_width, look.mark, look.mark_size);
  if (look.dashes.empty()) return "with points " + mark;
  const std::string interval =
      point_count > 2 * marks_per_line
          ? fmt::format(" pointinterval {}", (point_count + marks_per_line - 1) / marks_per_line)
          : "";
  return fmt::format("with linespoints {} dt {}{}", mark, look.dashes, interval);
}

/// Lines of a datablock.
struct Lines {
  std::string text = {};
  std::size_t count = 0;

  void add(double x, double y) {
    fmt::format_to(std::back_inserter(text), "{} {}\n", x, y);
    ++count;
  }
  /// gnuplot's pen up.
  void lift_pen() {
    text += '\n';
    ++count;
  }
};

/// A curve's points, with an empty line where a failed run lies between two of them.
Lines curve_lines(const Series& series, const Axes& axes) {
  Lines lines;
  const std::vector<double> failures = failures_of(series);
  const Positions across = axes.x.positions(), up = axes.y.positions();
  std::optional<double> previous;
  Point drawn;  // the last one, on the page
  for (const Point& point : series.points) {
    const Place place = place_of(point, axes);
    if (place == Place::nowhere || !on_axis(point.y, axes.y.logarithmic)) continue;
    const bool gap = previous && std::ranges::any_of(failures, [&](double x) {
                       return x > std::min(*previous, point.x) && x < std::max(*previous, point.x);
                     });
    if (gap) lines.lift_pen();
    const double x = across(point.x), y = up(point.y);
    if (!gap && previous && &point != &series.points.back() &&
        std::hypot(x - drawn.x, y - drawn.y) < least_distance)
      continue;
    drawn = {x, y};
    lines.add(point.x, point.y);
    previous = point.x;
  }
  return lines;
}

struct Curve {
  std::string name;
  std::string look;
  Lines lines;
};

/// Writes the datablocks of a panel and returns what is to be plotted, from the bottom to the top.
std::vector<Curve> write_panel_data(std::string& script, const Panel& panel, const Axes& axes,
                                    std::size_t number) {
  std::vector<Curve> beneath;
  std::vector<Curve> above;
  const std::vector<FailureMark> marks = failure_marks(panel, axes.x);
  auto mark = marks.begin();  // in the order of the series
  std::size_t points = 0;
  for (const Series& series : panel.series) points += series.points.size();
  const bool share = panel.series.size() > most_datablocks;
  std::map<std::pair<bool, std::string>, std::size_t> shared;
  for (std::size_t index = 0; index < panel.series.size(); ++index) {
    const Series& series = panel.series[index];
    const std::string_view colour = colour_of(series);
    const auto add = [&](std::string_view kind, Lines lines, const Look& look, bool low) {
      if (lines.count == 0) return;
      std::vector<Curve>& curves = low ? beneath : above;
      const std::string style = plot_style(look, lines.count, points <= most_marks);
      if (share) {
        const auto [place, fresh] = shared.try_emplace(std::pair(low, style), curves.size());
        if (!fresh) {
          Lines& all = curves[place->second].lines;
          all.lift_pen();
          all.text += lines.text;
          return;
        }
      }
      curves.push_back({fmt::format("panel{}_{}{}", number, kind, index + 1), style, std::move(lines)});
    };
    add("curve", curve_lines(series, axes), look_of(series), series.secondary || series.broad);

    for (const bool low : {true, false}) {
      Lines lines;
      for (const Point& point : series.points) {
        if (place_of(point, axes) != (low ? Place::below : Place::above)) continue;
        const double height = low ? edge_distance : axes.y.length - edge_distance;
        lines.add(point.x, axes.y.value(height));
      }
      add(low ? "below" : "above", std::move(lines), low ? below_look(colour) : above_look(colour), false);
    }

    Lines crosses;
    for (; mark != marks.end() && mark->series == index; ++mark)
      crosses.add(mark->x, axes.y.value(mark->position(axes.y.length)));
    add("failed", std::move(crosses), failure_look(colour, series.secondary), false);
  }
  beneath.insert(beneath.end(), std::make_move_iterator(above.begin()), std::make_move_iterator(above.end()));
  for (const Curve& curve : beneath) {
    script += fmt::format("${} << EOD\n", curve.name);
    script += curve.lines.text;
    script += "EOD\n";
  }
  return beneath;
}

std::string axis_commands(char axis, const Scale& scale, double spacing) {
  std::string result = fmt::format("set {}range [{}:{}]\n", axis, scale.range.lower, scale.range.upper);
  if (scale.logarithmic) {
    result += fmt::format("set logscale {0} 10\nset format {0} '10^{{%T}}'\nset {0}tics {1}\n", axis,
                          logarithmic_ticks(scale, spacing));
  } else {
    result += fmt::format("unset logscale {0}\nset format {0} '%g'\nset {0}tics autofreq\n", axis);
  }
  return result;
}

std::string margins(const Layout& layout, const Rectangle& place) {
  return fmt::format(
      "set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\nset bmargin at screen {:.5f}\nset tmargin "
      "at screen {:.5f}\n",
      place.left / layout.width, (place.left + place.width) / layout.width, place.lower / layout.height,
      (place.lower + place.height) / layout.height);
}

/// A plot without axes or data that carries a legend in the middle of its area. Not gnuplot's own key: that
/// one drops entries without a word when it thinks that they do not fit.
std::string legend_commands(const Layout& layout, const Legend& legend, const Rectangle& place) {
  if (legend.entries.empty()) return {};
  std::string result =
      "# legend\nunset logscale\nunset border\nunset tics\nunset grid\nunset xlabel\nunset ylabel\n";
  result += "unset title\n" + margins(layout, place);
  const std::vector<double> widths = legend.column_widths();
  double left = (place.width - legend.width()) / 2;
  for (std::size_t index = 0; index < legend.entries.size(); ++index) {
    const auto& [look, label] = legend.entries[index];
    const std::size_t row = index % legend.rows;
    if (row == 0 && index > 0) left += widths[index / legend.rows - 1];
    const double y = place.height - 4 - legend_row * (static_cast<double>(row) + 0.5);
    if (!look.dashes.empty()) {
      result += fmt::format("set arrow from first {:.2f},{:.2f} rto {},0 nohead lc rgb '{}' lw {} dt {}\n",
                            left, y, legend_sample, look.colour, look.line_width, look.dashes);
    }
    result +=
        fmt::format("set label '' at first {:.2f},{:.2f} point lc rgb '{}' lw {} pt {} ps {}\n",
                    left + legend_sample / 2, y, look.colour, look.line_width, look.mark, look.mark_size);
    result += fmt::format("set label {} at first {:.2f},{:.2f} left\n", gnuplot_literal(label),
                          left + legend_sample + 6, y);
  }
  result += fmt::format("plot [0:{:.2f}] [0:{:.2f}] -1 notitle\n", place.width, place.height);
  return result + "unset arrow\nunset label\n";
}

std::string y_label_command(const FittedText& label) {
  std::vector<std::string> lines;
  for (const std::string& line : label.lines) lines.push_back(gnuplot_literal(line));
  // gnuplot sets a second line closer to the ticks than a single one. Without a size it would keep the last
  // panel's.
  return fmt::format("set ylabel {} offset {},0 font ',{}'\n", fmt::join(lines, ".\"\\n\"."),
                     lines.size() > 1 ? -0.2 : 0.4, label.size);
}

std::string panel_commands(const Layout& layout, const Panel& panel, const PanelLayout& where,
                           std::span<const Curve> curves) {
  const Axes& axes = where.axes;
  std::string result =
      "set border 31 lw 0.7 lc rgb '#000000'\nset grid xtics ytics back lt 1 lw 0.4 lc rgb '#d9d9d9'\n";
  result += "set xtics nomirror in scale 0.6,0.35\nset ytics nomirror in scale 0.6,0.35\n";
  result += margins(layout, where.plot);
  result += axis_commands('x', axes.x, 30) + axis_commands('y', axes.y, 20);
  result += fmt::format("set title {} offset 0,-0.5\nset xlabel {} offset 0,0.3\n",
                        gnuplot_literal(panel.title), gnuplot_literal(panel.x_label));
  result += y_label_command(where.y_label);

  int tag = 0;
  for (const SlopeTriangle& triangle :
       place_orders(panel, axes.x.range, axes.y.range, {axes.x.length, axes.y.length})) {
    ++tag;
    result += fmt::format(
        "set object {} polygon from first {},{} to first {},{} to first {},{} to first {},{} "
        "back fs solid 1.0 border rgb '{}' fc rgb '#ececec' lw 0.7\n",
        tag, triangle.start.x, triangle.start.y, triangle.end.x, triangle.end.y, triangle.corner.x,
        triangle.corner.y, triangle.start.x, triangle.start.y, triangle.colour);
    result +=
        fmt::format("set label {} {} at first {},{} center font ',{}' tc rgb '#303030' back\n", tag,
                    gnuplot_literal(triangle.text), triangle.text_at.x, triangle.text_at.y, order_font_size);
  }
  for (std::size_t i = 0; i < panel.lines.size(); ++i) {
    const VerticalLine& line = panel.lines[i];
    if (!(line.x >= axes.x.range.lower && line.x <= axes.x.range.upper)) continue;
    ++tag;
    const std::string_view colour = colour_of({.style = line.style});
    // The texts stand upright to the left of their lines, one low, the next one high, so that lines may lie close together.
    result += fmt::format(
        "set arrow {0} from first {1}, graph 0 to first {1}, graph 1 nohead front lc rgb '{2}' lw 1 dt 3\n"
        "set label {0} {3} at first {1}, graph {5} rotate by 90 left offset character -0.8,0 tc rgb '{2}' "
        "font ',{4}' front\n",
        tag, line.x, colour, gnuplot_literal(line.text), order_font_size, i % 2 == 0 ? 0.03 : 0.36);
  }
  for (const CurveTag& own : place_tags(panel, axes)) {
    ++tag;
    result += fmt::format("set label {} {} at first {},{} center font ',{}' tc rgb '{}' front boxed\n", tag,
                          gnuplot_literal(own.text), axes.x.value(own.at.x), axes.y.value(own.at.y),
                          tag_font_size, own.colour);
  }
  if (curves.empty()) {
    ++tag;
    result += fmt::format("set label {} 'no data' at graph 0.5,0.5 center tc rgb '#606060'\n", tag);
  }
  result += "plot ";
  for (const Curve& curve : curves)
    result += fmt::format("${} using 1:2 {} notitle, \\\n  ", curve.name, curve.look);
  // The last one is never seen; it keeps a panel without data a panel.
  result += "1/0 notitle\n";
  return result + "unset object\nunset arrow\nunset label\n";
}

}  // namespace

std::string terminal_commands(const std::filesystem::path& output, double width, double height) {
  const std::string ending = output.extension().string();
  // DejaVu comes with gnuplot-nox's own dependencies and has Greek; fontconfig replaces it where it is
  // missing. An SVG is set in the reader's fonts.
  if (ending == ".svg") {
    return fmt::format(
        "set terminal svg enhanced font 'sans-serif,{}' size {:.0f},{:.0f} fixed background '#ffffff'\n",
        font_size, width, height);
  }
  // Both cairo terminals set a font larger than its name says, by 4/3, and draw marks smaller than the SVG's.
  if (ending == ".pdf") {
    return fmt::format(
        "set terminal pdfcairo enhanced color font 'DejaVu Sans,{}' fontscale 0.75 size {:.4f}in,{:.4f}in "
        "linewidth "
        "1.7 pointscale 1.25 background '#ffffff'\n",
        font_size, width / 72, height / 72);
  }
  if (ending == ".png") {
    constexpr double pixels = 2.5;
    return fmt::format(
        "set terminal pngcairo enhanced color font 'DejaVu Sans,{}' fontscale {} size {:.0f},{:.0f} "
        "linewidth {} "
        "pointscale {} background '#ffffff'\n",
        font_size, 0.75 * pixels, pixels * width, pixels * height, pixels, 1.25 * pixels);
  }
  throw std::invalid_argument(
      fmt::format("'{}': a figure's name ends in .svg, .pdf or .png", output.string()));
}

void require_drawable(const Figure& figure, std::span<const std::filesystem::path> outputs) {
  const Layout layout = lay_out(figure);
  for (const std::filesystem::path& output : outputs) terminal_commands(output, layout.width, layout.height);
}

std::string gnuplot_script(const Figure& figure, std::span<const std::filesystem::path> outputs) {
  return gnuplot_script(figure, outputs, outputs);
}

std::string gnuplot_script(const Figure& figure, std::span<const std::filesystem::path> outputs,
                           std::span<const std::filesystem::path> written_to) {
  const Layout layout = lay_out(figure);
  std::string script = "set encoding utf8\nset samples 2\n";
  std::string body =
      "set multiplot\nunset key\nset style textbox opaque margins 0.2,0.2 fillcolor '#ffffff' noborder\n";
  const auto columns = static_cast<std::size_t>(figure.columns);
  if (!figure.title.empty()) {
    body += fmt::format("set label 1000 {} at screen 0.5,{:.5f} center font ',{}'\n",
                        gnuplot_literal(figure.title), 1 - 13 / layout.height, font_size + 1);
  }
  for (std::size_t index = 0; index < figure.panels.size(); ++index) {
    const Panel& panel = figure.panels[index];
    const PanelLayout& where = layout.panels[index];
    const std::vector<Curve> curves = write_panel_data(script, panel, where.axes, index + 1);
    body += fmt::format("# panel {}, row {}\n", index + 1, index / columns + 1);
    body += panel_commands(layout, panel, where, curves);
    body += legend_commands(layout, where.legend, where.legend_place);
  }
  body += legend_commands(layout, layout.legend, layout.legend_place);
  body += "unset multiplot\n";
  for (std::size_t index = 0; index < outputs.size(); ++index) {
    script += terminal_commands(outputs[index], layout.width, layout.height);
    script += fmt::format("set output {}\n", gnuplot_literal(written_to[index].string()));
    script += body + "unset output\nreset\n";
  }
  return script;
}

}  // namespace liebench
