#include "plots/contour.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace liebench {
namespace {

/// The grid with a ring of nodes around it that have no value and lie on its edge, so that every line is closed.
class RingedGrid {
 public:
  RingedGrid(const Field& field, double level) : field_(field), level_(level) {}

  int nx() const { return field_.nx + 2; }
  int ny() const { return field_.ny + 2; }
  int node(int i, int j) const { return j * nx() + i; }
  int nodes() const { return nx() * ny(); }

  /// The value above the level; NaN in the ring. Infinities (a pole, a root of zero) become large numbers, between which one
  /// can interpolate.
  double excess(int i, int j) const {
    if (i == 0 || j == 0 || i == nx() - 1 || j == ny() - 1) return NAN;
    const double value = field_.values[static_cast<std::size_t>(j - 1) * static_cast<std::size_t>(field_.nx) +
                                       static_cast<std::size_t>(i - 1)];
    return std::isnan(value) ? NAN : std::clamp(value - level_, -1e30, 1e30);
  }
  bool inside(int i, int j) const { return excess(i, j) <= 0; }
  Point at(int i, int j) const { return {along(field_.x, i, field_.nx), along(field_.y, j, field_.ny)}; }

  /// Where the line crosses the edge between a node inside and one that is not.
  Point crossing(int i0, int j0, int i1, int j1) const {
    if (!inside(i0, j0)) return crossing(i1, j1, i0, j0);
    const Point from = at(i0, j0), to = at(i1, j1);
    const double here = excess(i0, j0), there = excess(i1, j1);
    if (std::isnan(there)) return from;
    const double part = here / (here - there);
    return {from.x + part * (to.x - from.x), from.y + part * (to.y - from.y)};
  }

 private:
  static double along(Range range, int index, int count) {
    const double part = double(std::clamp(index - 1, 0, count - 1)) / (count - 1);
    return range.lower + part * (range.upper - range.lower);
  }

  const Field& field_;
  double level_;
};

}  // namespace

void check(const Field& field) {
  const auto ordered = [](Range range) {
    return std::isfinite(range.lower) && std::isfinite(range.upper) && range.lower < range.upper;
  };
  if (!ordered(field.x) || !ordered(field.y)) {
    throw std::invalid_argument(fmt::format("no field over {} to {} by {} to {}", field.x.lower,
                                            field.x.upper, field.y.lower, field.y.upper));
  }
  const auto count =
      static_cast<std::size_t>(std::max(field.nx, 0)) * static_cast<std::size_t>(std::max(field.ny, 0));
  if (field.nx < 2 || field.ny < 2 || field.values.size() != count) {
    throw std::invalid_argument(
        fmt::format("{} values on a grid of {} by {}", field.values.size(), field.nx, field.ny));
  }
}

double Outline::signed_area() const {
  double twice = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& from = points[i];
    const Point& to = points[(i + 1) % points.size()];
    twice += from.x * to.y - to.x * from.y;
  }
  return twice / 2;
}

std::vector<Outline> outlines(const Field& field, double level) {
  check(field);
  const RingedGrid grid(field, level);
  // Edge e < nodes leads from node e to the right, edge nodes + e from node e upwards. A line that comes in over an edge goes
  // on to next[edge], the area to its left; every crossing is the start of one piece and the end of one.
  std::vector<int> next(2 * static_cast<std::size_t>(grid.nodes()), -1);
  for (int j = 0; j + 1 < grid.ny(); ++j) {
    for (int i = 0; i + 1 < grid.nx(); ++i) {
      // Counter-clockwise from the lower left; edges[s] lies between the corners s and s + 1.
      const std::array inside{grid.inside(i, j), grid.inside(i + 1, j), grid.inside(i + 1, j + 1),
                              grid.inside(i, j + 1)};
      const std::array edges{grid.node(i, j), grid.nodes() + grid.node(i + 1, j), grid.node(i, j + 1),
                             grid.nodes() + grid.node(i, j)};
      const bool saddle = inside[0] == inside[2] && inside[1] == inside[3] && inside[0] != inside[1];
      // Without a value (NaN) at a corner a saddle is cut in two.
      const bool joined =
          saddle &&
          grid.excess(i, j) + grid.excess(i + 1, j) + grid.excess(i, j + 1) + grid.excess(i + 1, j + 1) <= 0;
      for (std::size_t s = 0; s < 4; ++s) {
        // Along edge s counter-clockwise the area ends: a piece starts here. It leads around the corners inside before it, or,
        // where the areas of a saddle are joined, around the corner outside behind it.
        if (!inside[s] || inside[(s + 1) % 4]) continue;
        std::size_t end = (s + 1) % 4;
        if (joined) {
          while (inside[end] == inside[(end + 1) % 4]) end = (end + 1) % 4;
        } else {
          end = (s + 3) % 4;
          while (inside[end] == inside[(end + 1) % 4]) end = (end + 3) % 4;
        }
        next[static_cast<std::size_t>(edges[s])] = edges[end];
      }
    }
  }

  std::vector<Outline> result;
  for (std::size_t start = 0; start < next.size(); ++start) {
    if (next[start] < 0) continue;
    Outline& outline = result.emplace_back();
    for (std::size_t edge = start; next[edge] >= 0;) {
      const bool upwards = edge >= static_cast<std::size_t>(grid.nodes());
      const int node = static_cast<int>(edge) - (upwards ? grid.nodes() : 0);
      const int i = node % grid.nx(), j = node / grid.nx();
      const int i1 = upwards ? i : i + 1, j1 = upwards ? j + 1 : j;
      outline.points.push_back(grid.crossing(i, j, i1, j1));
      outline.crossing.push_back(!std::isnan(grid.excess(i, j)) && !std::isnan(grid.excess(i1, j1)));
      edge = static_cast<std::size_t>(std::exchange(next[edge], -1));
    }
  }
  return result;
}

}  // namespace liebench
