#include "plots/bar_chart.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "plots/text.h"

namespace liebench {
namespace {

const std::string note = "45.7 %; without it bodies move by 0.29 m";

void expect_room(const BarChart& chart) {
  const BarLayout at = layout(chart);
  EXPECT_LE(at.from, 0.0);
  EXPECT_GT(at.to, 0.0);
  EXPECT_LT(at.right, at.width);
  for (const Bar& bar : chart.bars) {
    EXPECT_GE(at.pixel(bar.value), at.left) << bar.label;
    EXPECT_LE(at.pixel(std::max(0.0, bar.value)) + text_width(bar.note), at.right) << bar.label;
    EXPECT_GT(at.left, text_width(bar.label)) << bar.label;
  }
}

TEST(BarChart, NotesEndInsideThePicture) {
  expect_room(
      {"scene", "share, %", {{"gravity", 8.5, note}, {"spring", 45.7, note}, {"gyroscopic", -2.8, note}}});
  expect_room({"scene", "share, %", {{"the longest name of all", 99.0, note}, {"x", 1e-3, note}}});
}

TEST(BarChart, BarsToTheLeftAndOfNoLengthHaveAnAxis) {
  expect_room({"scene", "share, %", {{"a", -3.0, note}, {"b", -1.0, note}}});
  expect_room({"scene", "share, %", {{"a", 0.0, note}}});
}

TEST(BarChart, LongerBarsEndFurtherRight) {
  const BarLayout at = layout({"scene", "share, %", {{"a", 10.0, note}, {"b", 20.0, note}}});
  EXPECT_GT(at.pixel(20.0), at.pixel(10.0));
  EXPECT_DOUBLE_EQ(at.pixel(20.0) - at.pixel(10.0), at.pixel(10.0) - at.pixel(0.0));
}

}  // namespace
}  // namespace liebench
