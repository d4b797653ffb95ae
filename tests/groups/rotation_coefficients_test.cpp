#include "groups/rotation_coefficients.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "groups/extended.h"

namespace liebench::rotation_coefficients_test {
namespace {

// The closed forms lose up to x^6, 90 digits at x = 1e-15.
using Wide = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<150>>;

Wide to_wide(double x) {
  return Wide(x);
}
Wide to_wide(const Extended& x) {
  return Wide(x.x[0]) + Wide(x.x[1]);
}

// One coefficient in a scalar T and its closed form, both of x^2.
template <class T>
struct Coefficient {
  std::string name;
  std::function<T(const T&)> value;
  std::function<Wide(const Wide&)> closed_form;
};

template <class T>
std::vector<Coefficient<T>> coefficients() {
  return {
      {"sinc", [](const T& s) { return T(sinc_versine<T>(s).sinc); },
       [](const Wide& s) -> Wide {
         const Wide x = sqrt(s);
         return sin(x) / x;
       }},
      {"versine", [](const T& s) { return T(sinc_versine<T>(s).versine); },
       [](const Wide& s) -> Wide { return (1 - cos(sqrt(s))) / s; }},
      {"sine_defect", [](const T& s) { return T(sine_defect<T>(s)); },
       [](const Wide& s) -> Wide {
         const Wide x = sqrt(s);
         return (x - sin(x)) / (x * s);
       }},
      {"cotangent_defect", [](const T& s) { return T(cotangent_defect<T>(s)); },
       [](const Wide& s) -> Wide {
         const Wide half = sqrt(s) / 2;
         return (1 - half * cos(half) / sin(half)) / s;
       }},
      {"half cosine", [](const T& s) { return T(half_angle<T>(s).cosine); },
       [](const Wide& s) -> Wide { return cos(sqrt(s) / 2); }},
      {"half sine", [](const T& s) { return T(half_angle<T>(s).sine); },
       [](const Wide& s) -> Wide { return sin(sqrt(s) / 2) / sqrt(s); }},
      {"half_sine_slope", [](const T& s) { return T(half_sine_slope<T>(s)); },
       [](const Wide& s) -> Wide {
         const Wide x = sqrt(s), half = x / 2;
         return (sin(half) - half * cos(half)) / (x * s);
       }},
      {"versine_slope", [](const T& s) { return T(versine_slope<T>(s)); },
       [](const Wide& s) -> Wide {
         const Wide x = sqrt(s);
         return (2 - 2 * cos(x) - x * sin(x)) / (s * s);
       }},
      {"sine_defect_slope", [](const T& s) { return T(sine_defect_slope<T>(s)); },
       [](const Wide& s) -> Wide {
         const Wide x = sqrt(s);
         return (x * (2 + cos(x)) - 3 * sin(x)) / (x * s * s);
       }},
      {"cotangent_slope", [](const T& s) { return T(cotangent_slope<T>(s)); },
       [](const Wide& s) -> Wide {
         const Wide x = sqrt(s), sine = sin(x / 2);
         return (x * sin(x) + 4 * cos(x) + s - 4) / (4 * s * s * sine * sine);
       }},
  };
}

// x in (0, 2 pi): a coarse sweep, its small end, and powers of two steps around all thresholds.
std::vector<double> sweep() {
  std::vector<double> all;
  for (double x = 1e-15; x < 0.01; x *= 3.3) all.push_back(x);
  for (int i = 1; i < 625; ++i) all.push_back(0.01 * i);
  for (const double threshold : {0.5, 1.0, 2.0, 2.5, 3.5, 4.0})
    for (int exponent = -50; exponent <= -3; exponent += 2)
      for (const double sign : {-1.0, 1.0}) all.push_back(threshold * (1 + sign * std::ldexp(1.0, exponent)));
  return all;
}

// The largest error over the sweep in units of eps (|f| + |x^2 f'(x^2)|): relative where f is not close to a
// zero or pole (sinc at pi, versine and cotangent_defect at 2 pi), and elsewhere what the rounding of the
// angle sqrt(x^2) to eps leaves of the digits.
template <class T>
double largest_error(const Coefficient<T>& f, double eps, const std::vector<T>& squares) {
  double worst = 0;
  for (const T& s : squares) {
    const Wide exact = f.closed_form(to_wide(s));
    const Wide step("1e-15");
    const Wide slope = (f.closed_form(Wide(to_wide(s) * (1 + step))) - exact) / step;
    const Wide unit = eps * (abs(exact) + abs(slope));
    const Wide error = abs(to_wide(f.value(s)) - exact) / unit;
    worst = std::max(worst, static_cast<double>(error));
  }
  return worst;
}

// Two roundings of the argument (square root, half angle), sine, cosine and three operations: four eps.
TEST(RotationCoefficients, InDoubleAreThoseOfExtendedToFourEps) {
  const double eps = std::numeric_limits<double>::epsilon();
  const auto doubles = coefficients<double>();
  const auto extended = coefficients<Extended>();
  for (std::size_t i = 0; i < doubles.size(); ++i) {
    // The same scale as below, with the extended value in the place of the closed form.
    for (const double x : sweep()) {
      const double s = x * x;
      const Extended exact = extended[i].value(Extended(s));
      const double slope =
          to_double(Extended(extended[i].value(Extended(s) * (1.0 + 0x1p-40)) - exact)) * 0x1p40;
      const double unit = eps * (std::abs(to_double(exact)) + std::abs(slope));
      EXPECT_LE(std::abs(to_double(Extended(doubles[i].value(s) - exact))), 4 * unit)
          << doubles[i].name << ' ' << x;
    }
  }
}

TEST(RotationCoefficients, InDoubleAreTheirClosedFormsToFourEps) {
  std::vector<double> squares;
  for (const double x : sweep()) squares.push_back(x * x);
  for (const auto& f : coefficients<double>())
    EXPECT_LE(largest_error(f, std::numeric_limits<double>::epsilon(), squares), 4.0) << f.name;
}

TEST(RotationCoefficients, InExtendedAreTheirClosedFormsToAFewEps) {
  // Double-double operations err by up to two eps each.
  std::vector<Extended> squares;
  for (const double x : sweep()) squares.push_back(Extended(x) * Extended(x));
  for (const auto& f : coefficients<Extended>())
    EXPECT_LE(largest_error(f, to_double(Eigen::NumTraits<Extended>::epsilon()), squares), 8.0) << f.name;
}

TEST(RotationCoefficients, AtZeroAreTheLeadingTerms) {
  EXPECT_EQ(sinc_versine(0.0).sinc, 1.0);
  EXPECT_EQ(sinc_versine(0.0).versine, 0.5);
  EXPECT_EQ(sine_defect(0.0), 1.0 / 6.0);
  EXPECT_EQ(cotangent_defect(0.0), 1.0 / 12.0);
  EXPECT_EQ(half_angle(0.0).cosine, 1.0);
  EXPECT_EQ(half_angle(0.0).sine, 0.5);
  EXPECT_EQ(half_sine_slope(0.0), 1.0 / 24.0);
  EXPECT_EQ(versine_slope(0.0), 1.0 / 12.0);
  EXPECT_EQ(sine_defect_slope(0.0), 1.0 / 60.0);
  EXPECT_DOUBLE_EQ(cotangent_slope(0.0), 1.0 / 360.0);
  EXPECT_EQ(atan_ratio(0.0), 1.0);
  EXPECT_TRUE(sine_defect(Extended(0.0)) == Extended(1.0) / 6.0);
  EXPECT_TRUE(cotangent_defect(Extended(0.0)) == Extended(1.0) / 12.0);
}

TEST(RotationCoefficients, SeriesHaveTheCoefficientsOfTheDesign) {
  // the design notes, section 6, and the Bernoulli numbers: |B_2n| / (2n)!.
  const auto& c = detail::RotationSeries<double>::sine_defect;
  EXPECT_DOUBLE_EQ(c[1], -1.0 / 120);
  EXPECT_DOUBLE_EQ(c[4], 1.0 / 39916800);
  const auto& b = detail::RotationSeries<double>::versine;
  EXPECT_DOUBLE_EQ(b[3], -1.0 / 40320);
  const auto& d = detail::RotationSeries<double>::cotangent;
  EXPECT_DOUBLE_EQ(d[1], 1.0 / 720);
  EXPECT_DOUBLE_EQ(d[2], 1.0 / 30240);
  EXPECT_DOUBLE_EQ(d[3], 1.0 / 1209600);
  EXPECT_DOUBLE_EQ(d[4], 1.0 / 47900160);
  const auto& c3 = detail::RotationSeries<double>::versine_slope;
  EXPECT_DOUBLE_EQ(c3[1], -1.0 / 180);
  EXPECT_DOUBLE_EQ(c3[4], 1.0 / 47900160);
  const auto& c4 = detail::RotationSeries<double>::sine_defect_slope;
  EXPECT_DOUBLE_EQ(c4[1], -1.0 / 1260);
  EXPECT_DOUBLE_EQ(c4[4], 1.0 / 622702080);
  const auto& d2 = detail::RotationSeries<double>::cotangent_slope;
  EXPECT_DOUBLE_EQ(d2[1], 1.0 / 7560);
  EXPECT_DOUBLE_EQ(d2[4], 691.0 / 130767436800);
}

// The slopes are derivatives, whatever their formulas: by Jets of one variable, in both tiers and beyond.
TEST(RotationCoefficients, SlopesAreTheDerivatives) {
  using Jet = ceres::Jet<double, 1>;
  for (double x = 0.01; x < 6.2; x += 0.037) {
    const Jet square = Jet(x * x, 0);
    const auto expect = [x](double slope, const Jet& f, double sign) {
      const double derivative = 2 * sign * f.v(0);
      // The derivative of a closed form cancels by up to 1/x^2 > 1/4 where it is used.
      EXPECT_NEAR(slope, derivative, 256 * 2.3e-16 * (std::abs(slope) + std::abs(f.a))) << x;
    };
    expect(versine_slope(x * x), sinc_versine(square).versine, -1);
    expect(sine_defect_slope(x * x), sine_defect(square), -1);
    expect(cotangent_slope(x * x), cotangent_defect(square), 1);
    expect(half_sine_slope(x * x), half_angle(square).sine, -1);
  }
}

TEST(RotationCoefficients, AtanRatioHoldsUpToItsReach) {
  for (int i = 1; i <= 64; ++i) {
    const double t_squared = atan_series_reach * i / 64;
    const Wide t = sqrt(Wide(t_squared));
    const Wide exact = atan(t) / t;
    EXPECT_LE(abs(Wide(atan_ratio(t_squared)) / exact - 1), 2 * std::numeric_limits<double>::epsilon()) << i;
    EXPECT_LE(abs(to_wide(atan_ratio(Extended(t_squared))) / exact - 1),
              4 * to_double(Eigen::NumTraits<Extended>::epsilon()))
        << i;
  }
}

}  // namespace
}  // namespace liebench::rotation_coefficients_test
