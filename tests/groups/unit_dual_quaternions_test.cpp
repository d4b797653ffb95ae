#include "groups/unit_dual_quaternions.h"

#include <gtest/gtest.h>

#include "groups/extended.h"
#include "groups/s3.h"
#include "tests/support/lie_group_properties.h"

namespace liebench::unit_dual_quaternions_test {

namespace {

[[maybe_unused]] const bool tested =
    test_lie_group<UnitDualQuaternions<double>>("UnitDualQuaternions") &&
    test_lie_group<UnitDualQuaternions<Extended>>("UnitDualQuaternionsExtended");

using G = UnitDualQuaternions<double>;
constexpr double eps = 2.3e-16;

TEST(UnitDualQuaternions, DualPartIsHalfThePositionTimesTheRotation) {
  const Eigen::Vector3d x(3, -1, 2);
  for (const auto& v : LieGroupSamples<S3<double>>::tangents(2.2)) {
    const auto q = G::representative({x, SO3<double>::exp(v)});
    const Quaternion<double> expected =
        0.5 * quaternion_product<double>(quaternion_of<double>(0, x), G::real(q));
    EXPECT_LE((G::dual(q) - expected).norm(), 8 * eps);
    EXPECT_LE((G::position(q) - x).norm(), 64 * eps);
    EXPECT_LE((G::position_in_body(q) - SO3<double>::exp(v).transpose() * x).norm(), 64 * eps);
  }
}

// exp of the dual number x + eps y is exp at x, and its derivative along y.
TEST(UnitDualQuaternions, DualPartOfExpIsADerivative) {
  using Jet = ceres::Jet<double, 1>;
  for (const double angle : {1e-9, 0.3, 1.0, 2.0, 3.0, 5.0})
    for (const auto& v : LieGroupSamples<G>::tangents(angle)) {
      Eigen::Matrix<Jet, 3, 1> omega;
      for (int i = 0; i < 3; ++i) {
        omega(i) = Jet(v(3 + i));
        omega(i).v(0) = v(i);
      }
      const Quaternion<Jet> p = S3<Jet>::exp(omega);
      const G::Element q = G::exp(v);
      for (int i = 0; i < 4; ++i) {
        EXPECT_NEAR(q(i), p(i).a, 4 * eps) << angle;
        EXPECT_NEAR(q(4 + i), p(i).v(0), 16 * eps * (1 + v.norm())) << angle;
      }
    }
}

TEST(UnitDualQuaternions, DefectIsTheLargerOfBothConditions) {
  G::Element q = G::representative({{3, -1, 2}, SO3<double>::exp({0.3, 1, -0.4})});
  const double length = 1e-3;
  EXPECT_NEAR(G::defect(q * (1 + length)), 2 * length + length * length, 16 * eps);
  const G::Element off = G::element(G::real(q), G::dual(q) + 0.01 * G::real(q));
  EXPECT_NEAR(G::defect(off), 0.02, 16 * eps);
}

TEST(UnitDualQuaternions, RenormalizationKeepsTheMotion) {
  // Scaled and shifted along p, the element stands for the same motion.
  const G::Element q = G::representative({{3, -1, 2}, SO3<double>::exp({0.3, 1, -0.4})});
  const G::Element off = 1.001 * G::element(G::real(q), G::dual(q) + 0.002 * G::real(q));
  const G::Element repaired = G::renormalized(G::renormalized(off));
  EXPECT_LE((repaired - q).norm(), 1e-11);
}

}  // namespace
}  // namespace liebench::unit_dual_quaternions_test
