#include "harness/order_fit.h"

#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <type_traits>
#include <utility>
#include <vector>

namespace liebench {
namespace {

using Points = std::vector<ErrorPoint>;

const double quarter_decade = std::pow(10, 0.25);

// e(h) at `count` step sizes from h_max down by `ratio`.
Points curve(double h_max, double ratio, int count, const std::function<double(double)>& error) {
  Points points;
  for (int i = 0; i < count; ++i) {
    const double h = h_max * std::pow(ratio, -i);
    points.push_back({h, error(h)});
  }
  return points;
}

void expect_absent(const OrderFit& fit, OrderOutcome outcome) {
  EXPECT_EQ(name(fit.outcome), name(outcome));
  EXPECT_FALSE(fit.estimate.has_value());
  EXPECT_FALSE(fit.reason.empty());
}

TEST(OrderFit, ReturnsOrderAndConstantOfAnExactPowerLaw) {
  const OrderFit fit = fit_order(curve(1e-2, 2, 8, [](double h) { return 7 * h * h * h; }));
  ASSERT_TRUE(fit.estimate.has_value()) << fit.reason;
  EXPECT_EQ(fit.outcome, OrderOutcome::estimated);
  EXPECT_TRUE(fit.reason.empty());
  EXPECT_NEAR(fit.estimate->order, 3, 1e-9);
  // The constant extrapolates over log(1/h) ~ 7 from the window: the slope's error comes with that factor.
  EXPECT_NEAR(fit.estimate->constant, 7, 1e-7);
  EXPECT_LT(fit.estimate->uncertainty, 1e-9);
  EXPECT_EQ(fit.estimate->points, 8);
  EXPECT_EQ(fit.estimate->dips, 0);
  EXPECT_EQ(fit.estimate->h_max, 1e-2);
  EXPECT_EQ(fit.estimate->h_min, 1e-2 * std::pow(2, -7));
  EXPECT_FALSE(fit.floor.has_value());
}

TEST(OrderFit, DoesNotDependOnTheSequenceOfThePoints) {
  const Points points = curve(1e-2, 2, 8, [](double h) { return h * h * (1 + 30 * h); });
  const Points reversed(points.rbegin(), points.rend());
  EXPECT_EQ(fit_order(points).estimate.value().order, fit_order(reversed).estimate.value().order);
}

// A 68.27 % interval must cover p at least that often; it covers more often, because the uncertainty counts
// the scatter of the end slope as drift.
TEST(OrderFit, UncertaintyCoversTheOrderOfANoisyPowerLaw) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (const int count : {4, 6, 12}) {
    int covered = 0;
    double mean = 0;
    const int curves = 300;
    for (int i = 0; i < curves; ++i) {
      const auto noisy = [&](double h) { return 5 * h * h * h * std::exp(0.01 * normal(random)); };
      const OrderFit fit = fit_order(curve(1e-2, 2, count, noisy));
      ASSERT_TRUE(fit.estimate.has_value()) << fit.reason;
      // Slopes of 1 % noise over a factor 8 in h scatter by 0.007.
      EXPECT_NEAR(fit.estimate->order, 3, 0.04);
      EXPECT_GE(fit.estimate->uncertainty, fit.estimate->fit_uncertainty);
      EXPECT_LT(fit.estimate->uncertainty, 0.1);
      if (std::abs(fit.estimate->order - 3) < fit.estimate->uncertainty) ++covered;
      mean += fit.estimate->order / curves;
    }
    EXPECT_GT(covered, 0.68 * curves) << count << " points";
    EXPECT_NEAR(mean, 3, 0.002);
  }
}

// Three points leave one degree of freedom. Slopes 2 - d and 2 + d over equal steps L in log h: the residuals
// are (1, -2, 1) d L / 3, s = d L sqrt(2/3), sigma_p = s / (L sqrt(2)) = d / sqrt(3), and Student's factor
// is 1.837.
TEST(OrderFit, ThreePointsHaveStudentsUncertainty) {
  const double d = 0.01;
  const Points points{{1, 1}, {0.5, std::pow(2, -(2 + d))}, {0.25, std::pow(2, -4)}};
  const OrderFit fit = fit_order(points);
  ASSERT_TRUE(fit.estimate.has_value()) << fit.reason;
  EXPECT_NEAR(fit.estimate->order, 2, 1e-4);
  EXPECT_NEAR(fit.estimate->end_slope, 2 - d, 1e-12);
  // The robust loss takes residuals of 0.005 at a scale of 0.05 down by 1 %.
  EXPECT_NEAR(fit.estimate->fit_uncertainty, 1.837 * d / std::sqrt(3), 0.02 * d);
  EXPECT_NEAR(fit.estimate->uncertainty, std::hypot(fit.estimate->fit_uncertainty, d), 0.02 * d);
}

TEST(OrderFit, OfADenseCurveThirtyTwoPointsCountItsEndsAmongThem) {
  const double ratio = std::pow(10, 0.01);
  const OrderFit fit = fit_order(curve(1e-2, ratio, 301, [](double h) { return 7 * h * h * h; }));
  ASSERT_TRUE(fit.estimate.has_value()) << fit.reason;
  EXPECT_NEAR(fit.estimate->order, 3, 1e-9);
  EXPECT_EQ(fit.estimate->points, 32);
  EXPECT_EQ(fit.estimate->h_max, 1e-2);
  EXPECT_NEAR(fit.estimate->h_min, 1e-5, 1e-15);
}

struct CeresFit {
  double order, uncertainty;
};

// The same fit, all points in the window and none a dip, by Ceres: solver, robust loss and covariance.
CeresFit fit_by_ceres(const Points& points) {
  double offset = 0, slope = 2;
  ceres::Problem::Options ownership;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  constexpr double scale = 0.05;
  ceres::CauchyLoss loss(scale);
  for (const ErrorPoint& point : points) {
    const auto law = [x = std::log(point.step_size), y = std::log(point.error)](const auto* a, const auto* p,
                                                                                auto* residual) {
      *residual = *a + *p * x - y;
      return true;
    };
    using Cost = ceres::AutoDiffCostFunction<std::remove_const_t<decltype(law)>, 1, 1, 1>;
    problem.AddResidualBlock(new Cost(new auto(law)), &loss, &offset, &slope);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.function_tolerance = options.gradient_tolerance = options.parameter_tolerance = 1e-15;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  ceres::Covariance covariance({});
  const std::vector<std::pair<const double*, const double*>> blocks{{&slope, &slope}};
  double variance = 0, squares = 0;
  EXPECT_TRUE(covariance.Compute(blocks, &problem) &&
              covariance.GetCovarianceBlock(&slope, &slope, &variance));
  for (const ErrorPoint& point : points) {
    const double residual = offset + slope * std::log(point.step_size) - std::log(point.error);
    squares += residual * residual / (1 + residual * residual / (scale * scale));
  }
  const double freedom = double(points.size()) - 2;
  const double student =
      boost::math::quantile(boost::math::students_t_distribution<double>(freedom), 0.5 + 0.6827 / 2);
  return {slope, student * std::sqrt(squares / freedom * variance)};
}

TEST(OrderFit, IsTheFitOfCeres) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-0.02, 0.02);
  int compared = 0;
  for (int i = 0; i < 100; ++i) {
    const Points points =
        curve(1e-2, 2, 4 + i % 9, [&](double h) { return 5 * h * h * std::exp(uniform(random)); });
    const OrderFit fit = fit_order(points);
    if (!fit.estimate || std::size_t(fit.estimate->points) != points.size() || fit.estimate->dips > 0)
      continue;
    ++compared;
    const CeresFit expected = fit_by_ceres(points);
    EXPECT_NEAR(fit.estimate->order, expected.order, 1e-9);
    EXPECT_NEAR(fit.estimate->fit_uncertainty, expected.uncertainty, 1e-6 * expected.uncertainty);
  }
  EXPECT_GT(compared, 50);
}

TEST(OrderFit, LeavesThePreAsymptoticSideOut) {
  for (const double c : {10., 100., 1000.}) {
    const OrderFit fit =
        fit_order(curve(1e-2, quarter_decade, 13, [&](double h) { return h * h * (1 + c * h); }));
    ASSERT_TRUE(fit.estimate.has_value()) << fit.reason;
    EXPECT_NEAR(fit.estimate->order, 2, 2 * fit.estimate->uncertainty);
    EXPECT_NEAR(fit.estimate->order, 2, 0.05);
    EXPECT_NEAR(fit.estimate->h_min, 1e-5, 1e-12);
    // At the window's end the local slope is 2 + c h / (1 + c h).
    EXPECT_LT(c * fit.estimate->h_max, 0.2);
    EXPECT_FALSE(fit.estimate->still_changing);
  }
}

TEST(OrderFit, SaturatedErrorsAtLargeStepsAreNoFloor) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  const OrderFit fit = fit_order(curve(1, quarter_decade, 20, [&](double h) {
    return std::min(std::exp(0.3 * normal(random)), 1e6 * h * h * h);
  }));
  ASSERT_TRUE(fit.estimate.has_value()) << fit.reason;
  EXPECT_NEAR(fit.estimate->order, 3, 0.01);
  EXPECT_FALSE(fit.floor.has_value());
}

TEST(OrderFit, ALossOfOrderAtSmallStepsIsWhatItReports) {
  const OrderFit fit =
      fit_order(curve(1e-2, quarter_decade, 13, [](double h) { return h * h * h + 1e-3 * h * h; }));
  ASSERT_TRUE(fit.estimate.has_value()) << fit.reason;
  EXPECT_NEAR(fit.estimate->order, 2, 0.05);
  EXPECT_NEAR(fit.estimate->order, 2, 2 * fit.estimate->uncertainty);
}

// Where the crossover ends below the smallest step, no number is the order; a number for the window must
// carry the mark, lie below the mean slope of the curve, and have an end slope nearer to the limit.
TEST(OrderFit, AnUnfinishedLossOfOrderIsMarked) {
  for (const double c : {1e-4, 3e-5, 1e-5}) {
    const OrderFit fit =
        fit_order(curve(1e-2, quarter_decade, 13, [&](double h) { return h * h * h + c * h * h; }));
    ASSERT_TRUE(fit.estimate.has_value()) << fit.reason;
    EXPECT_TRUE(fit.estimate->still_changing);
    EXPECT_EQ(fit.estimate->points, 4);
    EXPECT_NEAR(fit.estimate->h_min, 1e-5, 1e-12);
    EXPECT_LT(fit.estimate->end_slope, fit.estimate->order - 0.05);
    EXPECT_GT(fit.estimate->uncertainty, 0.05);
  }
}

// One step size more and a slope of 2.5 after slopes of 4: round-off or order, nobody knows.
TEST(OrderFit, ALastSlopeThatDisagreesLeavesNoEstimate) {
  Points points = curve(1e-2, 2, 6, [](double h) { return std::pow(h, 4); });
  points.push_back({points.back().step_size / 2, points.back().error * std::pow(2, -2.5)});
  expect_absent(fit_order(points), OrderOutcome::no_power_law);
}

TEST(OrderFit, LeavesTheRoundOffBranchOut) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  int estimated = 0;
  int curves = 0;
  for (const double p : {3., 4.}) {
    for (const double rise : {0., 1., 2.}) {
      for (int i = 0; i < 50; ++i) {
        const Points points = curve(1e-2, quarter_decade, 17, [&](double h) {
          const double round_off = 1e-13 * std::pow(1e-4 / h, rise) * std::exp(0.5 * normal(random));
          return std::hypot(1e3 * std::pow(h, p), round_off);
        });
        const OrderFit fit = fit_order(points);
        ++curves;
        if (!fit.estimate) continue;
        ++estimated;
        EXPECT_NEAR(fit.estimate->order, p, 0.15);
        const double lowest = std::ranges::min(points, {}, &ErrorPoint::error).error;
        EXPECT_GT(fit.floor.value(), 0.99 * lowest);
        EXPECT_LT(*fit.floor, 30 * lowest);
        // A secant may lie 0.15 below the window's slope and that 0.15 below p: 0.3 over a quarter of a
        // decade is 19 %.
        for (const ErrorPoint& point : points) {
          if (point.step_size < fit.estimate->h_min) continue;
          EXPECT_LT(point.error, 1.2 * 1e3 * std::pow(point.step_size, p));
        }
      }
    }
  }
  EXPECT_GT(estimated, 0.9 * curves);
}

TEST(OrderFit, NamesTheLevelWhereACurveFlattens) {
  const OrderFit fit = fit_order(curve(0.1, 2, 10, [](double h) { return std::pow(h, 4) + 1e-10; }));
  ASSERT_TRUE(fit.estimate.has_value()) << fit.reason;
  EXPECT_NEAR(fit.estimate->order, 4, 0.05);
  EXPECT_NEAR(fit.floor.value(), 1e-10, 1e-11);
}

TEST(OrderFit, KeepsTheSmallestStepsOfACleanCurve) {
  const OrderFit fit =
      fit_order(curve(1e-2, quarter_decade, 17, [](double h) { return 40 * std::pow(h, 4); }), 1e-30);
  ASSERT_TRUE(fit.estimate.has_value()) << fit.reason;
  EXPECT_EQ(fit.estimate->points, 17);
}

TEST(OrderFit, LivesWithADipOfAnErrorThatChangesSign) {
  for (const double depth : {1e-6, 1e-2, 0.5, 0.85}) {
    for (std::size_t at = 1; at < 9; ++at) {
      Points points = curve(1e-2, 2, 10, [](double h) { return h * h * (1 + 5 * h); });
      points[at].error *= depth;
      const OrderFit fit = fit_order(points);
      ASSERT_TRUE(fit.estimate.has_value()) << fit.reason;
      EXPECT_NEAR(fit.estimate->order, 2, 0.02) << "depth " << depth << " at " << at;
      EXPECT_LT(fit.estimate->uncertainty, 0.03);
      EXPECT_FALSE(fit.floor.has_value());
    }
  }
}

// h^2 |h - h0|: third order above h0, second below.
TEST(OrderFit, ACuspBetweenTwoOrdersLeavesTheOneOfSmallSteps) {
  const auto cusp = [](double h0) {
    return curve(1e-2, quarter_decade, 13, [h0](double h) { return h * h * std::abs(h - h0); });
  };
  const OrderFit fit = fit_order(cusp(1e-3));
  ASSERT_TRUE(fit.estimate.has_value()) << fit.reason;
  EXPECT_NEAR(fit.estimate->order, 2, 0.05);
  // Here too few of the small steps are left: the third order above must not stand in for them.
  expect_absent(fit_order(cusp(2.1e-5)), OrderOutcome::no_power_law);
  expect_absent(fit_order(cusp(1.1e-5)), OrderOutcome::no_power_law);
}

TEST(OrderFit, IsTheSameForDenseAndCoarseCurves) {
  const auto law = [](double h) { return h * h * (1 + 100 * h); };
  const double coarse = fit_order(curve(1e-2, quarter_decade, 13, law)).estimate.value().order;
  const double dense = fit_order(curve(1e-2, std::pow(10, 0.05), 61, law)).estimate.value().order;
  EXPECT_NEAR(coarse, dense, 0.01);
}

TEST(OrderFit, LeavesOutWhatTheReferenceCannotJudge) {
  const auto law = [](double h) { return h * h + 1e-9; };
  const OrderFit fit = fit_order(curve(1e-2, 2, 14, law), 1e-8);
  ASSERT_TRUE(fit.estimate.has_value()) << fit.reason;
  EXPECT_GE(law(fit.estimate->h_min), 3e-7);
  EXPECT_NEAR(fit.estimate->order, 2, 0.02);
  expect_absent(fit_order(curve(1e-2, 2, 14, law), 1), OrderOutcome::below_reference);
  expect_absent(fit_order(curve(1e-2, 2, 14, law), std::numeric_limits<double>::quiet_NaN()),
                OrderOutcome::below_reference);
}

TEST(OrderFit, LeavesOutFailedRuns) {
  Points points = curve(1e-2, 2, 6, [](double h) { return h * h; });
  const double infinity = std::numeric_limits<double>::infinity();
  points.insert(points.begin(),
                {{0.1, std::numeric_limits<double>::quiet_NaN()}, {0.05, infinity}, {0.02, 0}});
  points.push_back({-1e-5, 1e-10});
  const OrderFit fit = fit_order(points);
  ASSERT_TRUE(fit.estimate.has_value()) << fit.reason;
  EXPECT_EQ(fit.estimate->points, 6);
}

TEST(OrderFit, WithoutEnoughPointsThereIsAReasonAndNoNumber) {
  expect_absent(fit_order({}), OrderOutcome::too_few_points);
  expect_absent(fit_order(Points{{0.1, 1e-2}, {0.05, 2.5e-3}}), OrderOutcome::too_few_points);
  expect_absent(fit_order(Points{{0.1, 1e-2}, {0.05, 2.5e-3}, {0.02, 0}}), OrderOutcome::too_few_points);
  EXPECT_EQ(fit_order(Points{{0.1, 1e-2}, {0.05, 2.5e-3}, {0.02, 0}}).reason,
            "three points are needed: 3 given, 2 of them with a finite error above zero");
}

TEST(OrderFit, TwoErrorsAtOneStepSizeAreNoCurve) {
  Points points = curve(1e-2, 2, 6, [](double h) { return h * h; });
  points.push_back(points.front());
  expect_absent(fit_order(points), OrderOutcome::repeated_step_size);
}

TEST(OrderFit, AnErrorThatDoesNotFallHasNoOrder) {
  expect_absent(fit_order(curve(1e-2, 2, 8, [](double) { return 1e-3; })), OrderOutcome::not_falling);
  expect_absent(fit_order(curve(1e-2, 2, 8, [](double h) { return 1e-14 / h; })), OrderOutcome::not_falling);
}

TEST(OrderOutcome, HasAName) {
  EXPECT_EQ(name(OrderOutcome::estimated), "estimated");
  EXPECT_EQ(name(OrderOutcome::no_power_law), "no_power_law");
  EXPECT_EQ(name(OrderOutcome::fit_failed), "fit_failed");
}

// e = h^3 times factors between 1 and 1.5 that follow no law, from 1e-4 on by 10^{1/8}.
std::vector<ErrorPoint> scattered(std::size_t count, double level = 0.0) {
  std::vector<ErrorPoint> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double h = 1e-4 * std::pow(10.0, double(i) / 8.0);
    const double factor = 1.0 + 0.5 * std::abs(std::sin(double(i * i)));
    points.push_back({h, std::pow(h, 3.0) * factor + level});
  }
  return points;
}

TEST(FitScattered, FindsTheOrderOfACloudThatFollowsNoSinglePowerLaw) {
  const std::vector<ErrorPoint> points = scattered(17);
  ASSERT_FALSE(fit_order(points).estimate && fit_order(points).estimate->points > 12);
  const OrderFit fit = fit_scattered(points);
  ASSERT_TRUE(fit.estimate);
  EXPECT_NEAR(fit.estimate->order, 3.0, 2.0 * fit.estimate->uncertainty);
  EXPECT_LE(fit.estimate->uncertainty, 0.1);
  EXPECT_EQ(fit.estimate->points, 17);
}

TEST(FitScattered, KnowsAnUncertaintyOfASlopeThatMoves) {
  // Order 3 above and 2 below: the middle is an estimate of neither.
  std::vector<ErrorPoint> points;
  for (const ErrorPoint& p : scattered(17))
    points.push_back({p.step_size, p.error + 1e-3 * p.step_size * p.step_size});
  const OrderFit fit = fit_scattered(points);
  ASSERT_TRUE(fit.estimate);
  EXPECT_LT(fit.estimate->order, 2.8);
  EXPECT_GE(fit.estimate->uncertainty, 0.2);
}

TEST(FitScattered, SaysWhatDoesNotFallAndAsksForFivePoints) {
  EXPECT_EQ(fit_scattered(scattered(17, 1.0)).outcome, OrderOutcome::not_falling);
  EXPECT_EQ(fit_scattered(scattered(4)).outcome, OrderOutcome::too_few_points);
  EXPECT_EQ(fit_scattered(scattered(17), 1.0).outcome, OrderOutcome::below_reference);
}

}  // namespace
}  // namespace liebench
