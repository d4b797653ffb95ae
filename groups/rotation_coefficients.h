#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

#include "groups/scalar.h"

// The scalar functions of the rotation angle x that exp and the tangent operators of rotation groups need,
// as functions of x^2 so that they are smooth (and differentiable by Jets) at x = 0:
//
//   sinc(x^2)      sin x / x
//   versine(x^2)   b = (1 - cos x) / x^2
//   sine_defect    c = (x - sin x) / x^3
//   cotangent_defect  d = (1 - (x/2) cot(x/2)) / x^2
//   half_angle     cos(x/2) and sin(x/2) / x
//   atan_ratio(t^2)   atan(t) / t
//
// and their slopes in the direction of the rotation vector, (1/x) d/dx = 2 d/d(x^2), which rigid motions need:
//
//   versine_slope      c3 = -(1/x) db/dx = (2 - 2 cos x - x sin x) / x^4
//   sine_defect_slope  c4 = -(1/x) dc/dx = (x (2 + cos x) - 3 sin x) / x^5
//   cotangent_slope    d2 =  (1/x) dd/dx
//   half_sine_slope    -(1/x) d/dx (sin(x/2) / x) = (sin(x/2) - (x/2) cos(x/2)) / x^3
//
// Each is a power series below a threshold and a closed form above it. The closed forms of c and d cancel by
// the factors x/(x - sin x) and 1/(x^2 d): 6.3 and 12 at x = 1, below 2 and 3 from x = 2 on, so their series
// reach to x = 2, where no digit is lost. (Thresholds of 1e-4 to 1e-2, found in public codes, lose up to 8
// digits of c.) A first, shorter tier up to x = 1/2 serves small steps: no square root, no sine. The slopes
// cancel more and have series that reach further.

namespace liebench {

namespace detail {

// Term counts for 53 bits and for 106 bits: the first omitted term is below the unit round-off relative to
// the first.
template <class T>
inline constexpr std::size_t short_terms = ScalarTraits<T>::extended ? 15 : 9;
template <class T>
inline constexpr std::size_t long_terms = ScalarTraits<T>::extended ? 36 : 18;
template <class T>
inline constexpr std::size_t slope_terms = ScalarTraits<T>::extended ? 70 : 36;  // of d2, up to x = 7/2

// (-1)^i / (2 i + offset)!
template <class T, int offset, std::size_t terms>
constexpr auto alternating_factorials() {
  using C = typename ScalarTraits<T>::Coefficient;
  std::array<C, terms> a{};
  C value = C(1.0);
  for (int j = 2; j <= offset; ++j) value = value / C(double(j));
  for (std::size_t i = 0; i < terms; ++i) {
    a[i] = value;
    value = -value / (C(double(2 * i + offset + 1)) * C(double(2 * i + offset + 2)));
  }
  return a;
}

// |B_{2n}| / (2n)!, n = 1, 2, ...: (2n+1) d_n = sum_{k=1}^{n-1} d_k d_{n-k}, d_1 = 1/12. All terms are
// positive (Euler's identity for zeta(2n)), so the recursion is stable.
template <class T, std::size_t terms>
constexpr auto cotangent_series() {
  using C = typename ScalarTraits<T>::Coefficient;
  std::array<C, terms> d{};
  d[0] = C(1.0) / C(12.0);
  for (std::size_t n = 2; n <= terms; ++n) {
    C sum = C(0.0);
    for (std::size_t k = 1; k < n; ++k) sum = sum + d[k - 1] * d[n - k - 1];
    d[n - 1] = sum / C(double(2 * n + 1));
  }
  return d;
}

// (-1)^i / (2 i + 1)
template <class T, std::size_t terms>
constexpr auto atan_series() {
  using C = typename ScalarTraits<T>::Coefficient;
  std::array<C, terms> a{};
  for (std::size_t i = 0; i < terms; ++i) a[i] = C(i % 2 == 0 ? 1.0 : -1.0) / C(double(2 * i + 1));
  return a;
}

// The coefficients of factor da/ds from those of a(s), one fewer.
template <std::size_t terms>
constexpr auto slope_series(const auto& a, double factor) {
  std::array<std::decay_t<decltype(a[0])>, terms> slope{};
  for (std::size_t i = 0; i < terms; ++i) slope[i] = a[i + 1] * (factor * double(i + 1));
  return slope;
}

// Constant-initialised for double; initialised before main for extended scalars.
template <class T>
struct RotationSeries {
  static constexpr std::size_t n = long_terms<T>, slope_n = slope_terms<T>;
  inline static const auto sine = alternating_factorials<T, 1, n>();
  inline static const auto versine = alternating_factorials<T, 2, n>();
  inline static const auto sine_defect = alternating_factorials<T, 3, n>();
  inline static const auto cotangent = cotangent_series<T, n>();
  inline static const auto cosine = alternating_factorials<T, 0, n>();
  inline static const auto atan = atan_series<T, n>();
  inline static const auto sine_slope = slope_series<n>(alternating_factorials<T, 1, n + 1>(), -2.0);
  inline static const auto versine_slope = slope_series<n>(alternating_factorials<T, 2, n + 1>(), -2.0);
  inline static const auto sine_defect_slope = slope_series<n>(alternating_factorials<T, 3, n + 1>(), -2.0);
  inline static const auto cotangent_slope = slope_series<slope_n>(cotangent_series<T, slope_n + 1>(), 2.0);
};

template <std::size_t terms, class T, class Coefficients>
T horner(const Coefficients& a, const T& x) {
  T value(a[terms - 1]);
  for (std::size_t i = terms - 1; i-- > 0;) value = value * x + a[i];
  return value;
}

inline constexpr double short_reach = 0.25;              // x <= 1/2
inline constexpr double long_reach = 4.0;                // x <= 2
inline constexpr double sine_defect_slope_reach = 6.25;  // x <= 5/2
inline constexpr double cotangent_slope_reach = 12.25;   // x <= 7/2

}  // namespace detail

// sin x / x and (1 - cos x) / x^2 = 2 (sin(x/2) / x)^2 for x^2 = x_squared >= 0.
template <class T>
struct SincVersine {
  T sinc, versine;
};

namespace detail {

// Out of line, so that the short series of small steps is inlined where it is used.
template <class T>
[[gnu::noinline]] SincVersine<T> large_sinc_versine(const T& x_squared) {
  using std::sin, std::sqrt;
  const T x = sqrt(x_squared);
  const T half = sin(x * T(0.5)) / x;
  return {sin(x) / x, half * half * T(2.0)};
}

}  // namespace detail

template <class T>
SincVersine<T> sinc_versine(const T& x_squared) {
  using Series = detail::RotationSeries<T>;
  if (x_squared < detail::short_reach)
    return {detail::horner<detail::short_terms<T>>(Series::sine, x_squared),
            detail::horner<detail::short_terms<T>>(Series::versine, x_squared)};
  return detail::large_sinc_versine(x_squared);
}

// c = (x - sin x) / x^3 for x^2 = x_squared >= 0.
template <class T>
T sine_defect(const T& x_squared) {
  using std::sin, std::sqrt;
  using Series = detail::RotationSeries<T>;
  if (x_squared < detail::short_reach)
    return detail::horner<detail::short_terms<T>>(Series::sine_defect, x_squared);
  if (x_squared < detail::long_reach)
    return detail::horner<detail::long_terms<T>>(Series::sine_defect, x_squared);
  const T x = sqrt(x_squared);
  return (x - sin(x)) / (x * x_squared);
}

// d = (1 - (x/2) cot(x/2)) / x^2 for 0 <= x^2 = x_squared < (2 pi)^2.
template <class T>
T cotangent_defect(const T& x_squared) {
  using std::cos, std::sin, std::sqrt;
  using Series = detail::RotationSeries<T>;
  if (x_squared < detail::short_reach)
    return detail::horner<detail::short_terms<T>>(Series::cotangent, x_squared);
  if (x_squared < detail::long_reach)
    return detail::horner<detail::long_terms<T>>(Series::cotangent, x_squared);
  const T half = sqrt(x_squared) * T(0.5);
  return (T(1.0) - half * cos(half) / sin(half)) / x_squared;
}

// cos(x/2) and sin(x/2) / x for x^2 = x_squared >= 0. Series in (x/2)^2, up to x = 1.
template <class T>
struct HalfAngle {
  T cosine, sine;
};

template <class T>
HalfAngle<T> half_angle(const T& x_squared) {
  using std::cos, std::sin, std::sqrt;
  using Series = detail::RotationSeries<T>;
  const T quarter = x_squared * 0.25;
  if (quarter < detail::short_reach)
    return {detail::horner<detail::short_terms<T>>(Series::cosine, quarter),
            detail::horner<detail::short_terms<T>>(Series::sine, quarter) * 0.5};
  const T x = sqrt(x_squared), half = x * 0.5;
  return {cos(half), sin(half) / x};
}

// (sin(x/2) - (x/2) cos(x/2)) / x^3 for x^2 = x_squared >= 0. Series in (x/2)^2, up to x = 4, where the two
// terms have opposite signs.
template <class T>
T half_sine_slope(const T& x_squared) {
  using std::cos, std::sin, std::sqrt;
  using Series = detail::RotationSeries<T>;
  const T quarter = x_squared * 0.25;
  if (quarter < detail::short_reach)
    return detail::horner<detail::short_terms<T>>(Series::sine_slope, quarter) * 0.125;
  if (quarter < detail::long_reach)
    return detail::horner<detail::long_terms<T>>(Series::sine_slope, quarter) * 0.125;
  const T x = sqrt(x_squared), half = x * 0.5;
  return (sin(half) - half * cos(half)) / (x * x_squared);
}

// c3 = (2 - 2 cos x - x sin x) / x^4 for x^2 = x_squared >= 0. Its numerator is
// 4 sin(x/2) (sin(x/2) - (x/2) cos(x/2)): nothing cancels beyond what half_sine_slope takes care of.
template <class T>
T versine_slope(const T& x_squared) {
  using Series = detail::RotationSeries<T>;
  if (x_squared < detail::short_reach)
    return detail::horner<detail::short_terms<T>>(Series::versine_slope, x_squared);
  return half_angle<T>(x_squared).sine * half_sine_slope<T>(x_squared) * 4.0;
}

// c4 = (x (2 + cos x) - 3 sin x) / x^5 for x^2 = x_squared >= 0. The closed form cancels by the factor 7 at
// x = 2 and 2.5 at x = 5/2, where the series ends.
template <class T>
T sine_defect_slope(const T& x_squared) {
  using std::cos, std::sin, std::sqrt;
  using Series = detail::RotationSeries<T>;
  if (x_squared < detail::short_reach)
    return detail::horner<detail::short_terms<T>>(Series::sine_defect_slope, x_squared);
  if (x_squared < detail::sine_defect_slope_reach)
    return detail::horner<detail::long_terms<T>>(Series::sine_defect_slope, x_squared);
  const T x = sqrt(x_squared);
  return (x * (cos(x) + 2.0) - sin(x) * 3.0) / (x * x_squared * x_squared);
}

// d2 = (1/x) dd/dx for 0 <= x^2 = x_squared < (2 pi)^2. With cot' = -1 - cot^2 the closed form is
// (1/4 - 3 d + x^2 d^2) / x^2. Its derivative by d vanishes where x^2 d = 3/2, near x = 3.7, so that the
// error of d hardly enters where the series ends; it cancels by the factor 5 there, and less beyond.
template <class T>
T cotangent_slope(const T& x_squared) {
  using Series = detail::RotationSeries<T>;
  if (x_squared < detail::short_reach)
    return detail::horner<detail::short_terms<T>>(Series::cotangent_slope, x_squared);
  if (x_squared < detail::cotangent_slope_reach)
    return detail::horner<detail::slope_terms<T>>(Series::cotangent_slope, x_squared);
  const T d = cotangent_defect<T>(x_squared);
  return (T(0.25) - d * 3.0 + x_squared * d * d) / x_squared;
}

// atan(t) / t for t^2 = t_squared <= 1/64, by its series.
inline constexpr double atan_series_reach = 1.0 / 64.0;

template <class T>
T atan_ratio(const T& t_squared) {
  constexpr std::size_t terms = ScalarTraits<T>::extended ? 18 : 9;
  return detail::horner<terms>(detail::RotationSeries<T>::atan, t_squared);
}

}  // namespace liebench
