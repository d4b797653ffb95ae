#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace liebench {

/// A figure is plain data; draw() is the only verb. Every string is UTF-8 in gnuplot's enhanced notation
/// ("L_k", "h^2", "{/:Italic h}"); text that comes from outside goes through plain_text() first.

struct Point {
  double x = 0;
  double y = 0;
};

struct Range {
  double lower = 0;
  double upper = 0;
};

/// One curve.
struct Series {
  /// The legend's text. Series of equal label, style and variant share one entry; an empty label has none.
  std::string label = {};
  /// Colour and mark, the same in all panels of a figure, e.g. k - 2. Taken modulo style_count.
  int style = 0;
  /// The second variant of a style (double beside extended precision): a thin dashed line and open marks,
  /// drawn beneath and larger, so that where both agree a ring around the filled mark says so.
  bool secondary = false;
  /// A broad line and large marks, drawn beneath: for a curve that others may cover for part of its length.
  bool broad = false;
  /// Mark of another style; negative: that of `style`. So that colours tell groups apart and marks their members.
  int mark = -1;
  /// A short text beside the curve's last point and in front of its label in the legend: what it is, without a search for its
  /// colour. May be empty.
  std::string tag = {};
  /// Joined in this order. A y that is not finite counts as a failure at its x; a y that a logarithmic axis
  /// cannot show (an error of exactly 0), or beyond an explicit range, is drawn as an open triangle at that
  /// edge.
  std::vector<Point> points = {};
  /// Runs that failed: only x counts. A cross at the upper edge, and a gap in the line there.
  std::vector<Point> failures = {};
};

constexpr int style_count = 7;

/// A slope triangle of h^order. It is put where it covers no data, close to its series.
struct OrderLine {
  int order = 0;
  /// Label of the series it belongs to; empty: the lowest series that has this slope over a part of its
  /// length.
  std::string near = {};
  /// What stands beside it; empty: "h^{order}".
  std::string text = {};
};

/// A vertical line over the whole height of a panel, with its text beside its upper end: a predicted bound.
struct VerticalLine {
  double x = 0;
  std::string text = {};
  /// Colour, as that of a series.
  int style = 0;
};

struct Panel {
  std::string title = {};
  /// Quantity and unit: "step size h in s". Panels of a figure with the same x_label get the same x range,
  /// panels of a row with the same y_label the same y range.
  std::string x_label = {};
  std::string y_label = {};
  bool log_x = true;
  bool log_y = true;
  std::vector<Series> series = {};
  std::vector<OrderLine> orders = {};
  /// Those beyond the x range are not drawn.
  std::vector<VerticalLine> lines = {};
  /// Only where the automatic range (all of the data) will not do.
  std::optional<Range> x_range = {};
  std::optional<Range> y_range = {};
};

struct Figure {
  /// Above all panels; may be empty.
  std::string title = {};
  int rows = 1;
  int columns = 1;
  /// Row by row.
  std::vector<Panel> panels = {};
  /// One legend below all panels; else one below each panel. Never inside a panel.
  bool shared_legend = true;
  /// What the legend says of the crosses of failed runs; empty: "failed run".
  std::string failures = {};
};

/// Draws the figure into each of `outputs`; the ending chooses: .svg, .pdf or .png. Either all outputs
/// appear, whole, or what was there before stays (only a machine that fails between two renames can leave a
/// part of them). Throws std::invalid_argument (no such ending; a figure that does not fit itself),
/// std::system_error that names the file that cannot be written, GnuplotMissing, GnuplotError. Equal figures
/// give equal bytes on one machine; other versions of gnuplot, cairo or the fonts may give others.
void draw(const Figure& figure, std::span<const std::filesystem::path> outputs);

/// `text` so that gnuplot shows it letter by letter: "heavy_top" keeps its underscore.
std::string plain_text(std::string_view text);

}  // namespace liebench
