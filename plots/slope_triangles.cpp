#include "plots/slope_triangles.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "plots/edge_marks.h"
#include "plots/style.h"
#include "plots/text.h"

namespace liebench {
namespace {

// Geometry in points from the lower left corner of the plot area.

constexpr std::string_view shared_colour = "#606060";

struct Box {
  double left, lower, right, upper;
};

struct Segment {
  Point from, to;
};

double cross(const Point& origin, const Point& one, const Point& two) {
  return (one.x - origin.x) * (two.y - origin.y) - (one.y - origin.y) * (two.x - origin.x);
}

double distance(const Point& point, const Segment& segment) {
  const double dx = segment.to.x - segment.from.x;
  const double dy = segment.to.y - segment.from.y;
  const double square = dx * dx + dy * dy;
  const double product = (point.x - segment.from.x) * dx + (point.y - segment.from.y) * dy;
  const double part = square > 0 ? std::clamp(product / square, 0.0, 1.0) : 0;
  return std::hypot(point.x - segment.from.x - part * dx, point.y - segment.from.y - part * dy);
}

double distance(const Segment& one, const Segment& two) {
  if (cross(one.from, one.to, two.from) * cross(one.from, one.to, two.to) < 0 &&
      cross(two.from, two.to, one.from) * cross(two.from, two.to, one.to) < 0) {
    return 0;
  }
  return std::min(
      {distance(one.from, two), distance(one.to, two), distance(two.from, one), distance(two.to, one)});
}

/// A triangle with its text, as a candidate for a place.
struct Candidate {
  Point start, end, corner, text_at;
  Box text;

  std::array<Segment, 7> edges() const {
    const Point a{text.left, text.lower};
    const Point b{text.right, text.lower};
    const Point c{text.right, text.upper};
    const Point d{text.left, text.upper};
    return {{{start, end}, {end, corner}, {corner, start}, {a, b}, {b, c}, {c, d}, {d, a}}};
  }
  Box bounds() const {
    return {std::min({start.x, end.x, text.left}), std::min({start.y, end.y, text.lower}),
            std::max({start.x, end.x, text.right}), std::max({start.y, end.y, text.upper})};
  }
};

// Distances beyond `horizon` count as `horizon`: how far is far does not matter, and most segments need no
// arithmetic.
double clearance(const Candidate& candidate, std::span<const Segment> obstacles, double horizon) {
  const Box box = candidate.bounds();
  const std::array<Segment, 7> edges = candidate.edges();
  double result = horizon;
  for (const Segment& segment : obstacles) {
    const auto [left, right] = std::minmax(segment.from.x, segment.to.x);
    const auto [lower, upper] = std::minmax(segment.from.y, segment.to.y);
    if (left > box.right + result || right < box.left - result || lower > box.upper + result ||
        upper < box.lower - result) {
      continue;
    }
    const auto inside = [&](const Point& point) {
      const double one = cross(candidate.start, candidate.end, point);
      const double two = cross(candidate.end, candidate.corner, point);
      const double three = cross(candidate.corner, candidate.start, point);
      const bool in_triangle = (one > 0 && two > 0 && three > 0) || (one < 0 && two < 0 && three < 0);
      const Box& text = candidate.text;
      return in_triangle ||
             (point.x > text.left && point.x < text.right && point.y > text.lower && point.y < text.upper);
    };
    if (inside(segment.from) || inside(segment.to)) return 0;
    for (const Segment& edge : edges) result = std::min(result, distance(edge, segment));
    if (result == 0) return 0;
  }
  return result;
}

/// Pieces of a curve between finite neighbours; a lone point gives a piece of no length.
std::vector<Segment> pieces(const Series& series, const Axes& axes) {
  std::vector<Segment> result;
  Point previous;
  bool pen_down = false;
  for (const Point& point : series.points) {
    if (place_of(point, axes) == Place::nowhere) {
      pen_down = false;
      continue;
    }
    const double y = on_axis(point.y, axes.y.logarithmic) ? axes.y.position(point.y) : 0.0;
    const Point at{axes.x.position(point.x), std::clamp(y, 0.0, axes.y.length)};
    result.push_back({pen_down ? previous : at, at});
    previous = at;
    pen_down = true;
  }
  return result;
}

/// The segments of this slope, within the tolerance.
std::vector<Segment> matching(std::span<const Segment> segments, double slope, double tolerance) {
  std::vector<Segment> result;
  for (const Segment& segment : segments) {
    const double dx = segment.to.x - segment.from.x;
    if (std::abs(dx) < 1e-6) continue;
    if (std::abs((segment.to.y - segment.from.y) / dx - slope) < tolerance) result.push_back(segment);
  }
  return result;
}

double horizontal_length(std::span<const Segment> segments) {
  return std::accumulate(segments.begin(), segments.end(), 0.0, [](double sum, const Segment& segment) {
    return sum + std::abs(segment.to.x - segment.from.x);
  });
}

/// Height of the line of the given slope through the segments, at x = 0.
double offset_of(std::span<const Segment> segments, double slope) {
  double sum = 0;
  for (const Segment& segment : segments) {
    sum += (segment.from.y + segment.to.y) / 2 - slope * (segment.from.x + segment.to.x) / 2;
  }
  return sum / static_cast<double>(segments.size());
}

/// Anchors every few points along the segments.
std::vector<Point> sampled(std::span<const Segment> segments) {
  std::vector<Point> result;
  for (const Segment& segment : segments) {
    const double length = std::hypot(segment.to.x - segment.from.x, segment.to.y - segment.from.y);
    const int count = std::max(1, static_cast<int>(length / 5));
    for (int part = 0; part <= count; ++part) {
      const double t = static_cast<double>(part) / count;
      result.push_back({segment.from.x + t * (segment.to.x - segment.from.x),
                        segment.from.y + t * (segment.to.y - segment.from.y)});
    }
  }
  return result;
}

/// Anchors all over the plot area.
std::vector<Point> grid(PlotArea area) {
  std::vector<Point> result;
  for (double x = 10; x < area.width; x += 6) {
    for (double y = 10; y < area.height; y += 6) result.push_back({x, y});
  }
  return result;
}

/// The right angle points away from the curve: below a curve that the triangle is under, above it otherwise.
Candidate candidate_at(const Point& middle, double width, double slope, bool under, double label_width) {
  const double rise = slope * width;
  const bool corner_right = under == (slope > 0);
  Candidate result{};
  result.start = {middle.x - width / 2, middle.y - rise / 2};
  result.end = {middle.x + width / 2, middle.y + rise / 2};
  result.corner = corner_right ? Point{result.end.x, result.start.y} : Point{result.start.x, result.end.y};
  const double side = corner_right ? 1 : -1;
  result.text_at = {result.corner.x + side * (label_width / 2 + 3), middle.y};
  result.text = {result.text_at.x - label_width / 2, middle.y - 5.5, result.text_at.x + label_width / 2,
                 middle.y + 6.5};
  return result;
}

std::string text_of(const OrderLine& order) {
  return order.text.empty() ? fmt::format("h^{{{}}}", order.order) : order.text;
}

/// The part of a curve that has the slope of an order.
struct Match {
  const Series* series;
  std::vector<Segment> segments;
};

/// What a triangle belongs to. Without segments it belongs to no curve.
struct Owner {
  std::vector<Segment> segments;
  std::string_view colour;
};

Owner owner_of(const OrderLine& order, const Panel& panel, std::span<const std::vector<Segment>> curves,
               double aspect) {
  const double slope = order.order * aspect;
  const double tolerance = 0.35 * aspect;
  double best_length = 0;
  std::vector<Match> similar;
  for (std::size_t index = 0; index < curves.size(); ++index) {
    const Series& series = panel.series[index];
    if (!order.near.empty() && series.label != order.near) continue;
    std::vector<Segment> found = matching(curves[index], slope, tolerance);
    if (found.empty()) continue;
    best_length = std::max(best_length, horizontal_length(found));
    similar.push_back({&series, std::move(found)});
  }
  std::erase_if(similar,
                [&](const Match& match) { return horizontal_length(match.segments) < 0.5 * best_length; });
  // The second variants step back where a first one has the slope.
  if (std::ranges::any_of(similar, [](const Match& match) { return !match.series->secondary; })) {
    std::erase_if(similar, [](const Match& match) { return match.series->secondary; });
  }
  const auto lowest = std::ranges::min_element(
      similar, {}, [&](const Match& match) { return offset_of(match.segments, slope); });
  if (lowest == similar.end()) return {{}, shared_colour};
  return {lowest->segments, similar.size() == 1 ? colour_of(*lowest->series) : shared_colour};
}

/// Close to `own`, or anywhere if that is empty.
std::optional<Candidate> best_place(double slope, double label_width, std::span<const Segment> own,
                                    std::span<const Segment> obstacles, PlotArea area) {
  constexpr double horizon = 60;
  constexpr double free_distance = 4;
  constexpr double rim = 4;
  const bool anywhere = own.empty();
  const std::vector<Point> anchors = anywhere ? grid(area) : sampled(own);
  // Perpendicular to the slope.
  const double length = std::hypot(1.0, slope);

  double best_cost = std::numeric_limits<double>::infinity();
  std::optional<Candidate> best;
  const auto try_at = [&](const Candidate& candidate, double cost) {
    const Box box = candidate.bounds();
    if (box.left < rim || box.lower < rim || box.right > area.width - rim || box.upper > area.height - rim) {
      return;
    }
    const double clear = clearance(candidate, obstacles, horizon);
    if (clear < free_distance) return;
    // Room on all sides is worth a little; beside a foreign curve the triangle would seem to belong to that
    // one.
    cost += (anywhere ? -2 : -0.3) * std::min(clear, 20.0);
    if (!anywhere) {
      const double to_own = clearance(candidate, own, horizon);
      if (clear < to_own - 1) cost += 30 + 4 * (to_own - clear);
    }
    if (cost < best_cost) {
      best_cost = cost;
      best = candidate;
    }
  };

  for (const double wanted : {32.0, 25.0, 18.0}) {
    const double width = std::min(wanted, 1.3 * wanted / std::abs(slope));
    for (const Point& anchor : anchors) {
      for (const bool under : {true, false}) {
        for (const double gap : {7.0, 9.0, 12.0, 16.0, 22.0, 30.0, 42.0, 60.0}) {
          const double cost = gap + 1.2 * (32 - wanted) + (under ? 0 : 8);
          // Room is worth 40 at most.
          if (cost >= best_cost + 40) continue;
          const double sign = under == (slope > 0) ? 1 : -1;
          const Point middle{anchor.x + sign * gap * std::abs(slope) / length,
                             anchor.y + (under ? -1 : 1) * gap / length};
          try_at(candidate_at(middle, width, slope, under, label_width), cost);
        }
      }
    }
  }
  return best;
}

}  // namespace

std::vector<SlopeTriangle> place_orders(const Panel& panel, Range x, Range y, PlotArea area) {
  if (!panel.log_x || !panel.log_y || panel.orders.empty()) return {};
  const Axes axes{{x, true, area.width}, {y, true, area.height}};
  const double aspect = axes.y.points_per_unit() / axes.x.points_per_unit();

  std::vector<std::vector<Segment>> curves;
  std::vector<Segment> obstacles;
  for (const Series& series : panel.series) {
    curves.push_back(pieces(series, axes));
    obstacles.insert(obstacles.end(), curves.back().begin(), curves.back().end());
  }
  for (const FailureMark& mark : failure_marks(panel, axes.x)) {
    const double across = axes.x.position(mark.x);
    const double up = mark.position(area.height);
    obstacles.push_back({{across - 3, up}, {across + 3, up}});
  }

  std::vector<SlopeTriangle> result;
  for (const OrderLine& order : panel.orders) {
    if (order.order == 0) continue;
    const Owner owner = owner_of(order, panel, curves, aspect);
    const std::string text = text_of(order);
    const double width = std::max(12.0, text_width(text) * order_font_size / font_size);
    const std::optional<Candidate> best =
        best_place(order.order * aspect, width, owner.segments, obstacles, area);
    if (!best) continue;

    const auto data = [&](const Point& point) { return Point{axes.x.value(point.x), axes.y.value(point.y)}; };
    result.push_back({order.order, data(best->start), data(best->end), data(best->corner),
                      data(best->text_at), text, std::string(owner.colour)});
    for (const Segment& edge : best->edges()) obstacles.push_back(edge);
  }
  return result;
}

}  // namespace liebench
