#include "harness/references/heavy_top_taylor.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "heavy_top_samples.h"

namespace liebench {
namespace {

HeavyTopWitness state(const HeavyTopTrajectory& trajectory, double t) {
  const HeavyTopTrajectory::Values v = trajectory.at(t);
  return {t,
          rotation_matrix({to_wide(v[0]), to_wide(v[1]), to_wide(v[2]), to_wide(v[3])}),
          {to_wide(v[4]), to_wide(v[5]), to_wide(v[6])}};
}

// Rounding of the double-doubles (2^-104 = 5e-32 an operation at worst) in quantities that add up terms some
// ten times the result, and the truncation of 1e-33: 1e-30. A wrong term of the equations is seen at once.
const Wide invariance("1e-30");

TEST(HeavyTopTaylor, StartsAtTheDecimalsOfTheParameters) {
  const HeavyTopTrajectory trajectory = heavy_top_by_taylor(HeavyTopParameters{}, 0.01);
  const HeavyTopTrajectory::Values v = trajectory.at(0);
  const std::array<double, 4> identity{1, 0, 0, 0};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(v[i] == identity[i]);
  EXPECT_LE(abs(to_wide(v[6]) + Wide(461538) / 100000),
            ldexp(Wide(1), -103));  // half an ulp of a double-double
}

TEST(HeavyTopTaylor, KeepsEnergyVerticalMomentumAndTheUnitSphere) {
  const HeavyTopParameters p = unsymmetric_top();
  const HeavyTopTrajectory trajectory = heavy_top_by_taylor(p, 1);
  const HeavyTopWideData data(p);
  const HeavyTopWitness start = state(trajectory, 0);
  for (int i = 1; i <= 50; ++i) {
    const double t = i * 0.02;
    const HeavyTopWitness s = state(trajectory, t);
    EXPECT_LT(abs(energy(p, s) / energy(p, start) - 1), invariance) << t;
    EXPECT_LT(
        abs(dot(angular_momentum(p, s), data.gravity) / dot(angular_momentum(p, start), data.gravity) - 1),
        invariance)
        << t;
    EXPECT_LT(abs(dot(s.R[0], s.R[0]) - 1), invariance) << t;
  }
}

TEST(HeavyTopTaylor, KeepsTheConstantOfKovalevskaya) {
  const HeavyTopParameters p = kovalevskaya_top();
  const HeavyTopTrajectory trajectory = heavy_top_by_taylor(p, 5);
  for (int i = 0; i <= 20; ++i) {
    const HeavyTopWitness s = state(trajectory, i * 0.25);
    const WideVector& O = s.omega;
    const WideVector& G = s.R[2];  // R^T e_3
    const Wide real = O[0] * O[0] - O[1] * O[1] - G[0];
    const Wide imag = 2 * O[0] * O[1] - G[1];
    EXPECT_LT(abs(energy(p, s) - Wide("3.25")), 10 * invariance);
    EXPECT_LT(abs(angular_momentum(p, s)[2] - 2), 10 * invariance);
    EXPECT_LT(abs(real * real + imag * imag - Wide("1.5625")), 10 * invariance);
  }
}

TEST(HeavyTopTaylor, KeepsTheMomentumOfAFreeBodyThroughItsFlips) {
  const HeavyTopParameters p = free_body();
  const HeavyTopTrajectory trajectory = heavy_top_by_taylor(p, 6);
  const WideVector L0 = angular_momentum(p, state(trajectory, 0));
  Wide slowest = 5;
  for (int i = 1; i <= 60; ++i) {
    const HeavyTopWitness s = state(trajectory, i * 0.1);
    const WideVector L = angular_momentum(p, s);
    for (std::size_t j = 0; j < 3; ++j) EXPECT_LT(abs(L[j] - L0[j]), 10 * invariance);  // |L| = 10
    EXPECT_LT(abs(energy(p, s) / Wide("25.0002") - 1), invariance);
    if (s.omega[1] < slowest) slowest = s.omega[1];
  }
  EXPECT_LT(slowest, -4.9) << "it did not flip: nothing was tested";
}

TEST(HeavyTopTaylor, PiecesMeet) {
  // Two evaluations with the rounding of the highest-order sums each, 2^-104 a component at worst.
  EXPECT_LT(heavy_top_by_taylor(unsymmetric_top(), 1).largest_jump(12), 1e-31);
}

TEST(HeavyTopTaylor, LeavesAHangingBodyAtRestInOnePiece) {
  HeavyTopParameters p;
  p.angular_velocity = {0, 0, 0};
  p.orientation = {1, -1, 0, 0};  // R e_2 = -e_3
  const HeavyTopTrajectory trajectory = heavy_top_by_taylor(p, 100);
  EXPECT_LT(trajectory.pieces().size(), 10u);
  EXPECT_LT(abs(state(trajectory, 100).R[2][1] + 1), invariance);
}

TEST(HeavyTopTaylor, AnswersForItsIntervalOnly) {
  const HeavyTopTrajectory trajectory = heavy_top_by_taylor(HeavyTopParameters{}, 0.02);
  EXPECT_NO_THROW(trajectory.at(0.02));
  EXPECT_THROW(trajectory.at(0.0200001), std::out_of_range);
  EXPECT_THROW(trajectory.at(-1e-9), std::out_of_range);
  EXPECT_THROW(trajectory.at(std::nan("")), std::out_of_range);
}

TEST(HeavyTopTaylor, RefusesAnIntervalThatIsNone) {
  EXPECT_THROW(heavy_top_by_taylor(HeavyTopParameters{}, 0), std::invalid_argument);
  EXPECT_THROW(heavy_top_by_taylor(HeavyTopParameters{}, HUGE_VAL), std::invalid_argument);
}

}  // namespace
}  // namespace liebench
