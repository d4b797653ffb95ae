#include "groups/real_space.h"

#include <gtest/gtest.h>

#include "groups/extended.h"
#include "tests/support/lie_group_properties.h"

namespace liebench::real_space_test {

namespace {

[[maybe_unused]] const bool tested = test_lie_group<RealSpace<double, 3>>("RealSpace") &&
                                     test_lie_group<RealSpace<Extended, 2>>("RealSpaceExtended");

TEST(RealSpace, ExpIsTheIdentityMapAndTangentTheIdentityMatrix) {
  using G = RealSpace<double, 4>;
  const Eigen::Vector4d v(1e300, -3.5, 1e-300, 0.0);
  EXPECT_EQ(G::exp(v), v);
  EXPECT_EQ(G::log(v), v);
  EXPECT_EQ(G::tangent(v), Eigen::Matrix4d::Identity());
  EXPECT_EQ(G::tangent_inverse(v), Eigen::Matrix4d::Identity());
}

TEST(RealSpace, NothingTurns) {
  using G = RealSpace<double, 2>;
  EXPECT_EQ(G::rotation_angle(Eigen::Vector2d(7.0, -9.0)), 0.0);
}

}  // namespace
}  // namespace liebench::real_space_test
