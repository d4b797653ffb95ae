#pragma once

#include <vector>

#include "plots/figure.h"

namespace liebench {

/// Values at the nodes of a rectangular grid, row by row: node (i, j), i < nx, j < ny, lies at x.lower + i (x.upper - x.lower) /
/// (nx - 1) and likewise for y and j, its value is values[j nx + i]. NaN: there is none.
struct Field {
  Range x;
  Range y;
  int nx = 0;
  int ny = 0;
  std::vector<double> values = {};
};

/// Throws std::invalid_argument if the field does not fit itself.
void check(const Field& field);

/// A closed line, its first point not repeated.
struct Outline {
  std::vector<Point> points;
  /// Of each point: whether the field crosses the level there; else the line follows the grid's edge, or nodes beside a NaN.
  std::vector<bool> crossing;

  /// Positive: the area lies inside of the line, which runs counter-clockwise; negative: the line bounds a hole.
  double signed_area() const;
};

/// The lines around the areas where the field is at most `level`, linear between neighbours (marching squares; a saddle is
/// decided by the mean of its corners). They do not cross each other. Throws as check() does.
std::vector<Outline> outlines(const Field& field, double level);

}  // namespace liebench
