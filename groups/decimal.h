#pragma once

#include <Eigen/Core>
#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <string>

#include "groups/scalar.h"

// The number that a double of a problem's data stands for. A study says -4.61538 and means -461538/100000;
// the double nearest to it is 2e-16 away, which an extended-precision run sees from the seventeenth digit on.
// The rule of liebench: a double of the data means its shortest decimal, the shortest one that rounds to that
// double.

namespace liebench {

namespace detail {

// x = mantissa * 10^exponent, the shortest decimal that rounds to the finite x; |mantissa| < 10^17.
struct ShortestDecimal {
  std::int64_t mantissa = 0;
  int exponent = 0;
};

inline std::string shortest_decimal_text(double x) {
  std::array<char, 32> text;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::scientific).ptr;
  return {text.data(), end};
}

inline ShortestDecimal shortest_decimal(double x) {
  const std::string text = shortest_decimal_text(x);
  const std::size_t e = text.find('e');
  ShortestDecimal d;
  int fraction_digits = 0;
  bool after_point = false;
  for (std::size_t i = 0; i < e; ++i) {
    if (text[i] == '.') after_point = true;
    if (text[i] < '0' || text[i] > '9') continue;
    d.mantissa = 10 * d.mantissa + (text[i] - '0');
    if (after_point) ++fraction_digits;
  }
  d.exponent = std::stoi(text.substr(e + 1)) - fraction_digits;
  if (text.front() == '-') d.mantissa = -d.mantissa;
  return d;
}

}  // namespace detail

// The shortest decimal that rounds to x, as a T.
//   double                              x itself
//   a type with a Scalar member         (ceres::Jet) T(decimal<Scalar>(x)), a constant
//   one whose traits read a decimal     (Extended) ScalarTraits<T>::decimal(x)
//   a number built from a string        (Boost.Multiprecision) its own rounding of the decimal
//   any other of at most 53 bits        T(x)
// An infinity or NaN is passed on as T(x).
template <class T>
T decimal(double x) {
  if constexpr (std::same_as<T, double>) {
    return x;
  } else if constexpr (requires { typename T::Scalar; }) {
    return T(decimal<typename T::Scalar>(x));
  } else if constexpr (requires { ScalarTraits<T>::decimal(x); }) {
    return ScalarTraits<T>::decimal(x);
  } else if constexpr (std::constructible_from<T, std::string>) {
    return std::isfinite(x) ? T(detail::shortest_decimal_text(x)) : T(x);
  } else {
    static_assert(std::numeric_limits<T>::digits <= std::numeric_limits<double>::digits,
                  "decimal<T>: say here how a wider T reads a decimal");
    return T(x);
  }
}

template <class T>
Eigen::Matrix<T, 3, 1> decimal_vector(const Eigen::Vector3d& v) {
  return {decimal<T>(v(0)), decimal<T>(v(1)), decimal<T>(v(2))};
}

template <class T>
Eigen::Matrix<T, 3, 3> decimal_matrix(const Eigen::Matrix3d& m) {
  Eigen::Matrix<T, 3, 3> result;
  for (Eigen::Index i = 0; i < 3; ++i)
    for (Eigen::Index j = 0; j < 3; ++j) result(i, j) = decimal<T>(m(i, j));
  return result;
}

}  // namespace liebench
