#include "problems/heavy_top_parameters.h"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>

namespace liebench::heavy_top_parameters_test {
namespace {

using Wide = boost::multiprecision::cpp_bin_float_50;

TEST(HeavyTopParameters, DefaultInertiaAboutTheTipIsThatOfThePaper) {
  const auto J = inertia_about_tip<double>(HeavyTopParameters{});
  const std::array<double, 3> diagonal{15.234375, 0.46875, 15.234375};  // exact in binary
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) EXPECT_EQ(J[i][j], i == j ? diagonal[i] : 0.0);
  }
}

TEST(HeavyTopParameters, InertiaAboutTheTipObeysSteiner) {
  HeavyTopParameters p;
  p.mass = 2;
  p.center_of_mass = {0.1, -0.2, 0.3};
  const auto J = inertia_about_tip<Wide>(p);
  // J_cm + m (|X|^2 I - X X^T) by hand: |X|^2 = 0.14.
  EXPECT_LT(abs(J[0][0] - Wide("0.494375")), Wide("1e-49"));
  EXPECT_LT(abs(J[0][1] - Wide("0.04")), Wide("1e-49"));
  EXPECT_LT(abs(J[1][2] - Wide("0.12")), Wide("1e-49"));
  EXPECT_EQ(J[2][1], J[1][2]);
}

TEST(HeavyTopParameters, OrientationIsNormalised) {
  HeavyTopParameters p;
  p.orientation = {0.3, -0.5, 0.7, 0.2};
  const auto q = initial_orientation<Wide>(p);
  EXPECT_LT(abs(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1), Wide("1e-49"));
  EXPECT_LT(abs(q[1] / q[0] + Wide(5) / 3), Wide("1e-49"));
}

}  // namespace
}  // namespace liebench::heavy_top_parameters_test
