#include "plots/slope_triangles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/plots/convergence_figure.h"

namespace liebench {
namespace {

struct Placement : testing::Test {
  static constexpr PlotArea area{204, 172};
  static constexpr Range x{5e-7, 2e-1};
  static constexpr Range y{1e-24, 1e2};

  static Point in_points(const Point& point) {
    return {std::log10(point.x / x.lower) / std::log10(x.upper / x.lower) * area.width,
            std::log10(point.y / y.lower) / std::log10(y.upper / y.lower) * area.height};
  }
  static double side(const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  }
};

TEST_F(Placement, TrianglesHaveTheirSlope) {
  const std::vector<SlopeTriangle> triangles = place_orders(convergence_panel(), x, y, area);
  ASSERT_EQ(triangles.size(), 3U);
  for (const SlopeTriangle& triangle : triangles) {
    // Log10 of values of 1e-24 ... 1e2 carries 26 eps, and the way there and back some more.
    EXPECT_NEAR(std::log(triangle.end.y / triangle.start.y) / std::log(triangle.end.x / triangle.start.x),
                triangle.order, 1e-11);
    EXPECT_EQ(triangle.text, "h^{" + std::to_string(triangle.order) + "}");
  }
}

TEST_F(Placement, TrianglesAndTheirTextsCoverNoData) {
  const Panel panel = convergence_panel();
  for (const SlopeTriangle& triangle : place_orders(panel, x, y, area)) {
    const Point a = in_points(triangle.start);
    const Point b = in_points(triangle.end);
    const Point c = in_points(triangle.corner);
    const Point text = in_points(triangle.text_at);
    for (const Series& series : panel.series) {
      for (std::size_t index = 1; index < series.points.size(); ++index) {
        const Point from = in_points(series.points[index - 1]);
        const Point to = in_points(series.points[index]);
        for (int part = 0; part <= 50; ++part) {
          const double t = part / 50.0;
          const Point data{from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)};
          const bool left = side(a, b, data) > 0 && side(b, c, data) > 0 && side(c, a, data) > 0;
          const bool right = side(a, b, data) < 0 && side(b, c, data) < 0 && side(c, a, data) < 0;
          EXPECT_FALSE(left || right) << "order " << triangle.order;
          EXPECT_FALSE(std::abs(data.x - text.x) < 6 && std::abs(data.y - text.y) < 6)
              << "text of order " << triangle.order;
        }
      }
    }
  }
}

TEST_F(Placement, TriangleWearsTheColourOfTheOnlyCurveOfItsSlope) {
  Panel panel = convergence_panel();
  panel.orders = {{.order = 3}};
  const std::string alone = place_orders(panel, x, y, area).at(0).colour;
  panel.series.push_back(power_law("other", 4, 1e-3, 3));
  const std::string shared = place_orders(panel, x, y, area).at(0).colour;
  EXPECT_EQ(alone, "#0072B2");
  EXPECT_NE(shared, alone);
  panel.orders[0].near = "k = 3";
  EXPECT_EQ(place_orders(panel, x, y, area).at(0).colour, alone);
}

TEST_F(Placement, FallingSlopesAreTrianglesToo) {
  Panel panel;
  panel.series = {power_law("work", 0, 1e-12, -1)};
  panel.orders = {{.order = -1, .text = "order 1"}};
  const std::vector<SlopeTriangle> triangles = place_orders(panel, x, y, area);
  ASSERT_EQ(triangles.size(), 1U);
  EXPECT_LT(triangles[0].end.y, triangles[0].start.y);
  EXPECT_EQ(triangles[0].text, "order 1");
}

}  // namespace
}  // namespace liebench
