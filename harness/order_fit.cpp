#include "harness/order_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstddef>
#include <functional>
#include <type_traits>
#include <utility>
#include <vector>

#include "harness/median.h"

namespace liebench {
namespace {

constexpr double reference_margin = 30;
constexpr double floor_margin = 30;
constexpr double strict_tolerance = 0.05;
constexpr double loose_tolerance = 0.15;
constexpr double least_slope = 0.5;
constexpr double dip_factor = 0.9;
constexpr double secant_factor = 1.5;
constexpr double span_factor = 2.5;
constexpr std::size_t points_per_dip = 5;
constexpr double loss_scale = 0.05;
constexpr std::size_t most_points = 32;
constexpr double fit_tolerance = 1e-12;
constexpr int most_passes = 1000;

struct LogPoint {
  double x;  // log h
  double y;  // log e
  double h;
};

using LogPoints = std::span<const LogPoint>;

double slope_between(const LogPoint& a, const LogPoint& b) {
  return (b.y - a.y) / (b.x - a.x);
}

// Theil-Sen: the median of the slopes of all pairs; a quarter of the points may be arbitrarily wrong.
double median_slope(LogPoints points) {
  std::vector<double> slopes;
  slopes.reserve(points.size() * (points.size() - 1) / 2);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) slopes.push_back(slope_between(points[i], points[j]));
  }
  return median(std::move(slopes));
}

// median_slope of the windows of a curve. That of a longer window comes from the sorted slopes of the shorter one.
class WindowSlopes {
 public:
  explicit WindowSlopes(LogPoints points) : points_(points), medians_(points.size()) {}

  // Of `count` points, at least two, from index `first` on.
  double operator()(std::size_t first, std::size_t count) {
    std::vector<double>& medians = medians_[first];
    if (medians.empty()) medians = from(first);
    return medians[count - 2];
  }

 private:
  // For all counts from two on.
  std::vector<double> from(std::size_t first) const {
    std::vector<double> medians, sorted, added, merged;
    for (std::size_t last = first + 1; last < points_.size(); ++last) {
      added.clear();
      for (std::size_t i = first; i < last; ++i) added.push_back(slope_between(points_[i], points_[last]));
      std::ranges::sort(added);
      merged.resize(sorted.size() + added.size());
      std::ranges::merge(sorted, added, merged.begin());
      sorted.swap(merged);
      const std::size_t middle = sorted.size() / 2;
      medians.push_back(sorted.size() % 2 == 1 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2);
    }
    return medians;
  }

  LogPoints points_;
  std::vector<std::vector<double>> medians_;  // by the first point
};

struct Window {
  std::size_t first = 0;  // index of the smallest step size
  std::size_t count = 0;
  double slope = 0;              // median slope
  std::vector<LogPoint> on_law;  // the points that are no dips
  double tolerance = 0;
};

// The points of `candidate` that are no dips below the law y = offset + slope x, or nothing where the dips
// are at an end, adjacent, or too many.
std::optional<std::vector<LogPoint>> without_dips(LogPoints candidate, double slope) {
  std::vector<double> offsets;
  for (const LogPoint& point : candidate) offsets.push_back(point.y - slope * point.x);
  const double threshold = median(offsets) + std::log(dip_factor);
  std::vector<LogPoint> kept;
  bool previous_is_dip = true;  // so that a dip at the first place counts as adjacent
  for (std::size_t i = 0; i < candidate.size(); ++i) {
    const bool is_dip = offsets[i] < threshold;
    if (is_dip && (previous_is_dip || i + 1 == candidate.size())) return std::nullopt;
    if (!is_dip) kept.push_back(candidate[i]);
    previous_is_dip = is_dip;
  }
  if (points_per_dip * (candidate.size() - kept.size()) > candidate.size()) return std::nullopt;
  return kept;
}

// The slope from each point to the nearest one at larger h that is at least secant_factor away, in ascending
// h.
std::vector<double> secants(LogPoints points) {
  std::vector<double> slopes;
  std::size_t above = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    while (above < points.size() && points[above].x - points[i].x < std::log(secant_factor)) ++above;
    if (above < points.size()) {
      slopes.push_back(slope_between(points[i], points[above]));
    } else if (i + 1 == points.size()) {
      // The last point is nobody's nearest where another lies just below it.
      std::size_t below = i;
      while (below > 0 && points[i].x - points[below].x < std::log(secant_factor)) --below;
      slopes.push_back(slope_between(points[below], points[i]));
    }
  }
  return slopes;
}

bool secants_agree(LogPoints points, double slope, double tolerance) {
  return std::ranges::all_of(secants(points), [&](double s) { return std::abs(s - slope) <= tolerance; });
}

// Rule 2 for `count` points from index `first` on.
std::optional<Window> one_power_law(LogPoints points, WindowSlopes& slopes, std::size_t first,
                                    std::size_t count, double tolerance) {
  const LogPoints candidate = points.subspan(first, count);
  if (candidate.back().x - candidate.front().x < std::log(span_factor)) return std::nullopt;
  const double slope = slopes(first, count);
  if (slope < least_slope) return std::nullopt;
  auto kept = without_dips(candidate, slope);
  if (!kept || !secants_agree(*kept, slope, tolerance)) return std::nullopt;
  return Window{first, count, slope, std::move(*kept), tolerance};
}

// Rule 3: the window with the smallest step sizes: the longest, or with the loose tolerance the shortest.
std::optional<Window> smallest_window(LogPoints points, WindowSlopes& slopes, double tolerance) {
  const bool loose = tolerance > strict_tolerance;
  for (std::size_t first = 0; first + 3 <= points.size(); ++first) {
    const std::size_t available = points.size() - first;
    std::optional<Window> found;
    if (available < 4 && loose) break;
    for (std::size_t count = std::min<std::size_t>(available, 4); count <= available; ++count) {
      auto window = one_power_law(points, slopes, first, count, tolerance);
      if (!window) continue;
      found = std::move(window);
      if (loose) break;
    }
    if (found) return found;
  }
  return std::nullopt;
}

// Rule 4: the log of the level where the `tail_size` smallest step sizes stop falling, if they do.
std::optional<double> floor_level(LogPoints points, std::size_t tail_size) {
  const LogPoints tail = points.first(tail_size);
  // With one point in the tail its neighbour is the window's first: hence `points`.
  const bool end_is_flat = slope_between(points[0], points[1]) < least_slope;
  const bool tail_is_flat = tail_size >= 3 && median_slope(tail) < least_slope;
  if (!end_is_flat && !tail_is_flat) return std::nullopt;
  // Where the curve turns, not its highest point: round-off that grows as 1/h^2 says little of larger h.
  const auto lowest =
      static_cast<std::size_t>(std::ranges::min_element(tail, {}, &LogPoint::y) - tail.begin());
  std::vector<double> turn;
  for (std::size_t i = lowest + 1; i-- > 0 && turn.size() < 3;) turn.push_back(tail[i].y);
  const double level = median(std::move(turn));
  for (std::size_t i = lowest + 1; i < tail_size; ++i) {
    if (tail[i].y > level + std::log(floor_margin)) return std::nullopt;
  }
  return level;
}

// Student's t for 68.27 %.
double student(double freedom) {
  // In double, not by way of long double, which valgrind does not have.
  namespace policies = boost::math::policies;
  using StudentsT =
      boost::math::students_t_distribution<double, policies::policy<policies::promote_double<false>>>;
  return boost::math::quantile(StudentsT(freedom), 0.5 + 0.6827 / 2);
}

std::optional<OrderEstimate> fit(LogPoints points, const Window& window) {
  const LogPoints used = points.subspan(window.first, window.count);
  // About the window's middle the two parameters are uncorrelated and the problem is well conditioned.
  const double x_middle = (used.front().x + used.back().x) / 2;
  double offset = window.on_law.front().y + window.slope * (x_middle - window.on_law.front().x);
  double slope = window.slope;

  // Iteratively reweighted least squares with the weights of Cauchy's loss, from the window's law: each pass lowers the loss.
  // (A general solver takes a hundred times longer, and a table of many records asks for 10^5 fits; a test compares with
  // Ceres.)
  double slope_variance = 0, weighted_squares = 0;
  bool converged = false;
  for (int pass = 0; pass < most_passes && !converged; ++pass) {
    double w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0;
    weighted_squares = 0;
    for (const LogPoint& point : used) {
      const double x = point.x - x_middle, residual = offset + slope * x - point.y;
      const double scaled = residual / loss_scale, weight = 1 / (1 + scaled * scaled);
      w += weight;
      wx += weight * x;
      wy += weight * point.y;
      wxx += weight * x * x;
      wxy += weight * x * point.y;
      weighted_squares += weight * residual * residual;
    }
    const double determinant = w * wxx - wx * wx;
    if (!(determinant > 0)) return std::nullopt;
    const double next_slope = (w * wxy - wx * wy) / determinant, next_offset = (wy - next_slope * wx) / w;
    converged = std::abs(next_slope - slope) <= fit_tolerance * std::abs(slope) &&
                std::abs(next_offset - offset) <= fit_tolerance * (1 + std::abs(offset));
    slope = next_slope;
    offset = next_offset;
    slope_variance = w / determinant;
  }
  if (!converged) return std::nullopt;

  const auto freedom = static_cast<double>(window.on_law.size() - 2);

  const auto slopes = secants(window.on_law);
  const bool monotone = std::ranges::is_sorted(slopes) || std::ranges::is_sorted(slopes, std::greater{});

  OrderEstimate estimate;
  estimate.order = slope;
  estimate.constant = std::exp(offset - slope * x_middle);
  estimate.fit_uncertainty = student(freedom) * std::sqrt(weighted_squares / freedom * slope_variance);
  estimate.end_slope = slopes.front();
  estimate.uncertainty = std::hypot(estimate.fit_uncertainty, estimate.end_slope - slope);
  estimate.h_min = used.front().h;
  estimate.h_max = used.back().h;
  estimate.points = static_cast<int>(used.size());
  estimate.dips = static_cast<int>(used.size() - window.on_law.size());
  estimate.slope_tolerance = window.tolerance;
  estimate.still_changing = monotone && window.tolerance > strict_tolerance;
  return estimate;
}

// At most most_points of a curve: those next to equidistant places in log h, both ends among them. The search for a window
// grows with their fourth power.
std::vector<LogPoint> thinned(std::vector<LogPoint> points) {
  if (points.size() <= most_points) return points;
  std::vector<LogPoint> kept;
  const double spacing = (points.back().x - points.front().x) / double(most_points - 1);
  std::size_t next = 0;
  for (std::size_t i = 0; i < most_points; ++i) {
    const double place = points.front().x + double(i) * spacing;
    while (next + 1 < points.size() &&
           std::abs(points[next + 1].x - place) <= std::abs(points[next].x - place))
      ++next;
    if (kept.empty() || kept.back().x < points[next].x) kept.push_back(points[next]);
  }
  return kept;
}

OrderFit absent(OrderOutcome outcome, std::string reason) {
  return {.outcome = outcome, .reason = std::move(reason), .estimate = {}, .floor = {}};
}

std::string slopes_at_small_end(LogPoints points) {
  std::string text;
  for (std::size_t i = 0; i + 1 < points.size() && i < 4; ++i) {
    text += fmt::format("{}{:.2f}", i == 0 ? "" : ", ", slope_between(points[i], points[i + 1]));
  }
  return text;
}

OrderFit without_window(LogPoints points) {
  if (median_slope(points) < least_slope && slope_between(points[0], points[1]) < least_slope) {
    return absent(
        OrderOutcome::not_falling,
        fmt::format("the error does not fall with the step size: the median slope of {} points is {:.2f}",
                    points.size(), median_slope(points)));
  }
  return absent(
      OrderOutcome::no_power_law,
      fmt::format("the smallest step sizes follow no single power law: slopes {} from h = {:.3g} upwards",
                  slopes_at_small_end(points), points.front().h));
}

// Rule 1, by rising h: fills `usable`, or says why there are too few.
std::optional<OrderFit> choose_points(std::span<const ErrorPoint> points, double reference_error,
                                      std::vector<LogPoint>& usable) {
  std::size_t below_reference = 0;
  for (const ErrorPoint& point : points) {
    if (!(point.step_size > 0 && std::isfinite(point.step_size))) continue;
    if (!(point.error > 0 && std::isfinite(point.error))) continue;
    // Negated so that a reference of unknown quality (NaN) supports no point.
    if (!(point.error >= reference_margin * reference_error)) {
      ++below_reference;
      continue;
    }
    usable.push_back({std::log(point.step_size), std::log(point.error), point.step_size});
  }
  if (usable.size() < 3) {
    if (usable.size() + below_reference < 3) {
      return absent(
          OrderOutcome::too_few_points,
          fmt::format("three points are needed: {} given, {} of them with a finite error above zero",
                      points.size(), usable.size() + below_reference));
    }
    return absent(
        OrderOutcome::below_reference,
        fmt::format("three points are needed: only {} of {} lie above {} times the reference's error {:.2g}",
                    usable.size(), usable.size() + below_reference, reference_margin, reference_error));
  }
  std::ranges::sort(usable, {}, &LogPoint::x);
  const auto repeated = std::ranges::adjacent_find(usable, {}, &LogPoint::x);
  if (repeated != usable.end()) {
    return absent(OrderOutcome::repeated_step_size,
                  fmt::format("two points have the step size {:.6g}", repeated->h));
  }
  return std::nullopt;
}

// log e = log C + p log h by least squares, with Student's t times the standard deviation of p.
struct Line {
  double slope, offset, uncertainty;
};
Line line_through(LogPoints points) {
  const auto n = double(points.size());
  double x = 0, y = 0, xx = 0, xy = 0, rest = 0;
  for (const LogPoint& p : points) {
    x += p.x / n;
    y += p.y / n;
  }
  for (const LogPoint& p : points) {
    xx += (p.x - x) * (p.x - x);
    xy += (p.x - x) * (p.y - y);
  }
  const double slope = xy / xx;
  for (const LogPoint& p : points) rest += std::pow(p.y - y - slope * (p.x - x), 2);
  return {slope, y - slope * x, student(n - 2) * std::sqrt(rest / (n - 2) / xx)};
}

}  // namespace

std::string_view name(OrderOutcome outcome) {
  constexpr std::array<std::string_view, 7> names{"estimated",   "too_few_points", "below_reference",
                                                  "not_falling", "no_power_law",   "repeated_step_size",
                                                  "fit_failed"};
  return names.at(static_cast<std::size_t>(outcome));
}

OrderFit fit_order(std::span<const ErrorPoint> points, double reference_error) {
  std::vector<LogPoint> usable;
  if (auto none = choose_points(points, reference_error, usable)) return *none;
  usable = thinned(std::move(usable));

  WindowSlopes slopes(usable);
  for (const double tolerance : {strict_tolerance, loose_tolerance}) {
    const auto window = smallest_window(usable, slopes, tolerance);
    if (!window) continue;
    const auto level = window->first == 0 ? std::nullopt : floor_level(usable, window->first);
    if (window->first > 0 && !level) continue;
    auto estimate = fit(usable, *window);
    if (!estimate) return absent(OrderOutcome::fit_failed, "the least-squares fit of the window failed");
    OrderFit result{.outcome = OrderOutcome::estimated, .reason = {}, .estimate = estimate, .floor = {}};
    if (level) result.floor = std::exp(*level);
    return result;
  }
  return without_window(usable);
}

OrderFit fit_scattered(std::span<const ErrorPoint> points, double reference_error) {
  std::vector<LogPoint> usable;
  if (auto none = choose_points(points, reference_error, usable)) return *none;
  if (usable.size() < 5)
    return absent(OrderOutcome::too_few_points,
                  fmt::format("five points are needed of a curve that scatters: {} given", usable.size()));
  const Line line = line_through(usable);
  if (line.slope < least_slope)
    return absent(OrderOutcome::not_falling,
                  fmt::format("the error does not fall with the tolerance: the slope of {} points is {:.2f}",
                              usable.size(), line.slope));
  const Line end = line_through(LogPoints(usable).first(usable.size() / 2 + 1));
  OrderEstimate estimate;
  estimate.order = line.slope;
  estimate.constant = std::exp(line.offset);
  estimate.fit_uncertainty = line.uncertainty;
  estimate.end_slope = end.slope;
  estimate.uncertainty = std::hypot(line.uncertainty, end.slope - line.slope);
  estimate.h_min = usable.front().h;
  estimate.h_max = usable.back().h;
  estimate.points = static_cast<int>(usable.size());
  return {.outcome = OrderOutcome::estimated, .reason = {}, .estimate = estimate, .floor = {}};
}

}  // namespace liebench
