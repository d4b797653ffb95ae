#include "harness/correction_stability.h"

#include <gtest/gtest.h>

#include <cmath>

#include "harness/problems.h"
#include "harness/study.h"

namespace liebench {
namespace {

// For k = 3 by hand: z^3 + x/12 (3/2 z^2 - 2 z + 1/2) = 0 at x = 3.6034 i has a root of modulus 1.
TEST(CorrectionStability, BoundsAreThoseOfTheCharacteristicPolynomials) {
  // METHODS.md, section 4: 3.60 and 3.08 for the formulas of eq. (22).
  EXPECT_NEAR(correction_stability_bound(3, false), 3.60, 0.005);
  EXPECT_NEAR(correction_stability_bound(4, false), 3.08, 0.005);
  for (int k = 3; k <= 6; ++k)
    for (const bool implicit : {false, true}) {
      const double bound = correction_stability_bound(k, implicit);
      EXPECT_NEAR(correction_spectral_radius(k, implicit, bound), 1.0, 1e-6) << k << implicit;
      EXPECT_GT(correction_spectral_radius(k, implicit, 1.02 * bound), 1.0) << k << implicit;
      EXPECT_LT(correction_spectral_radius(k, implicit, 0.98 * bound), 1.0) << k << implicit;
    }
}

TEST(CorrectionStability, ASmallStepForgetsErrorsAtOnce) {
  for (int k = 3; k <= 6; ++k)
    for (const bool implicit : {false, true})
      EXPECT_LT(correction_spectral_radius(k, implicit, 1e-6), 0.2) << k << implicit;
}

TEST(CorrectionStability, ImplicitEvaluationReachesFurtherForFiveAndSixSteps) {
  for (const int k : {5, 6})
    EXPECT_GT(correction_stability_bound(k, true), 4 * correction_stability_bound(k, false)) << k;
}

// The constrained top with its |Omega| of 150 rad/s, over a number of steps in which the spectral radius at 1.15 times the
// bound makes 1e10 out of an error of eps. Returns the largest error of v, or infinity for a run that failed.
double largest_velocity_error(int k, bool implicit, double h_times_speed) {
  const double speed = std::hypot(150.0, 4.61538);
  Json json = parse_json(R"({"name": "blow-up", "problems": [{"name": "heavy_top", "formulation": "R3xSO3"}],
                             "integrators": [{"name": "bliedf2nd"}], "start": "reference", "steps": 1})",
                         "test");
  json["integrators"][0]["k"] = k;
  json["integrators"][0]["correction"] = implicit ? Json("implicit") : Json(true);
  json["step_sizes"] = {h_times_speed / speed};
  json["steps"] = 800;
  const RunSpec run = read_study(json).runs.at(0);
  static const auto problem = run.problem->prepare(run.parameters, 10.0, ReferenceCache(), {});
  const RunResult result = problem->run(run.formulation->name, run.precision, run.request);
  return result.v ? result.v->max_absolute : INFINITY;
}

TEST(CorrectionStability, MeasuredBlowUpsLieAtThePredictedBounds) {
  for (const int k : {5, 6})
    for (const bool implicit : {false, true}) {
      const double bound = correction_stability_bound(k, implicit);
      const double growth = correction_spectral_radius(k, implicit, 1.15 * bound);
      ASSERT_GT(800 * std::log10(growth), 12.0) << k << implicit;
      // Beyond the bound any error grows past the velocity itself; inside the method follows the motion. (At the bound of
      // the implicit one, h |v| ~ 1, the errors of the method itself are no longer small, as the linearisation takes them.)
      EXPECT_GT(largest_velocity_error(k, implicit, 1.15 * bound), 1e3) << k << implicit;
      EXPECT_LT(largest_velocity_error(k, implicit, (implicit ? 0.7 : 0.85) * bound), 50.0) << k << implicit;
    }
}

}  // namespace
}  // namespace liebench
