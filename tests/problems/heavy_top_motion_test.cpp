#include "tests/support/heavy_top_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/heavy_top_formulations.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/jets.h"

namespace liebench::heavy_top_motion_test {
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

TEST(HeavyTopMotion, AgreesWithThePublishedFastTop) {
  // the design notes, section 8, t = 0.5 s: Omega to the digits printed there.
  const HeavyTopMotion motion(HeavyTopParameters{}, 0.5);
  const auto s = motion.at(0.5);
  EXPECT_LE(std::abs(to_double(Extended(s.omega(0) - Extended("-0.47105310174524884297")))), 1e-19);
  EXPECT_LE(std::abs(to_double(Extended(s.omega(2) - Extended("5.9010830483264570279")))), 1e-18);
}

template <class Formulation>
class HeavyTopMotionIn : public ::testing::Test {};
TYPED_TEST_SUITE(HeavyTopMotionIn, AllHeavyTops, HeavyTopNames);

TYPED_TEST(HeavyTopMotionIn, SatisfiesTheEquationsOfMotion) {
  using S = typename TypeParam::template In<Extended>;
  const HeavyTopParameters p = unsymmetric_top(1);
  const S system(p);
  const HeavyTopMotion motion(p, 0.5);
  for (const double t : {0.0, 0.11, 0.37, 0.5}) {
    const auto s = motion.point(system, Extended(t));
    Velocity<S> residual = system.momentum(s.q, s.acceleration) + system.force(Extended(t), s.q, s.v);
    if constexpr (S::constraints > 0) {
      residual += system.constraint_force(s.q, s.lambda);
      EXPECT_LE(to_double(system.constraint(s.q).norm()), accuracy) << t;
    }
    EXPECT_LE(to_double(residual.norm()), accuracy * 1e3) << t;
  }
}

// q' = q v~: five-point differences of the path, in units of the time in which the top turns by some 1/2 rad.
TYPED_TEST(HeavyTopMotionIn, VelocityIsTheRateOfTheConfiguration) {
  using S = typename TypeParam::template In<Extended>;
  using Group = typename S::Group;
  const HeavyTopParameters p = unsymmetric_top(1);
  const S system(p);
  const HeavyTopMotion motion(p, 0.5);
  for (const double t : {0.11, 0.37}) {
    const auto s = motion.point(system, Extended(t));
    const auto path = [&](const Extended& d) -> Velocity<S> {
      return Group::log(Group::compose(Group::inverse(s.q), motion.point(system, Extended(t) + d).q));
    };
    const auto velocity_at = [&](const Extended& d) { return motion.point(system, Extended(t) + d).v; };
    const double unit = 0.1;
    const double tolerance = 64 * std::pow(to_double(Eigen::NumTraits<Extended>::epsilon()), 0.8) *
                             to_double(Extended(s.v.norm() + s.acceleration.norm())) / unit;
    EXPECT_LE(to_double((five_point_derivative<Extended>(path, unit) - s.v).norm()), tolerance) << t;
    EXPECT_LE(to_double((five_point_derivative<Extended>(velocity_at, unit) - s.acceleration).norm()),
              tolerance)
        << t;
  }
}

TYPED_TEST(HeavyTopMotionIn, InvariantsAreConstant) {
  using S = typename TypeParam::template In<Extended>;
  const HeavyTopParameters p = unsymmetric_top(1);
  const S system(p);
  const HeavyTopMotion motion(p, 0.5);
  const auto start = motion.point(system, Extended(0.0));
  for (const double t : {0.1, 0.3, 0.5}) {
    const auto s = motion.point(system, Extended(t));
    const Extended momentum = system.angular_momentum(s.q, s.v) - system.angular_momentum(start.q, start.v);
    const Extended energy = system.energy(s.q, s.v) - system.energy(start.q, start.v);
    EXPECT_LE(std::abs(to_double(momentum)), accuracy * 1e3) << t;
    EXPECT_LE(std::abs(to_double(energy)), accuracy * 1e3) << t;
  }
}

}  // namespace
}  // namespace liebench::heavy_top_motion_test
