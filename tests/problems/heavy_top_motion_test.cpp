#include "tests/support/heavy_top_motion.h"

#include <gtest/gtest.h>

#include "tests/support/heavy_top_samples.h"

namespace liebench {
namespace {

// 4.9e-32 a rounding, some hundred of them in a coefficient's convolutions, times the growth of an error
// over the time (below ten): 1e-28.
constexpr double accuracy = 1e-28;

TEST(HeavyTopMotion, KeepsEnergyAndOrthogonality) {
  for (const HeavyTopParameters& p : {slow_top(), unsymmetric_top(1)}) {
    const HeavyTopMotion motion(p, 1.0);
    const Extended start = motion.energy(motion.at(0.0));
    for (int i = 1; i <= 20; ++i) {
      const auto s = motion.at(0.05 * i);
      EXPECT_LE(std::abs(to_double(Extended(motion.energy(s) - start))), accuracy * 1e3) << i;
      EXPECT_LE(to_double(SO3<Extended>::defect(s.R)), accuracy) << i;
    }
  }
}

TEST(HeavyTopMotion, DoesNotDependOnItsPieces) {
  for (const HeavyTopParameters& p : {slow_top(), unsymmetric_top(2)}) {
    const HeavyTopMotion motion(p, 1.0), finer(p, 1.0, 1.7);
    for (int i = 0; i <= 20; ++i) {
      const auto a = motion.at(0.05 * i), b = finer.at(0.05 * i);
      EXPECT_LE(to_double((a.R - b.R).norm()), accuracy) << i;
      EXPECT_LE(to_double((a.omega - b.omega).norm()), 10 * accuracy) << i;
    }
  }
}

TEST(HeavyTopMotion, SatisfiesTheEquationsOfMotion) {
  const HeavyTopParameters p = unsymmetric_top(1);
  const HeavyTopSO3<Extended> system(p);
  const HeavyTopMotion motion(p, 0.5);
  for (const double t : {0.0, 0.11, 0.37, 0.5}) {
    const auto s = motion.at(t);
    const auto residual =
        (system.momentum(s.R, s.omega_dot) + system.force(Extended(t), s.R, s.omega)).eval();
    EXPECT_LE(to_double(residual.norm()), accuracy * 1e3) << t;
  }
}

TEST(HeavyTopMotion, AgreesWithThePublishedFastTop) {
  // the design notes, section 8, t = 0.5 s: Omega to the digits printed there.
  const HeavyTopMotion motion(HeavyTopParameters{}, 0.5);
  const auto s = motion.at(0.5);
  EXPECT_LE(std::abs(to_double(Extended(s.omega(0) - Extended("-0.47105310174524884297")))), 1e-19);
  EXPECT_LE(std::abs(to_double(Extended(s.omega(2) - Extended("5.9010830483264570279")))), 1e-18);
}

TEST(HeavyTop, AngularMomentumAboutTheVerticalIsConstantInBothFormulations) {
  const HeavyTopParameters p = unsymmetric_top(1);
  const HeavyTopMotion motion(p, 0.5);
  const auto momentum = [&](const auto& system, double t) {
    const auto point = motion.point(system, Extended(t));
    return to_double(system.angular_momentum(point.q, point.v));
  };
  const HeavyTopSO3<Extended> rotation(p);
  const HeavyTopR3xSO3<Extended> body(p);
  const double start = momentum(rotation, 0.0);
  for (const double t : {0.1, 0.3, 0.5}) {
    // Extended results, rounded to double.
    EXPECT_NEAR(momentum(rotation, t), start, 4e-16 * std::abs(start));
    EXPECT_NEAR(momentum(body, t), start, 4e-16 * std::abs(start));
  }
}

}  // namespace
}  // namespace liebench
