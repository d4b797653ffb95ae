#include "harness/references/heavy_top_wide.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>

#include "heavy_top_samples.h"

namespace liebench {
namespace {

TEST(HeavyTopWideData, InvertsAFullInertia) {
  const HeavyTopWideData data(unsymmetric_top());
  const WideMatrix product = multiply(data.inertia, data.inertia_inverse);
  for (std::size_t i = 0; i < 3; ++i) {
    // 168 bits, a condition number of about 10.
    for (std::size_t j = 0; j < 3; ++j) EXPECT_LT(abs(product[i][j] - (i == j ? 1 : 0)), Wide("1e-48"));
  }
}

TEST(HeavyTopWideData, RefusesWhatIsNoBody) {
  const auto refuses = [](const std::function<void(HeavyTopParameters&)>& change) {
    HeavyTopParameters p;
    change(p);
    EXPECT_THROW(HeavyTopWideData{p}, std::invalid_argument);
  };
  refuses([](auto& p) { p.mass = std::nan(""); });
  refuses([](auto& p) { p.gravity[1] = HUGE_VAL; });
  refuses([](auto& p) { p.angular_velocity[2] = std::nan(""); });
  refuses([](auto& p) { p.orientation = {0, 0, 0, 0}; });
  refuses([](auto& p) { p.inertia[0][1] = 0.1; });    // not symmetric
  refuses([](auto& p) { p.inertia[1][1] = 0; });      // no inertia about the axis
  refuses([](auto& p) { p.inertia[0][0] = -15.5; });  // not positive about the tip either
}

TEST(HeavyTopWide, RotationMatrixTurnsByTwiceTheHalfAngle) {
  // 120 degrees about (1, 1, 1): e1 -> e2 -> e3 -> e1.
  const WideMatrix R = rotation_matrix({Wide(0.5), Wide(0.5), Wide(0.5), Wide(0.5)});
  const WideMatrix cyclic = {WideVector{0, 0, 1}, WideVector{1, 0, 0}, WideVector{0, 1, 0}};
  EXPECT_EQ(R, cyclic);
}

TEST(HeavyTopWide, RoundsToTheNearestDoubleDouble) {
  for (const char* text : {"-4.61538", "0.1", "3.14159265358979323846264338327950288419716939937510"}) {
    const Wide x(text);
    EXPECT_LE(abs((to_wide(to_extended(x)) - x) / x), ldexp(Wide(1), -106));
  }
}

}  // namespace
}  // namespace liebench
