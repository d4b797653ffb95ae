#include "groups/s3.h"

#include <gtest/gtest.h>

#include <numbers>

#include "groups/extended.h"
#include "tests/support/lie_group_properties.h"

namespace liebench::s3_test {

namespace {

[[maybe_unused]] const bool tested =
    test_lie_group<S3<double>>("S3") && test_lie_group<S3<Extended>>("S3Extended");

using Vector = Eigen::Vector3d;
constexpr double eps = 2.3e-16;

TEST(S3, ExpHasHalfTheAngle) {
  // A half turn about e2 is (0, e2), a full one -1.
  const double pi = std::numbers::pi;
  EXPECT_LE((S3<double>::exp(Vector(0, pi, 0)) - Quaternion<double>(0, 0, 1, 0)).norm(), eps);
  EXPECT_LE((S3<double>::exp(Vector(0, 2 * pi, 0)) - Quaternion<double>(-1, 0, 0, 0)).norm(), 2 * eps);
}

TEST(S3, LogOfANegativeRealPartIsThatOfTheOtherQuaternion) {
  // Turned by 4 rad about an axis is turned by 4 - 2 pi.
  const Vector axis = Vector(0.2, -0.5, 0.9).normalized();
  const Vector v = S3<double>::log(S3<double>::exp(4 * axis));
  EXPECT_LE((v - (4 - 2 * std::numbers::pi) * axis).norm(), 8 * eps);
}

// p w conj(p), the definition, and the matrix.
TEST(S3, RotatesAsItsMatrix) {
  const Vector w(0.7, -2.0, 0.4);
  for (const auto& p : LieGroupSamples<S3<double>>::elements()) {
    const Quaternion<double> turned = quaternion_product<double>(
        quaternion_product<double>(p, quaternion_of<double>(0, w)), quaternion_conjugate<double>(p));
    EXPECT_LE((turned - quaternion_of<double>(0, S3<double>::rotate(p, w))).norm(), 200 * eps);
    EXPECT_LE((S3<double>::matrix(p) * w - S3<double>::rotate(p, w)).norm(), 64 * eps);
    EXPECT_LE((S3<double>::matrix(p).transpose() * w - S3<double>::rotate_back(p, w)).norm(), 64 * eps);
    const Eigen::Matrix3d R = S3<double>::matrix(p);
    EXPECT_EQ(SO3<double>::rotate(R, w), R * w);
    EXPECT_EQ(SO3<double>::rotate_back(R, w), R.transpose() * w);
  }
}

TEST(S3, RenormalizationIsTheNewtonStepForTheNorm) {
  // |p|^2 = 1 + e becomes (1 + e) (1 - e/2)^2 = 1 - 3/4 e^2 + 1/4 e^3.
  const Quaternion<double> p = S3<double>::exp(Vector(0.3, 1.0, -0.4)) * 1.01;
  const double e = 1.01 * 1.01 - 1;
  EXPECT_NEAR(S3<double>::renormalized(p).squaredNorm(), 1 - 0.75 * e * e + 0.25 * e * e * e, 8 * eps);
  EXPECT_NEAR(S3<double>::defect(p), e, 8 * eps);
}

}  // namespace
}  // namespace liebench::s3_test
