#include "groups/decimal.h"

#include <gtest/gtest.h>

#include <bit>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "groups/extended.h"

namespace liebench::decimal_test {
namespace {

using Wide = boost::multiprecision::cpp_bin_float_100;

TEST(Decimal, OfADoubleIsTheDouble) {
  EXPECT_EQ(decimal<double>(-4.61538), -4.61538);
}

TEST(Decimal, ReadsTheShortestDecimal) {
  EXPECT_EQ(decimal<Wide>(-4.61538), Wide(-461538) / 100000);
  EXPECT_EQ(decimal<Wide>(0.1), Wide(1) / 10);
  EXPECT_EQ(decimal<Wide>(1e22), Wide("1e22"));
}

TEST(Decimal, KeepsWhatIsAlreadyExact) {
  for (const double x : {0.0, -0.0, 1.0, -150.0, 0.234375, 15.0, 9007199254740993.0}) {
    const dd_real value = decimal<dd_real>(x);
    EXPECT_EQ(value.x[0], x);
    EXPECT_EQ(value.x[1], 0.0);
    EXPECT_EQ(std::signbit(value.x[0]), std::signbit(x));
  }
}

TEST(Decimal, PassesOnWhatIsNotFinite) {
  EXPECT_TRUE(std::isnan(decimal<dd_real>(std::nan("")).x[0]));
  EXPECT_EQ(decimal<Wide>(HUGE_VAL), std::numeric_limits<Wide>::infinity());
}

TEST(Decimal, IsWithinTwoToTheMinus106InDoubleDouble) {
  std::mt19937_64 random(20240229);
  for (int n = 0; n < 20000; ++n) {
    const double x = std::bit_cast<double>(random());
    // Below, the low part of a double-double underflows.
    if (!std::isfinite(x) || std::abs(x) < 1e-290) continue;
    const dd_real value = decimal<dd_real>(x);
    ASSERT_EQ(value.x[0], x) << "the decimal rounds to its double";
    const Wide exact = decimal<Wide>(x);
    const Wide error = abs((Wide(value.x[0]) + value.x[1] - exact) / exact);
    // A double-double nearest to a number is within half an ulp, 2^-54 |low| <= 2^-107 |x|; twice that is
    // allowed.
    ASSERT_LE(error, ldexp(Wide(1), -106)) << x;
  }
}

struct Constant {
  using Scalar = dd_real;
  explicit Constant(const dd_real& x) : value(x) {}
  dd_real value;
};

TEST(Decimal, ReachesTheScalarInsideADifferentiatingType) {
  EXPECT_TRUE(decimal<Constant>(0.1).value == decimal<dd_real>(0.1));
}

}  // namespace
}  // namespace liebench::decimal_test
