#include "plots/heat_map.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/plots/picture_files.h"

namespace liebench {
namespace {

HeatMap sample_map() {
  HeatMap map{.title = "Hard cases"};
  for (const int k : {2, 3, 4}) {
    map.rows.push_back("BLieDF2nd, k = " + std::to_string(k));
    map.row_groups.emplace_back("BLieDF2nd");
  }
  for (const char* radius : {"0.9", "0"}) {
    map.rows.push_back(std::string("generalized-alpha, rho_inf = ") + radius);
    map.row_groups.emplace_back("generalized-alpha");
  }
  map.columns = {{"index 3", "Long runs"},
                 {"stabilized index 2", "Long runs"},
                 {"kinematic", "Singularities of coordinates"},
                 {"h ω = 1", "Stiff spring"},
                 {"h ω = 1000", "Stiff spring"},
                 {"none of them"}};
  map.kinds = {{"passed", "#8ed1b8", "✓"},
               {"degraded", "#f0e442", "~"},
               {"failed as expected", "#8497ad", "×"},
               {"surprise", "#d55e00", "!"}};
  for (int row = 0; row < 5; ++row) {
    map.cells.emplace_back();
    for (int column = 0; column < 6; ++column) map.cells.back().push_back((row * 6 + column * 5) % 5 - 1);
  }
  return map;
}

std::vector<Rectangle> texts_of(const HeatMapLayout& at) {
  std::vector<Rectangle> result{at.title};
  result.insert(result.end(), at.row_labels.begin(), at.row_labels.end());
  result.insert(result.end(), at.column_labels.begin(), at.column_labels.end());
  for (const HeatMapLayout::Header& header : at.headers) result.push_back(header.place);
  for (const HeatMapLayout::Key& key : at.keys) result.push_back(key.text);
  return result;
}

void expect_order(const HeatMap& map) {
  const HeatMapLayout at = layout(map);
  std::vector<Rectangle> places = texts_of(at);
  for (const HeatMapLayout::Key& key : at.keys) places.push_back(key.sample);
  for (const std::vector<Rectangle>& row : at.cells) places.insert(places.end(), row.begin(), row.end());
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_TRUE(lies_inside(places[i], at.width, at.height)) << i;
    for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(overlap(places[i], places[j])) << i << " and " << j;
  }
  for (const double separator : at.separators) {
    for (std::size_t i = 1; i < places.size(); ++i) {
      if (places[i].lower < at.separator.lower) continue;
      EXPECT_FALSE(
          overlap(places[i], {separator, at.separator.lower, 0, at.separator.upper - at.separator.lower}));
    }
  }
}

TEST(HeatMap, NothingCoversAnythingElse) {
  expect_order(sample_map());
  expect_order({.title = "a title that is wider than the map",
                .rows = {"a"},
                .columns = {{"x"}},
                .kinds = {{"yes", "#000000", "✓"}},
                .cells = {{0}}});
  HeatMap untitled = sample_map();
  untitled.title.clear();
  expect_order(untitled);
}

TEST(HeatMap, AManyWordedLegendGoesOnInALowerLine) {
  HeatMap map = sample_map();
  map.columns.resize(1);
  for (std::vector<int>& row : map.cells) row.resize(1);
  for (int i = 0; i < 6; ++i)
    map.kinds.push_back({"another kind of failure " + std::to_string(i), "#112233", "?"});
  expect_order(map);
  const HeatMapLayout at = layout(map);
  EXPECT_GT(at.keys.front().sample.lower, at.keys.back().sample.lower);
}

TEST(HeatMap, HeadersCoverTheirColumnsAndNoOthers) {
  const HeatMap map = sample_map();
  const HeatMapLayout at = layout(map);
  ASSERT_EQ(at.headers.size(), 3);
  for (const HeatMapLayout::Header& header : at.headers) {
    for (std::size_t i = 0; i < map.columns.size(); ++i) {
      const Rectangle& cell = at.cells[0][i];
      const bool own = i >= header.first && i < header.last;
      EXPECT_EQ(own, cell.left >= header.place.left &&
                         cell.left + cell.width <= header.place.left + header.place.width);
      EXPECT_EQ(own, map.columns[i].group == map.columns[header.first].group);
    }
  }
  EXPECT_EQ(at.separators.size(), 3);
}

TEST(HeatMap, AFamilyOfRowsStandsApart) {
  HeatMap map = sample_map();
  const HeatMapLayout apart = layout(map);
  const auto distance = [&](std::size_t row) {
    return apart.cells[row][0].lower - apart.cells[row + 1][0].lower;
  };
  EXPECT_DOUBLE_EQ(distance(0), distance(1));
  EXPECT_GT(distance(2), distance(1));
  map.row_groups.clear();
  EXPECT_LT(layout(map).height, apart.height);
}

TEST(HeatMap, OnlyAMapWithEmptyCellsExplainsThem) {
  HeatMap map = sample_map();
  EXPECT_EQ(layout(map).keys.size(), 5);
  EXPECT_EQ(layout(map).keys.back().kind, -1);
  for (std::vector<int>& row : map.cells) row.assign(row.size(), 0);
  EXPECT_EQ(layout(map).keys.size(), 4);
}

TEST(HeatMap, ThatDoesNotFitItselfIsRefused) {
  const auto refuses = [](auto change) {
    HeatMap map = sample_map();
    change(map);
    EXPECT_THROW(layout(map), std::invalid_argument);
  };
  refuses([](HeatMap& map) { map = {}; });
  refuses([](HeatMap& map) { map.columns.clear(); });
  refuses([](HeatMap& map) { map.cells[2].pop_back(); });
  refuses([](HeatMap& map) { map.cells.pop_back(); });
  refuses([](HeatMap& map) { map.cells[1][1] = 4; });
  refuses([](HeatMap& map) { map.cells[1][1] = -2; });
  refuses([](HeatMap& map) { map.row_groups.pop_back(); });
  refuses([](HeatMap& map) { map.kinds[0].colour = "green"; });
}

class HeatMapFiles : public PictureFiles {};

TEST_F(HeatMapFiles, ShowEveryLabelAndAGlyphInEveryCell) {
  const HeatMap map = sample_map();
  const std::array<std::filesystem::path, 3> outputs{folder_ / "a.svg", folder_ / "a.pdf", folder_ / "a.png"};
  draw(map, outputs);
  const std::string svg = read(outputs[0]);
  EXPECT_EQ(occurrences(svg, ">Hard cases<"), 1);
  for (const std::string& row : map.rows) EXPECT_EQ(occurrences(svg, ">" + row + "<"), 1) << row;
  for (const HeatMap::Column& column : map.columns) EXPECT_EQ(occurrences(svg, ">" + column.label + "<"), 1);
  for (const HeatMapLayout::Header& header : layout(map).headers)
    for (const std::string& line : header.lines) EXPECT_EQ(occurrences(svg, ">" + line + "<"), 1) << line;
  for (std::size_t kind = 0; kind < map.kinds.size(); ++kind) {
    std::size_t cells = 0;
    for (const std::vector<int>& row : map.cells)
      for (const int cell : row) cells += std::size_t(cell == int(kind));
    EXPECT_EQ(occurrences(svg, ">" + map.kinds[kind].glyph + "<"), cells + 1) << "and one in the legend";
    EXPECT_EQ(occurrences(svg, ">" + map.kinds[kind].name + "<"), 1);
  }
  EXPECT_TRUE(read(outputs[1]).starts_with("%PDF-"));
  EXPECT_TRUE(read(outputs[2]).starts_with("\x89PNG"));
}

TEST_F(HeatMapFiles, AreEqualForEqualMaps) {
  const std::array<std::filesystem::path, 3> first{folder_ / "a.svg", folder_ / "a.pdf", folder_ / "a.png"};
  const std::array<std::filesystem::path, 3> second{folder_ / "b.svg", folder_ / "b.pdf", folder_ / "b.png"};
  draw(sample_map(), first);
  // The clock of a PDF counts seconds.
  sleep(1);
  draw(sample_map(), second);
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(read(first[i]), read(second[i])) << first[i];
}

TEST_F(HeatMapFiles, DoNotAppearWhereOneOfThemCannotBeDrawn) {
  const std::array<std::filesystem::path, 2> outputs{folder_ / "a.svg", folder_ / "a.jpeg"};
  EXPECT_THROW(draw(sample_map(), outputs), std::invalid_argument);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

}  // namespace
}  // namespace liebench
