#include "plots/curve_tags.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "plots/axes.h"
#include "plots/style.h"

namespace liebench {
namespace {

// Twelve curves over three decades whose ends are `ratio` apart from one to the next.
Figure fan(double ratio) {
  Panel panel;
  for (int i = 0; i < 12; ++i) {
    Series series{.label = "curve " + std::to_string(i), .style = i, .tag = std::to_string(i + 1)};
    for (const double h : {1e-2, 1e-3, 1e-4, 1e-5}) series.points.push_back({h, h * h * std::pow(ratio, i)});
    panel.series.push_back(series);
  }
  return {.panels = {panel}};
}

TEST(CurveTags, StandBeyondTheEndsInTheColoursOfTheirCurves) {
  const Figure figure = fan(10);
  const Axes axes = axes_of(figure, {300, 200}).at(0);
  const auto tags = place_tags(figure.panels[0], axes);
  ASSERT_EQ(tags.size(), 12u);
  for (std::size_t i = 0; i < tags.size(); ++i) {
    const Series& series = figure.panels[0].series[i];
    EXPECT_EQ(tags[i].text, series.tag);
    EXPECT_EQ(tags[i].colour, colour_of(series));
    // The curves run to the left, and a decade is more than a tag.
    EXPECT_LE(tags[i].at.x, axes.x.position(1e-5));
    EXPECT_NEAR(tags[i].at.y, axes.y.position(series.points.back().y), 8);
  }
}

TEST(CurveTags, NeverLieOverEachOtherNorLeaveThePanel) {
  for (const double ratio : {1.0, 1.001, 1.3}) {
    const Figure figure = fan(ratio);
    const Axes axes = axes_of(figure, {300, 200}).at(0);
    const auto tags = place_tags(figure.panels[0], axes);
    ASSERT_EQ(tags.size(), 12u);
    for (std::size_t i = 0; i < tags.size(); ++i) {
      EXPECT_GE(tags[i].at.y, 5);
      EXPECT_LE(tags[i].at.y, axes.y.length - 5);
      for (std::size_t j = 0; j < i; ++j) EXPECT_GE(std::abs(tags[i].at.y - tags[j].at.y), 8 - 1e-9);
    }
  }
}

TEST(CurveTags, ASeriesWithoutATagOrWithoutAPointHasNone) {
  Figure figure = fan(2);
  figure.panels[0].series[0].tag.clear();
  figure.panels[0].series[1].points.clear();
  const Axes axes = axes_of(figure, {300, 200}).at(0);
  EXPECT_EQ(place_tags(figure.panels[0], axes).size(), 10u);
}

}  // namespace
}  // namespace liebench
