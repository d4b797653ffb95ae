#include "plots/contour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

namespace liebench {
namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

template <class Function>
Field sampled(int count, const Function& function) {
  Field field{{-2, 2}, {-2, 2}, count, count, {}};
  for (int j = 0; j < count; ++j)
    for (int i = 0; i < count; ++i)
      field.values.push_back(function(-2 + 4.0 * i / (count - 1), -2 + 4.0 * j / (count - 1)));
  return field;
}

std::size_t crossings(const Outline& outline) {
  return static_cast<std::size_t>(std::ranges::count(outline.crossing, true));
}

TEST(Contour, OfACircleLiesOnIt) {
  constexpr int count = 81;
  constexpr double step = 4.0 / (count - 1), radius = 1.3;
  const std::vector<Outline> lines =
      outlines(sampled(count, [](double x, double y) { return std::hypot(x, y); }), radius);
  ASSERT_EQ(lines.size(), 1);
  // Linear interpolation of a function with a second derivative of at most 1 / r, r > radius - step.
  for (const Point& point : lines[0].points)
    EXPECT_NEAR(std::hypot(point.x, point.y), radius, step * step / 8 / (radius - step));
  EXPECT_EQ(crossings(lines[0]), lines[0].points.size());
  EXPECT_NEAR(lines[0].signed_area(), std::numbers::pi * radius * radius, 4 * std::numbers::pi * step * step);
}

TEST(Contour, RunsAroundHolesTheOtherWay) {
  const std::vector<Outline> lines =
      outlines(sampled(101, [](double x, double y) { return std::abs(std::hypot(x, y) - 1); }), 0.5);
  ASSERT_EQ(lines.size(), 2);
  const auto [hole, outer] = std::minmax({lines[0].signed_area(), lines[1].signed_area()});
  EXPECT_NEAR(outer, std::numbers::pi * 2.25, 0.02);
  EXPECT_NEAR(hole, -std::numbers::pi * 0.25, 0.02);
}

TEST(Contour, FollowsTheEdgeOfTheGrid) {
  const std::vector<Outline> all = outlines(sampled(5, [](double, double) { return 0.0; }), 0.0);
  ASSERT_EQ(all.size(), 1);
  EXPECT_DOUBLE_EQ(all[0].signed_area(), 16);
  EXPECT_EQ(crossings(all[0]), 0);

  const std::vector<Outline> left = outlines(sampled(5, [](double x, double) { return x; }), 0.5);
  ASSERT_EQ(left.size(), 1);
  EXPECT_DOUBLE_EQ(left[0].signed_area(), 2.5 * 4);
  EXPECT_EQ(crossings(left[0]), 5);

  EXPECT_TRUE(outlines(sampled(5, [](double, double) { return 1.0; }), 0.0).empty());
}

TEST(Contour, OfASaddleIsDecidedByItsMean) {
  const auto count = [](double high) {
    return outlines({{0, 1}, {0, 1}, 2, 2, {-1, high, high, -1}}, 0.0).size();
  };
  EXPECT_EQ(count(0.9), 1);
  EXPECT_EQ(count(1.1), 2);
}

TEST(Contour, EndsBesideNodesWithoutAValue) {
  const std::vector<Outline> lines =
      outlines(sampled(5, [](double x, double y) { return x == 0 && y == 0 ? no_value : -1.0; }), 0.0);
  ASSERT_EQ(lines.size(), 2);
  // A diamond through the four neighbours of the node.
  EXPECT_DOUBLE_EQ(std::min(lines[0].signed_area(), lines[1].signed_area()), -2);
  EXPECT_EQ(crossings(lines[0]) + crossings(lines[1]), 0);
}

TEST(Contour, StaysFiniteBesidePolesAndZeros) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  for (const Outline& line : outlines({{0, 2}, {0, 1}, 3, 2, {-infinite, 1, -1, -1, infinite, -1}}, 0.0)) {
    for (const Point& point : line.points) {
      EXPECT_TRUE(point.x >= 0 && point.x <= 2) << point.x;
      EXPECT_TRUE(point.y >= 0 && point.y <= 1) << point.y;
    }
  }
}

TEST(Contour, CrossesEveryEdgeWhoseEndsDifferOnce) {
  constexpr int count = 30;
  std::mt19937 random(1);
  Field field{{0, count - 1}, {0, count - 1}, count, count, {}};
  for (int i = 0; i < count * count; ++i)
    field.values.push_back(random() % 8 == 0 ? no_value : double(random() % 1000) - 500.5);

  std::size_t expected = 0;
  const auto differ = [&](std::size_t a, std::size_t b) {
    return field.values[a] * field.values[b] < 0;  // false beside NaN
  };
  for (std::size_t j = 0; j < count; ++j)
    for (std::size_t i = 0; i < count; ++i)
      expected += std::size_t(i + 1 < count && differ(j * count + i, j * count + i + 1)) +
                  std::size_t(j + 1 < count && differ(j * count + i, j * count + i + count));

  std::size_t found = 0;
  for (const Outline& line : outlines(field, 0.0)) {
    found += crossings(line);
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      const Point &from = line.points[i], &to = line.points[(i + 1) % line.points.size()];
      // A square is 1 wide, at up to 29: a few roundings more.
      EXPECT_LE(std::max(std::abs(to.x - from.x), std::abs(to.y - from.y)), 1 + 1e-13) << "leaves its square";
    }
  }
  EXPECT_EQ(found, expected);
}

TEST(Contour, RefusesAFieldThatDoesNotFitItself) {
  EXPECT_THROW(outlines({{0, 1}, {0, 1}, 2, 2, {1, 2, 3}}, 0), std::invalid_argument);
  EXPECT_THROW(outlines({{0, 1}, {0, 1}, 1, 2, {1, 2}}, 0), std::invalid_argument);
  EXPECT_THROW(outlines({{0, 1}, {0, 1}, -2, -2, {1, 2, 3, 4}}, 0), std::invalid_argument);
  EXPECT_THROW(outlines({{1, 0}, {0, 1}, 2, 2, {1, 2, 3, 4}}, 0), std::invalid_argument);
  EXPECT_THROW(outlines({{0, no_value}, {0, 1}, 2, 2, {1, 2, 3, 4}}, 0), std::invalid_argument);
}

}  // namespace
}  // namespace liebench
