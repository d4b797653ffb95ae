#include "groups/extended.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <limits>

namespace liebench::extended_test {
namespace {

TEST(Extended, EpsilonIsTheSpacingThatArithmeticSees) {
  const Extended eps = Eigen::NumTraits<Extended>::epsilon();
  EXPECT_TRUE((Extended(1.0) + eps) - 1.0 == eps);
  // 106 bits, of which the library promises all but the last one or two.
  EXPECT_LE(to_double(eps), 0x1p-103);
  EXPECT_GE(to_double(eps), 0x1p-106);
}

TEST(Extended, CastToDoubleRoundsToNearest) {
  Eigen::Matrix<Extended, 1, 3> x;
  x << Extended(1.0) + 1e-20, Extended(1.0) - 1e-20, Extended(1.0) / 3.0;
  const Eigen::RowVector3d rounded = x.cast<double>();
  EXPECT_EQ(rounded(0), 1.0);
  EXPECT_EQ(rounded(1), 1.0);
  EXPECT_EQ(rounded(2), 1.0 / 3.0);
}

TEST(Extended, CastFromDoubleAndBackIsTheIdentity) {
  const Eigen::Vector4d x(0.1, -1e300, 3e-300, 0.0);
  EXPECT_EQ(x.cast<Extended>().cast<double>(), x);
}

TEST(Extended, NormsAndProductsOfMatricesKeepAllDigits) {
  // 3 x = 1 only to 53 bits where a double slipped in.
  Eigen::Matrix<Extended, 3, 1> x = Eigen::Matrix<Extended, 3, 1>::Constant(Extended(1.0) / 3.0);
  const double eps = to_double(Eigen::NumTraits<Extended>::epsilon());
  EXPECT_LE(std::abs(to_double(Extended(x.sum() - 1.0))), 4 * eps);
  EXPECT_LE(std::abs(to_double(Extended(x.squaredNorm() * 3.0 - 1.0))), 8 * eps);
  EXPECT_LE(std::abs(to_double(Extended(x.norm() * x.norm() * 3.0 - 1.0))), 16 * eps);
  const Eigen::Matrix<Extended, 3, 3> outer = x * x.transpose();
  EXPECT_LE(std::abs(to_double(Extended(outer.trace() * 3.0 - 1.0))), 8 * eps);
}

TEST(Extended, SaysThatItIsExtended) {
  EXPECT_TRUE(ScalarTraits<Extended>::extended);
  EXPECT_FALSE(ScalarTraits<double>::extended);
}

}  // namespace
}  // namespace liebench::extended_test
