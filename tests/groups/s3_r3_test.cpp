#include "groups/s3_r3.h"

#include <gtest/gtest.h>

#include "groups/extended.h"
#include "tests/support/lie_group_properties.h"

namespace liebench::s3_r3_test {

namespace {

[[maybe_unused]] const bool tested =
    test_lie_group<S3R3<double>>("S3R3") && test_lie_group<S3R3<Extended>>("S3R3Extended");

// The same motions as those of SE(3), on another representation: what the algebra gives is equal bit by bit.
TEST(S3R3, IsSE3WithQuaternions) {
  for (const auto& v : LieGroupSamples<SE3<double>>::tangents(1.3)) {
    const auto q = S3R3<double>::exp(v);
    EXPECT_EQ(q.first, SE3<double>::exp(v).first);
    EXPECT_LE((rotation_matrix<double>(q.second) - SE3<double>::exp(v).second).norm(), 16 * 2.3e-16);
    EXPECT_EQ(S3R3<double>::tangent(v), SE3<double>::tangent(v));
  }
}

TEST(S3R3, StacksThePositionAboveTheQuaternion) {
  const auto q = S3R3<double>::exp(LieGroupSamples<S3R3<double>>::tangents(1.3).back());
  EXPECT_EQ(S3R3<double>::stacked(q).head<3>(), q.first);
  EXPECT_EQ(S3R3<double>::stacked(q).tail<4>(), q.second);
}

}  // namespace
}  // namespace liebench::s3_r3_test
