#include "groups/so3.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "groups/extended.h"
#include "tests/support/dense_algebra.h"
#include "tests/support/lie_group_properties.h"

namespace liebench::so3_test {

namespace {

[[maybe_unused]] const bool tested =
    test_lie_group<SO3<double>>("SO3") && test_lie_group<SO3<Extended>>("SO3Extended");

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;
constexpr double eps = 2.3e-16;

TEST(SO3, SkewIsTheCrossProduct) {
  const Vector v(0.3, -0.7, 1.9), w(-2.0, 0.4, 0.5);
  EXPECT_LE((skew(v) * w - v.cross(w)).norm(), 4 * eps * v.norm() * w.norm());
}

TEST(SO3, ExpOfAQuarterTurnPermutesTheAxes) {
  // By the right-hand rule about e3: e1 -> e2, e2 -> -e1.
  const Matrix R = SO3<double>::exp(Vector(0, 0, std::numbers::pi / 2));
  EXPECT_LE((R * Vector::UnitX() - Vector::UnitY()).norm(), 4 * eps);
  EXPECT_LE((R * Vector::UnitY() + Vector::UnitX()).norm(), 4 * eps);
  EXPECT_EQ(R(2, 2), 1.0);
}

TEST(SO3, ExpIsTheRotationOfEigen) {
  for (const double angle : {0.1, 0.6, 1.9, 2.1, 3.0, 5.0}) {
    const Vector axis = Vector(0.2, -0.5, 0.9).normalized();
    const Matrix expected = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    EXPECT_LE((SO3<double>::exp(angle * axis) - expected).norm(), 16 * eps) << angle;
  }
}

TEST(SO3, QuaternionAndMatrixAreInverseToEachOther) {
  for (const double angle : {0.0, 1e-8, 1.0, 2.0, 2.5, 3.0, 3.14159}) {
    for (const auto& v : LieGroupSamples<SO3<double>>::tangents(angle)) {
      const Matrix R = SO3<double>::exp(v);
      const Quaternion<double> p = SO3<double>::quaternion(R);
      EXPECT_LE(std::abs(p.norm() - 1), 8 * eps);
      EXPECT_LE((rotation_matrix<double>(p) - R).norm(), 16 * eps);
    }
  }
}

template <class T>
void expect_axis_up_to_sign_at_pi() {
  using S = LieGroupSamples<SO3<T>>;
  for (const auto& v : S::tangents(S::pi())) {
    const auto w = SO3<T>::log(SO3<T>::exp(v));
    const double tolerance = S::few * S::eps() * S::length(v);
    EXPECT_LE(std::min(S::length((w - v).eval()), S::length((w + v).eval())), tolerance);
  }
}

TEST(SO3, LogAtPiHasTheAngleAndTheAxisUpToSign) {
  expect_axis_up_to_sign_at_pi<double>();
  expect_axis_up_to_sign_at_pi<Extended>();
}

TEST(SO3, DefectIsTheFrobeniusNormOfTheGramMatrixMinusIdentity) {
  const Matrix R = SO3<double>::exp(Vector(0.5, 1.0, -0.4));
  const double stretch = 1e-3;  // ((1 + s)^2 - 1) sqrt(3)
  const double expected = (2 * stretch + stretch * stretch) * std::numbers::sqrt3;
  EXPECT_NEAR(SO3<double>::defect((1 + stretch) * R), expected, 16 * eps);
}

TEST(SO3, RenormalizationIsTheNewtonStepTowardsThePolarFactor) {
  // With E = R^T R - I the new one is (I - E/2) (I + E) (I - E/2) - I = -(3/4) E^2 + (1/4) E^3.
  Matrix R = SO3<double>::exp(Vector(0.5, 1.0, -0.4));
  R(0, 1) += 2e-2;
  R(2, 0) -= 1e-2;
  const Matrix E = R.transpose() * R - Matrix::Identity();
  const Matrix repaired = SO3<double>::renormalized(R);
  const Matrix remaining = repaired.transpose() * repaired - Matrix::Identity();
  EXPECT_LE((remaining + 0.75 * E * E - 0.25 * E * E * E).norm(), 32 * eps);
  // The polar factor U of R = U P by the singular value decomposition: the step keeps it.
  EXPECT_LE((polar_factor(repaired) - polar_factor(R)).norm(), 64 * eps);
}

TEST(SO3, LogOfARoundedMatrixStaysFinite) {
  // Trace and diagonal a little outside of what a rotation allows.
  for (const double sign : {1.0, -1.0}) {
    const Matrix R = Vector(1, sign, sign).asDiagonal().toDenseMatrix() * (1 + 4 * eps);
    const Vector v = SO3<double>::log(R);
    EXPECT_TRUE(v.allFinite());
    EXPECT_LE(v.norm(), std::numbers::pi * (1 + 16 * eps));
  }
}

TEST(SO3, SeparationIsContinuousWhereItsFormulasMeet) {
  // The switch lies at ||p - q||_F = 0.1, an angle of 0.0707.
  const Vector axis = Vector(0.2, -0.5, 0.9).normalized();
  const Matrix q = SO3<double>::exp(Vector(1.0, 2.0, -0.5));
  for (int i = -50; i <= 50; ++i) {
    const double angle = 0.0707107 * (1 + 1e-5 * i);
    const Vector v = SO3<double>::separation(q, q * SO3<double>::exp(angle * axis));
    EXPECT_LE((v - angle * axis).norm(), 64 * eps) << angle;
  }
}

}  // namespace
}  // namespace liebench::so3_test
