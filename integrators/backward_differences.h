#pragma once

#include <array>
#include <cstddef>

namespace liebench {

// Formulas on at most seven equidistant points, those of a BDF method of six steps.
inline constexpr std::size_t most_points = 7;

// Weights w_j of the formula  h^d f^(d)(t + position h) ~ sum_{j=0}^{points-1} w_j f(t - j h), exact for polynomials of
// degree points - 1; zero beyond. Fornberg 1988 (Generation of finite difference formulas on arbitrarily spaced grids).
template <class T>
std::array<T, most_points> derivative_weights(int points, int derivative, double position) {
  const auto n = std::size_t(points);
  // delta[d][j]: weight of node j for derivative d with the nodes so far.
  std::array<std::array<T, most_points>, most_points> delta;
  for (auto& row : delta) row.fill(T(0.0));
  delta[0][0] = T(1.0);
  T c1 = T(1.0);
  for (std::size_t i = 1; i < n; ++i) {
    T c2 = T(1.0);
    for (std::size_t j = 0; j < i; ++j) {
      const T c3 = T(double(j) - double(i));  // x_i - x_j
      c2 = c2 * c3;
      for (std::size_t d = i + 1; d-- > 0;) {
        if (j + 1 == i) {
          const T lower = d > 0 ? delta[d - 1][i - 1] * T(double(d)) : T(0.0);
          delta[d][i] = c1 * (lower - T(-double(i - 1) - position) * delta[d][i - 1]) / c2;
        }
        const T lower = d > 0 ? delta[d - 1][j] * T(double(d)) : T(0.0);
        delta[d][j] = (T(-double(i) - position) * delta[d][j] - lower) / c3;
      }
    }
    c1 = c2;
  }
  return delta[std::size_t(derivative)];
}

// The same formula in backward differences, f(t) w + sum_i c_i (f(t - i h) - f(t - (i+1) h)), i = 0, ..., points - 2, where w
// is 1 for d = 0 and else 0: then a constant f gives exactly zero, whatever the rounding of c.
template <class T>
std::array<T, most_points> change_weights(int points, int derivative, double position) {
  const auto w = derivative_weights<T>(points, derivative, position);
  std::array<T, most_points> c;
  c.fill(T(0.0));
  T sum = T(0.0);  // of w_j, j > i
  for (std::size_t i = std::size_t(points) - 1; i-- > 0;) {
    sum = sum + w[i + 1];
    c[i] = -sum;
  }
  return c;
}

}  // namespace liebench
