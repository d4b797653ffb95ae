#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "plots/layout.h"

namespace liebench {

/// A matrix of verdicts. Every string is shown letter by letter.
struct HeatMap {
  struct Column {
    std::string label;
    /// Neighbours of equal group share a header above their labels; empty: none.
    std::string group = {};
  };
  /// What a cell may say: told by its colour ("#rrggbb") and, for those who cannot see it, by its glyph.
  struct Kind {
    std::string name;
    std::string colour;
    std::string glyph;
  };

  std::string title;
  std::vector<std::string> rows = {};
  std::vector<Column> columns = {};
  /// The entries of the legend, in this order.
  std::vector<Kind> kinds = {};
  /// Row by row the index of a kind; -1: there is nothing to say, an empty light cell.
  std::vector<std::vector<int>> cells = {};
  /// Of each row, or empty: a thin gap parts a row from one of another group.
  std::vector<std::string> row_groups = {};
  /// What the legend says of empty cells, where there are any; empty: nothing.
  std::string empty_name = "does not apply";
};

/// Where everything stands in a picture of `width` by `height`.
struct HeatMapLayout {
  struct Header {
    std::vector<std::string> lines;
    /// Its columns are [first, last), and it covers them.
    std::size_t first = 0;
    std::size_t last = 0;
    Rectangle place = {};
  };
  /// An entry of the legend.
  struct Key {
    /// As in `cells`.
    int kind = -1;
    Rectangle sample = {};
    Rectangle text = {};
  };

  double width = 0;
  double height = 0;
  Rectangle title = {};
  std::vector<Rectangle> row_labels = {};
  /// Of the texts as they stand, upwards.
  std::vector<Rectangle> column_labels = {};
  std::vector<Header> headers = {};
  std::vector<std::vector<Rectangle>> cells = {};
  /// Vertical lines between groups of columns: x, and their lower and upper end.
  std::vector<double> separators = {};
  Range separator = {};
  std::vector<Key> keys = {};
};

/// Throws std::invalid_argument if the map does not fit itself: no row or column, ragged cells, a kind that is not there.
HeatMapLayout layout(const HeatMap& map);

/// As draw() of a figure.
void draw(const HeatMap& map, std::span<const std::filesystem::path> outputs);

}  // namespace liebench
