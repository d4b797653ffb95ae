#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "plots/layout.h"
#include "plots/text.h"

namespace liebench {

/// Small multiples of regions of the complex plane in which a method is stable. Every string is UTF-8 in gnuplot's enhanced
/// notation, as in a Figure.
struct RegionMap {
  struct Region {
    std::string title;
    double x_from = 0;
    double x_to = 0;
    double y_from = 0;
    double y_to = 0;
    /// Nodes along x and y, both ends included.
    int nx = 0;
    int ny = 0;
    /// log10 of the spectral radius at the nodes, row by row from y_from on: growth[j nx + i]. NaN: there is none.
    std::vector<double> growth = {};
  };

  std::string title;
  /// Below the lowest panel of a column, and beside the first of a row.
  std::string x_label;
  std::string y_label;
  int columns = 1;
  /// Row by row.
  std::vector<Region> regions = {};
  /// Stable is what grows no faster than this. Not 0: roots on the unit circle, over all of the region where a method conserves
  /// energy, lie on either side of it by rounding, and an m-fold root by eps^(1/m), 7e-4 for m = 5. What grows tenfold in a
  /// thousand steps is told from them. The line is drawn here too: at 0 it would be a picture of the rounding.
  double tolerance = 1e-3;
  std::string stable_name = "stable";
  std::string unstable_name = "unstable";
  /// What the legend says of nodes without a value, where there are any.
  std::string nothing_name = "no value";
};

/// Where everything stands in a picture of `width` by `height`.
struct RegionMapLayout {
  struct Panel {
    /// The plot area: a unit is as long in x as in y.
    Rectangle plot = {};
    FittedText title_text = {};
    Rectangle title = {};
    /// Between ticks, of both axes.
    double tick_step = 1;
    bool x_labelled = false;
    bool y_labelled = false;
  };
  /// An entry of the legend.
  struct Key {
    std::string name;
    std::string colour;
    Rectangle sample = {};
    Rectangle text = {};
  };

  double width = 0;
  double height = 0;
  Rectangle title = {};
  std::vector<Panel> panels = {};
  std::vector<Key> keys = {};
};

/// Throws std::invalid_argument if the map does not fit itself.
RegionMapLayout layout(const RegionMap& map);

/// As draw() of a figure.
void draw(const RegionMap& map, std::span<const std::filesystem::path> outputs);

}  // namespace liebench
