#pragma once

#include <concepts>

// What the templates of groups, problems and integrators ask of a scalar beyond arithmetic.

namespace liebench {

// A real scalar: double, dd_real, a Boost.Multiprecision number, ceres::Jet or a counting scalar. Elementary
// functions are found by argument-dependent lookup beside `using std::...`.
template <class T>
concept Scalar = std::constructible_from<T, double> && requires(T a, T b) {
  { a + b } -> std::convertible_to<T>;
  { a* b } -> std::convertible_to<T>;
  { a / b } -> std::convertible_to<T>;
  { a < b } -> std::convertible_to<bool>;
};

// Properties that a scalar's own header specialises where the defaults (a 53-bit scalar, or one built on it)
// differ.
template <class T>
struct ScalarTraits {
  using Coefficient = double;  // holds the coefficients of a power series to the scalar's own precision
  static constexpr bool extended = false;  // more than 64 bits
  using Linear = double;  // Newton matrices and what is solved with them: the scalar is left to refinement
};

// The scalar of the linear algebra of a run in T.
template <class T>
using LinearScalar = typename ScalarTraits<T>::Linear;

// The value nearest to x as a double, for norms, tolerances and output.
inline double to_double(double x) {
  return x;
}

// x in the scalar of the linear algebra.
template <class T>
LinearScalar<T> to_linear(const T& x) {
  if constexpr (std::same_as<T, LinearScalar<T>>)
    return x;
  else
    return to_double(x);
}

}  // namespace liebench
