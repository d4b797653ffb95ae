#include "harness/references/heavy_top_extrapolation.h"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>

#include "heavy_top_samples.h"

namespace liebench {
namespace {

TEST(HeavyTopExtrapolation, TurnsAFreeBodyAboutItsAxisUniformly) {
  HeavyTopParameters p = free_body();
  p.angular_velocity = {0, 5, 0};
  const std::array<double, 3> times{0.1, 0.75, 2};
  for (const HeavyTopWitness& s : heavy_top_by_extrapolation(p, times)) {
    const Wide angle = Wide(s.t) * 5;
    // Some ten steps, each with an error below 1e-35 in the last column but one.
    const Wide tolerance("1e-33");
    EXPECT_LT(abs(s.R[0][0] - cos(angle)), tolerance);
    EXPECT_LT(abs(s.R[0][2] - sin(angle)), tolerance);
    EXPECT_LT(abs(s.R[1][1] - 1), tolerance);
    EXPECT_LT(abs(s.omega[1] - 5), tolerance);
  }
}

TEST(HeavyTopExtrapolation, GivesThePublishedStateOfTheFastTop) {
  const std::array<double, 1> times{0.5};
  const std::vector<HeavyTopWitness> states = heavy_top_by_extrapolation(HeavyTopParameters{}, times);
  ASSERT_EQ(states.size(), 1u);
  // docs/references.md and an independent computation in 60 digits.
  expect_printed(states[0].omega[0], "-0.47105310174524884297");
  expect_printed(states[0].omega[1], "150.00000000000000000000");
  expect_printed(states[0].omega[2], "5.9010830483264570279");
  const WideMatrix R = rotation_matrix({Wide("0.58456062406941464192"), Wide("-0.70066289541220650374"),
                                        Wide("0.38432575302289440504"), Wide("0.14019307880043520044")});
  for (std::size_t i = 0; i < 3; ++i) {
    // 20 printed decimals of the quaternion, six times twice that in an entry of R.
    for (std::size_t j = 0; j < 3; ++j) EXPECT_LT(abs(states[0].R[i][j] - R[i][j]), Wide("6e-20"));
  }
}

TEST(HeavyTopExtrapolation, KeepsEnergyWithoutProjection) {
  const HeavyTopParameters p = unsymmetric_top();
  const std::array<double, 2> times{0.3, 0.6};
  const std::vector<HeavyTopWitness> s = heavy_top_by_extrapolation(p, times);
  HeavyTopWitness start;
  const HeavyTopWideData data(p);
  start.R = rotation_matrix(data.orientation);
  start.omega = data.omega;
  for (const HeavyTopWitness& state : s)
    EXPECT_LT(abs(energy(p, state) / energy(p, start) - 1), Wide("1e-33"));
}

TEST(HeavyTopExtrapolation, RefusesTimesThatDoNotAscend) {
  for (const std::array<double, 2>& times :
       {std::array{0.2, 0.1}, std::array{0.0, 0.1}, std::array{0.1, 0.1}}) {
    EXPECT_THROW(heavy_top_by_extrapolation(HeavyTopParameters{}, times), std::invalid_argument);
  }
}

}  // namespace
}  // namespace liebench
