#include "plots/gnuplot_script.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/plots/convergence_figure.h"

namespace liebench {
namespace {

namespace fs = std::filesystem;

std::string script_of(const Figure& figure) {
  const std::array<fs::path, 1> outputs{"/tmp/figure.svg"};
  return gnuplot_script(figure, outputs);
}

/// The lines of a datablock.
std::vector<std::string> datablock(const std::string& script, const std::string& name) {
  std::vector<std::string> lines;
  const std::string head = "$" + name + " << EOD\n";
  const std::size_t start = script.find(head);
  if (start == std::string::npos) return lines;
  std::istringstream text(script.substr(start + head.size()));
  for (std::string line; std::getline(text, line) && line != "EOD";) lines.push_back(line);
  return lines;
}

Point point_of(const std::string& line) {
  Point point;
  std::istringstream(line) >> point.x >> point.y;
  return point;
}

Range y_range_of(const std::string& script, std::size_t number) {
  std::size_t at = 0;
  for (std::size_t count = 0; count < number; ++count) at = script.find("set yrange [", at + 1);
  Range range;
  char colon = 0;
  std::istringstream(script.substr(at + 12)) >> range.lower >> colon >> range.upper;
  return range;
}

/// Of the first panel, as a part of the figure's width.
double left_margin_of(const std::string& script) {
  const std::string head = "set lmargin at screen ";
  return std::stod(script.substr(script.find(head) + head.size()));
}

TEST(FigureScript, SaysWhatThePanelSays) {
  const std::string script = script_of(convergence_figure());
  for (const char* part : {"set title 'with L_k'", "set xlabel 'step size h in s'",
                           "set ylabel 'max error of λ in N'", "set logscale x 10", "set logscale y 10",
                           "set format y '10^{%T}'", "'k = 2'", "'k = 4, double'", "set encoding utf8"}) {
    EXPECT_TRUE(contains(script, part)) << part;
  }
}

TEST(FigureScript, CarriesAllDataExactly) {
  const Figure figure = convergence_figure();
  const std::vector<std::string> lines = datablock(script_of(figure), "panel1_curve3");
  const std::vector<Point>& points = figure.panels[0].series[2].points;
  ASSERT_EQ(lines.size(), points.size());
  for (std::size_t index = 0; index < lines.size(); ++index) {
    EXPECT_EQ(point_of(lines[index]).x, points[index].x);
    EXPECT_EQ(point_of(lines[index]).y, points[index].y);
  }
}

TEST(FigureScript, SharesOneLegendOrGivesEachPanelItsOwn) {
  const auto count = [](const std::string& text, const std::string& part) {
    int result = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++result;
    return result;
  };
  Figure figure = convergence_figure();
  EXPECT_EQ(count(script_of(figure), "set label 'k = 2'"), 1);
  figure.shared_legend = false;
  EXPECT_EQ(count(script_of(figure), "set label 'k = 2'"), 2);
}

TEST(FigureScript, NamesFailedRunsInTheLegendOnlyWhereThereAreAny) {
  Figure figure = convergence_figure();
  EXPECT_FALSE(contains(script_of(figure), "failed run"));
  figure.panels[1].series[0].failures = {{.x = 0.1}};
  EXPECT_TRUE(contains(script_of(figure), "failed run"));
}

TEST(FigureScript, DrawsTheSecondVariantThinDashedAndBeneath) {
  const std::string script = script_of(convergence_figure());
  const std::size_t second = script.find("$panel1_curve4 using");
  ASSERT_NE(second, std::string::npos);
  EXPECT_LT(second, script.find("$panel1_curve1 using"));
  EXPECT_TRUE(contains(script.substr(second, script.find('\n', second) - second), "dt (12,7)"));
}

TEST(FigureScript, PutsFailuresAtTheUpperEdgeAndSideBySide) {
  Figure figure = convergence_figure();
  Panel& panel = figure.panels[0];
  panel.series[0].failures = {{.x = 1e-3, .y = 77}};
  panel.series[1].points[6].y = std::numeric_limits<double>::quiet_NaN();
  const double nan_at = panel.series[1].points[6].x;
  ASSERT_NEAR(nan_at, 1e-3, 1e-15);

  const std::string script = script_of(figure);
  const auto first = datablock(script, "panel1_failed1");
  const auto second = datablock(script, "panel1_failed2");
  ASSERT_EQ(first.size(), 1U);
  ASSERT_EQ(second.size(), 1U);
  const Range range = y_range_of(script, 1);
  double largest = 0;
  for (const Series& series : panel.series) {
    for (const Point& point : series.points) {
      if (std::isfinite(point.y)) largest = std::max(largest, point.y);
    }
  }
  for (const Point& mark : {point_of(first[0]), point_of(second[0])}) {
    EXPECT_LT(mark.y, range.upper);
    EXPECT_GT(mark.y, largest);
  }
  EXPECT_GT(point_of(first[0]).y, point_of(second[0]).y);
  EXPECT_EQ(point_of(second[0]).x, nan_at);
}

TEST(FigureScript, LiftsThePenWhereARunFailed) {
  Figure figure = convergence_figure();
  figure.panels[0].series[1].points[6].y = std::numeric_limits<double>::infinity();
  const auto lines = datablock(script_of(figure), "panel1_curve2");
  EXPECT_EQ(std::ranges::count(lines, ""), 1);
  EXPECT_EQ(lines[6], "");
}

TEST(FigureScript, ShowsAnErrorOfZeroAtTheLowerEdge) {
  Figure figure = convergence_figure();
  figure.panels[0].series[0].points[3].y = 0;
  const std::string script = script_of(figure);
  const auto lines = datablock(script, "panel1_below1");
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_GT(point_of(lines[0]).y, y_range_of(script, 1).lower);
  EXPECT_TRUE(contains(script, "beyond the axis"));
}

TEST(FigureScript, MarksWhatAnExplicitRangeCutsOff) {
  Figure figure = convergence_figure();
  figure.panels[0].y_range = Range{1e-10, 1e-4};
  const std::string script = script_of(figure);
  EXPECT_FALSE(datablock(script, "panel1_above1").empty());
  EXPECT_FALSE(datablock(script, "panel1_below3").empty());
}

TEST(FigureScript, GivesEqualRangesToEqualLabelsInARow) {
  Figure figure = convergence_figure();
  for (Point& point : figure.panels[1].series[0].points) point.y *= 1e6;
  const std::string same = script_of(figure);
  EXPECT_EQ(y_range_of(same, 1).upper, y_range_of(same, 2).upper);
  figure.panels[1].y_label = "max error of q";
  const std::string other = script_of(figure);
  EXPECT_LT(y_range_of(other, 1).upper, y_range_of(other, 2).upper);
}

TEST(FigureScript, WrapsAYLabelThatIsLongerThanItsPanel) {
  Figure figure = convergence_figure();
  const std::string narrow = script_of(figure);
  EXPECT_TRUE(contains(narrow, "set ylabel 'max error of λ in N' offset"));

  figure.panels[0].y_label = "max error of λ in N, over all steps";
  const std::string wrapped = script_of(figure);
  EXPECT_TRUE(contains(wrapped, "set ylabel 'max error of λ in N,'.\"\\n\".'over all steps' offset"));
  EXPECT_TRUE(contains(wrapped, "set ylabel 'max error of λ in N' offset"));
  EXPECT_NE(left_margin_of(wrapped), left_margin_of(narrow));
}

TEST(FigureScript, TextCannotLeaveItsQuotes) {
  Figure figure = convergence_figure();
  figure.title = "it's `touch /tmp/no`\nquit";
  EXPECT_TRUE(contains(script_of(figure), "'it''s `touch /tmp/no` quit'"));
  EXPECT_EQ(plain_text("heavy_top^{2}"), "heavy\\_top\\^\\{2\\}");
}

TEST(FigureScript, RefusesFiguresThatDoNotFitThemselves) {
  Figure figure = convergence_figure();
  figure.columns = 1;
  EXPECT_THROW(script_of(figure), std::invalid_argument);
  figure = convergence_figure();
  figure.panels[0].y_range = Range{0, 1};
  EXPECT_THROW(script_of(figure), std::invalid_argument);
  EXPECT_THROW(script_of(Figure{}), std::invalid_argument);
}

}  // namespace
}  // namespace liebench
