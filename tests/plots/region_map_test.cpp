#include "plots/region_map.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <complex>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/plots/picture_files.h"

namespace liebench {
namespace {

/// log10 |1 + z|: explicit Euler's, stable in a circle around -1.
RegionMap::Region euler_region(double x_from, double x_to, double y_from, double y_to) {
  RegionMap::Region region{"explicit Euler", x_from, x_to, y_from, y_to, 121, 101, {}};
  for (int j = 0; j < region.ny; ++j) {
    for (int i = 0; i < region.nx; ++i) {
      region.growth.push_back(
          std::log10(std::abs(std::complex(1 + x_from + (x_to - x_from) * i / (region.nx - 1),
                                           y_from + (y_to - y_from) * j / (region.ny - 1)))));
    }
  }
  return region;
}

RegionMap sample_regions() {
  RegionMap map{
      .title = "Regions", .x_label = "Re({/:Italic h} λ)", .y_label = "Im({/:Italic h} λ)", .columns = 2};
  map.regions = {euler_region(-3, 1, -2, 2), euler_region(-4, 4, -1, 1), euler_region(-0.5, 0.5, -4, 4)};
  map.regions[1].title = "a title that is much longer than the panel that it stands above";
  map.regions[2].growth[50] = NAN;
  return map;
}

TEST(RegionMap, NothingCoversAnythingElse) {
  const RegionMapLayout at = layout(sample_regions());
  std::vector<Rectangle> places{at.title};
  for (const RegionMapLayout::Panel& panel : at.panels) {
    places.push_back(panel.plot);
    places.push_back(panel.title);
  }
  for (const RegionMapLayout::Key& key : at.keys) {
    places.push_back(key.sample);
    places.push_back(key.text);
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_TRUE(lies_inside(places[i], at.width, at.height)) << i;
    for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(overlap(places[i], places[j])) << i << " and " << j;
  }
}

TEST(RegionMap, AUnitIsAsLongInBothDirections) {
  const RegionMap map = sample_regions();
  const RegionMapLayout at = layout(map);
  for (std::size_t i = 0; i < map.regions.size(); ++i) {
    const RegionMap::Region& region = map.regions[i];
    const Rectangle& plot = at.panels[i].plot;
    EXPECT_DOUBLE_EQ(plot.width / (region.x_to - region.x_from), plot.height / (region.y_to - region.y_from));
  }
}

TEST(RegionMap, LowestPanelsAndFirstOnesAreLabelled) {
  const RegionMapLayout at = layout(sample_regions());
  EXPECT_FALSE(at.panels[0].x_labelled);
  EXPECT_TRUE(at.panels[1].x_labelled);
  EXPECT_TRUE(at.panels[2].x_labelled);
  EXPECT_TRUE(at.panels[0].y_labelled);
  EXPECT_FALSE(at.panels[1].y_labelled);
  EXPECT_TRUE(at.panels[2].y_labelled);
}

TEST(RegionMap, OnlyAMapWithNodesWithoutAValueExplainsThem) {
  RegionMap map = sample_regions();
  EXPECT_EQ(layout(map).keys.size(), 3);
  map.regions.pop_back();
  EXPECT_EQ(layout(map).keys.size(), 2);
}

TEST(RegionMap, ThatDoesNotFitItselfIsRefused) {
  const auto refuses = [](auto change) {
    RegionMap map = sample_regions();
    change(map);
    EXPECT_THROW(layout(map), std::invalid_argument);
  };
  refuses([](RegionMap& map) { map.regions.clear(); });
  refuses([](RegionMap& map) { map.columns = 0; });
  refuses([](RegionMap& map) { map.tolerance = NAN; });
  refuses([](RegionMap& map) { map.regions[1].growth.pop_back(); });
  refuses([](RegionMap& map) { map.regions[1].x_to = map.regions[1].x_from; });
  refuses([](RegionMap& map) { map.regions[1].y_from = -INFINITY; });
  refuses([](RegionMap& map) { map.regions[1].nx = 1; });
}

class RegionMapFiles : public PictureFiles {};

TEST_F(RegionMapFiles, ShowEveryLabelInFewBytes) {
  RegionMap map = sample_regions();
  const std::array<std::filesystem::path, 3> outputs{folder_ / "a.svg", folder_ / "a.pdf", folder_ / "a.png"};
  draw(map, outputs);
  const std::string svg = read(outputs[0]);
  for (const char* text : {"Regions", "explicit Euler", "stable", "unstable", "no value"})
    EXPECT_GE(occurrences(svg, std::string(">") + text + "<"), 1) << text;
  EXPECT_EQ(occurrences(svg, ">Re(<"), 2);
  EXPECT_EQ(occurrences(svg, ">Im(<"), 2);
  EXPECT_LT(svg.size(), 60000);
  EXPECT_TRUE(read(outputs[1]).starts_with("%PDF-"));
  EXPECT_TRUE(read(outputs[2]).starts_with("\x89PNG"));
}

TEST_F(RegionMapFiles, AreDrawnWhereNothingOrAllIsStable) {
  RegionMap map = sample_regions();
  for (const double growth : {1.0, -1.0, double(NAN)}) {
    for (RegionMap::Region& region : map.regions) region.growth.assign(region.growth.size(), growth);
    const std::array<std::filesystem::path, 1> outputs{folder_ / "a.svg"};
    draw(map, outputs);
    EXPECT_EQ(occurrences(read(outputs[0]), ">explicit Euler<"), 2) << growth;
  }
}

TEST_F(RegionMapFiles, AreEqualForEqualMaps) {
  const std::array<std::filesystem::path, 3> first{folder_ / "a.svg", folder_ / "a.pdf", folder_ / "a.png"};
  const std::array<std::filesystem::path, 3> second{folder_ / "b.svg", folder_ / "b.pdf", folder_ / "b.png"};
  draw(sample_regions(), first);
  // The clock of a PDF counts seconds.
  sleep(1);
  draw(sample_regions(), second);
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(read(first[i]), read(second[i])) << first[i];
}

TEST_F(RegionMapFiles, DoNotAppearWhereOneOfThemCannotBeDrawn) {
  const std::array<std::filesystem::path, 2> outputs{folder_ / "a.svg", folder_ / "a.jpeg"};
  EXPECT_THROW(draw(sample_regions(), outputs), std::invalid_argument);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

}  // namespace
}  // namespace liebench
