#include "harness/references/heavy_top_closed_form.h"

#include <gtest/gtest.h>

#include <array>

#include "harness/references/heavy_top_extrapolation.h"
#include "heavy_top_samples.h"

namespace liebench {
namespace {

// The extrapolation's local errors of 1e-35, over a few dozen steps and the growth of a regular motion; the
// closed form loses at most half of the 50 digits.
constexpr double agreement = 1e-32;

void expect_the_extrapolated(const HeavyTopParameters& p) {
  const auto closed_form = HeavyTopClosedForm::of(p);
  ASSERT_TRUE(closed_form);
  const std::array<double, 3> times{0.37, 0.9, 1.6};
  for (const HeavyTopWitness& witness : heavy_top_by_extrapolation(p, times)) {
    EXPECT_LT(difference(closed_form->at(witness.t), witness), agreement) << witness.t;
  }
}

TEST(HeavyTopClosedForm, GivesThePublishedStateOfTheFastTopAtTwoSeconds) {
  const auto closed_form = HeavyTopClosedForm::of(HeavyTopParameters{});
  ASSERT_TRUE(closed_form);
  const HeavyTopWitness s = closed_form->at(2);
  // docs/references.md and an independent computation in 60 digits.
  const std::array<std::array<const char*, 3>, 3> R{
      {{"-0.4874490822362657103411955", "-0.1504168227456417598100308", "0.8600977686647771186846381"},
       {"-0.5379397438441505933085279", "-0.7241655916368956507485544", "-0.4315148060983244312796755"},
       {"0.6877602956117137709979559", "-0.6730222695604440960502210", "0.2720786659328456273933258"}}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) expect_printed(s.R[i][j], R[i][j]);
  }
  expect_printed(s.omega[0], "0.1222332194973942367872815");
  expect_printed(s.omega[1], "150.0000000000000000000000000");
  expect_printed(s.omega[2], "-5.85562458920545772829141");
  EXPECT_NEAR(closed_form->nutation_period(), 0.7452069476167690557, 4e-16);
}

TEST(HeavyTopClosedForm, StartsAtTheInitialState) {
  const HeavyTopParameters p = oblique_top();
  const HeavyTopWideData data(p);
  HeavyTopWitness start;
  start.R = rotation_matrix(data.orientation);
  start.omega = data.omega;
  EXPECT_LT(difference(HeavyTopClosedForm::of(p)->at(0), start), 1e-40);
}

TEST(HeavyTopClosedForm, AgreesWithExtrapolationForAnObliqueTop) {
  expect_the_extrapolated(oblique_top());
}

TEST(HeavyTopClosedForm, AgreesWithExtrapolationFromRest) {
  HeavyTopParameters p;
  p.angular_velocity = {0, 0, 0};
  p.orientation = {0.9, 0.1, 0.2, -0.3};
  expect_the_extrapolated(p);
}

// p = b or p = -b: the axis passes through the vertical, where Euler's angles break down and a root of f lies
// at +-1.
TEST(HeavyTopClosedForm, PassesThroughTheVertical) {
  HeavyTopParameters p;
  p.mass = 1;
  p.inertia = {{{1, 0, 0}, {0, 2, 0}, {0, 0, 1}}};  // J_fix = 2 I, b = w
  for (const std::array<double, 3>& omega : {std::array{0.0, 3.0, -3.0}, std::array{0.0, 3.0, 3.0},
                                             std::array{0.0, 13.0, 13.0}, std::array{0.0, -3.0, 3.0}}) {
    p.angular_velocity = omega;
    expect_the_extrapolated(p);
  }
}

TEST(HeavyTopClosedForm, IsAbsentWhereItDoesNotHold) {
  EXPECT_FALSE(HeavyTopClosedForm::of(unsymmetric_top()));
  EXPECT_FALSE(HeavyTopClosedForm::of(kovalevskaya_top())) << "symmetric, but not about the axis";
  EXPECT_FALSE(HeavyTopClosedForm::of(free_body()));

  HeavyTopParameters upright;
  upright.orientation = {1, 1, 0, 0};
  EXPECT_FALSE(HeavyTopClosedForm::of(upright)) << "starts on the vertical";

  // f has a double root: u'' = f'(u) / 2 = 0 at the start, with the axis horizontal 2 p b = be.
  HeavyTopParameters steady;
  steady.mass = 1;
  steady.inertia = {{{1, 0, 0}, {0, 2, 0}, {0, 0, 1}}};
  steady.angular_velocity = {0, 9.81, 0.5};  // be = g = 9.81, p b = 9.81 / 2
  EXPECT_FALSE(HeavyTopClosedForm::of(steady)) << "precesses steadily";
}

}  // namespace
}  // namespace liebench
