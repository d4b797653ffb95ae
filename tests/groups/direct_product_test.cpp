#include "groups/direct_product.h"

#include <gtest/gtest.h>

#include "groups/extended.h"
#include "groups/real_space.h"
#include "groups/s3.h"
#include "groups/so3.h"
#include "tests/support/lie_group_properties.h"

namespace liebench::direct_product_test {

using Body = DirectProduct<RealSpace<double, 3>, SO3<double>>;
using ExtendedBody = DirectProduct<RealSpace<Extended, 3>, SO3<Extended>>;

// A product nests: two rotations and a translation, of different dimensions.
using TwoJoints = DirectProduct<SO3<double>, DirectProduct<RealSpace<double, 1>, SO3<double>>>;

// With two representations of each element.
using QuaternionBody = DirectProduct<RealSpace<double, 3>, S3<double>>;
using ExtendedQuaternionBody = DirectProduct<RealSpace<Extended, 3>, S3<Extended>>;

namespace {

[[maybe_unused]] const bool tested =
    test_lie_group<Body>("DirectProduct") && test_lie_group<ExtendedBody>("DirectProductExtended") &&
    test_lie_group<TwoJoints>("NestedProduct") &&
    test_lie_group<QuaternionBody>("DirectProductOfQuaternions") &&
    test_lie_group<ExtendedQuaternionBody>("DirectProductOfQuaternionsExtended");

Eigen::Matrix<double, 6, 1> six(double a, double b, double c, double d, double e, double f) {
  Eigen::Matrix<double, 6, 1> v;
  v << a, b, c, d, e, f;
  return v;
}

TEST(DirectProduct, ActsComponentByComponent) {
  const auto v = six(1, -2, 3, 0.4, -0.5, 0.6), w = six(0.1, 0.2, -0.3, 1.1, 0.7, -0.9);
  const Eigen::Vector3d u = v.tail<3>(), omega = w.tail<3>();
  const Body::Element q = Body::exp(v), p = Body::exp(w), product = Body::compose(q, p);
  EXPECT_EQ(q.first, v.head<3>());
  EXPECT_EQ(q.second, SO3<double>::exp(u));
  // The translation is not turned: R^3 x SO(3), not SE(3).
  EXPECT_EQ(product.first, v.head<3>() + w.head<3>());
  EXPECT_EQ(product.second, SO3<double>::exp(u) * SO3<double>::exp(omega));
  EXPECT_EQ(Body::commutator(v, w).head<3>(), Eigen::Vector3d::Zero());
  EXPECT_EQ(Body::commutator(v, w).tail<3>(), u.cross(omega));
  EXPECT_EQ((Body::tangent(v).topLeftCorner<3, 3>()), Eigen::Matrix3d::Identity());
  EXPECT_EQ((Body::tangent(v).bottomRightCorner<3, 3>()), SO3<double>::tangent(u));
  EXPECT_EQ((Body::tangent(v).topRightCorner<3, 3>()), Eigen::Matrix3d::Zero());
}

TEST(DirectProduct, StacksFirstAboveSecond) {
  const Body::Element q = Body::exp(six(1, -2, 3, 0.4, -0.5, 0.6));
  EXPECT_EQ(Body::stacked(q).head<3>(), q.first);
  EXPECT_EQ(Body::stacked(q).tail<9>(), SO3<double>::stacked(q.second));
}

TEST(DirectProduct, RotationAngleIsTheLargestOfAll) {
  Eigen::Matrix<double, 7, 1> v;
  v << 0.1, 0, 0, /*translation*/ 50, 0, 0.3, 0;
  EXPECT_EQ(TwoJoints::rotation_angle(v), 0.3);
  v(0) = 0.7;
  EXPECT_EQ(TwoJoints::rotation_angle(v), 0.7);
}

TEST(DirectProduct, CommutesOnlyIfAllFactorsDo) {
  EXPECT_FALSE(Body::commutative);
  EXPECT_FALSE(TwoJoints::commutative);
  EXPECT_TRUE((DirectProduct<RealSpace<double, 1>, RealSpace<double, 2>>::commutative));
}

}  // namespace
}  // namespace liebench::direct_product_test
