#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "groups/scalar.h"

// The scalar functions of the rotation angle x that exp and the tangent operators of rotation groups need,
// as functions of x^2 so that they are smooth (and differentiable by Jets) at x = 0:
//
//   sinc(x^2)      sin x / x
//   versine(x^2)   b = (1 - cos x) / x^2
//   sine_defect    c = (x - sin x) / x^3
//   cotangent_defect  d = (1 - (x/2) cot(x/2)) / x^2
//   atan_ratio(t^2)   atan(t) / t
//
// Each is a power series below a threshold and a closed form above it. The closed forms of c and d cancel by
// the factors x/(x - sin x) and 1/(x^2 d): 6.3 and 12 at x = 1, below 2 and 3 from x = 2 on, so their series
// reach to x = 2, where no digit is lost. (Thresholds of 1e-4 to 1e-2, found in public codes, lose up to 8
// digits of c.) A first, shorter tier up to x = 1/2 serves small steps: no square root, no sine.

namespace liebench {

namespace detail {

// Term counts for 53 bits and for 106 bits: the first omitted term is below the unit round-off relative to
// the first.
template <class T>
inline constexpr std::size_t short_terms = ScalarTraits<T>::extended ? 15 : 9;
template <class T>
inline constexpr std::size_t long_terms = ScalarTraits<T>::extended ? 36 : 18;

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

// Constant-initialised for double; initialised before main for extended scalars.
template <class T>
struct RotationSeries {
  static constexpr std::size_t n = long_terms<T>;
  inline static const auto sine = alternating_factorials<T, 1, n>();
  inline static const auto versine = alternating_factorials<T, 2, n>();
  inline static const auto sine_defect = alternating_factorials<T, 3, n>();
  inline static const auto cotangent = cotangent_series<T, n>();
  inline static const auto atan = atan_series<T, n>();
};

template <std::size_t terms, class T, class Coefficients>
T horner(const Coefficients& a, const T& x) {
  T value(a[terms - 1]);
  for (std::size_t i = terms - 1; i-- > 0;) value = value * x + a[i];
  return value;
}

inline constexpr double short_reach = 0.25;  // x <= 1/2
inline constexpr double long_reach = 4.0;    // x <= 2

}  // namespace detail

// sin x / x and (1 - cos x) / x^2 = 2 (sin(x/2) / x)^2 for x^2 = x_squared >= 0.
template <class T>
struct SincVersine {
  T sinc, versine;
};

template <class T>
SincVersine<T> sinc_versine(const T& x_squared) {
  using std::sin, std::sqrt;
  using Series = detail::RotationSeries<T>;
  if (x_squared < detail::short_reach)
    return {detail::horner<detail::short_terms<T>>(Series::sine, x_squared),
            detail::horner<detail::short_terms<T>>(Series::versine, x_squared)};
  const T x = sqrt(x_squared);
  const T half = sin(x * 0.5) / x;
  return {sin(x) / x, half * half * 2.0};
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
  const T half = sqrt(x_squared) * 0.5;
  return (T(1.0) - half * cos(half) / sin(half)) / x_squared;
}

// atan(t) / t for t^2 = t_squared <= 1/64, by its series.
inline constexpr double atan_series_reach = 1.0 / 64.0;

template <class T>
T atan_ratio(const T& t_squared) {
  constexpr std::size_t terms = ScalarTraits<T>::extended ? 18 : 9;
  return detail::horner<terms>(detail::RotationSeries<T>::atan, t_squared);
}

}  // namespace liebench
