#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

// The observed order of convergence of one curve, error e against step size h.
//
// The window rule, the same for every method, quantity and precision:
//
//   1. A point counts if h and e are finite and positive and e is at least 30 times the error estimate of
//      the reference. Of more than 32 such points those count that are next to 32 equidistant places in log h.
//   2. Points follow one power law if every secant slope of log e over log h lies within 0.05 of their
//      median slope. Points more than 10 % below the law (an error that changes sign) are left out of the
//      secants: none at an end, no two in a row, at most one in five. A law falls at least as h^(1/2); a
//      window spans a factor of 2.5 in h.
//   3. The window starts at the smallest h from which four points follow one law (three, where there are
//      no more), and takes as many larger h as the same law describes. Where that gives no window, the
//      shortest one of at least four points that meets 0.15.
//   4. Points at smaller h than the window must be a round-off floor: they no longer fall (slope below
//      1/2 between the last two, or as the median of three or more), and none before their lowest is more
//      than 30 times the level there. If they do fall, the order is still changing where it matters, and
//      there is no estimate.
//
// So a clean curve keeps its smallest step sizes, a curve in double precision loses its flat or rising
// branch, and a loss of order that shows at small h only is reported as what the small h say, or not at all,
// never averaged away.
//
// A secant spans the next point that is at least a factor 1.5 away, so that the rule means the same for dense
// and coarse curves. The rule is made for curves whose scatter is a few per cent; it gives no order for a
// scattered cloud.

namespace liebench {

// One run's step size [s] and its error against the reference, in any one norm and unit. An error that is not
// a positive finite number (a failed run) is left out by rule 1.
struct ErrorPoint {
  double step_size = 0;
  double error = 0;
};

// Why there is an order, or none.
enum class OrderOutcome {
  estimated,           // OrderFit::estimate holds a value
  too_few_points,      // fewer than three usable points were given
  below_reference,     // fewer than three lie above 30 times the reference's error estimate
  not_falling,         // the error does not fall as the step size shrinks, anywhere
  no_power_law,        // it falls, but not by one power law where the step size is smallest
  repeated_step_size,  // two usable points have the same step size: not one curve
  fit_failed           // the least-squares solver or its covariance failed
};

// The enumerator's name, as it stands in a table.
std::string_view name(OrderOutcome outcome);

// The power law e = C h^p of the window, fitted to log e = log C + p log h by least squares with a Cauchy
// loss of scale 0.05 (a point 5 % off the law has half its weight).
struct OrderEstimate {
  double order = 0;     // p
  double constant = 0;  // C, in units of the error per [s^p]

  // Standard uncertainty of p: sqrt(fit_uncertainty^2 + (end_slope - order)^2). The first term is scatter;
  // the second is how far the slope still moves inside the window. On a curve C h^p (1 + c h) twice this
  // covers the distance to p; no number taken from a window can know of a loss of order below it.
  double uncertainty = 0;

  // Half-width of the 68.27 % confidence interval of p from scatter alone: sqrt of the covariance of p
  // times the residual standard deviation with n - 2 degrees of freedom (dips not
  // counted) times Student's t for these degrees of freedom: 1.84 for three points, 1.32 for four, 1 for
  // many.
  double fit_uncertainty = 0;

  double end_slope = 0;  // the secant at the window's smallest step size
  double h_min = 0;      // [s] the window, both ends included
  double h_max = 0;
  int points = 0;              // in the window, dips included
  int dips = 0;                // of these, more than 10 % below the law
  double slope_tolerance = 0;  // 0.05, or 0.15 where nothing met 0.05

  // The secants met 0.15 only, and rise or fall throughout: rather a drift than scatter. The order for h -> 0
  // then lies beyond end_slope, and smaller step sizes are needed to see it.
  bool still_changing = false;
};

struct OrderFit {
  OrderOutcome outcome = OrderOutcome::too_few_points;
  std::string reason;                     // one sentence; empty where there is an estimate
  std::optional<OrderEstimate> estimate;  // present exactly where outcome is `estimated`

  // The error at which the curve stopped falling, if it did below the window. A level far above round-off
  // says that the method does not converge to this reference, whatever the order.
  std::optional<double> floor;
};

// The observed order of the curve `points`, in any sequence, by the window rule above. `reference_error` is
// the error estimate of the reference in the unit and norm of the errors, 0 where it is exact; a known bound
// on round-off may stand in its place. Never throws on data: whatever is wrong with a curve is an outcome.
OrderFit fit_order(std::span<const ErrorPoint> points, double reference_error = 0);

// The power law through all points of a curve that scatters: that of a method that chooses its steps, whose safety factors and
// changes of step make some per cent up to a half of its errors. Least squares of log e over log h, without a window; `uncertainty` as
// above, with the slope of the half at small h in the place of the secant there. Rule 1 says which points count, and five are needed;
// an error whose slope is below 1/2 does not fall.
OrderFit fit_scattered(std::span<const ErrorPoint> points, double reference_error = 0);

}  // namespace liebench
