#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace liebench {

// Radau IIA with 3 stages, of order 5 [Hairer & Wanner, Solving ODE II, IV.5, table 5.6]; its inverse; and what its collocation
// polynomials are a step further.
template <class T>
struct RadauCoefficients {
  static constexpr std::size_t stages = 3;
  using Row = std::array<T, stages>;
  using Matrix = std::array<Row, stages>;

  Row c{};
  Matrix a{}, inverse{};
  // Of p(0) = 0 and p(c_j): p(1 + c_i) - p(1); of p(c_j) alone: p(1 + c_i).
  Matrix next_change{}, next_value{};

  RadauCoefficients() {
    using std::sqrt;
    const T r = sqrt(T(6.0));
    const auto over = [&](double rational, double times_root, double denominator) {
      return T((T(rational) + T(times_root) * r) / T(denominator));
    };
    c = {over(4, -1, 10), over(4, 1, 10), T(1.0)};
    a = {{{over(88, -7, 360), over(296, -169, 1800), over(-2, 3, 225)},
          {over(296, 169, 1800), over(88, 7, 360), over(-2, -3, 225)},
          {over(16, -1, 36), over(16, 1, 36), T(1.0) / T(9.0)}}};
    inverse = {{{over(4, 1, 2), over(-36, 29, 30), over(6, -4, 15)},
                {over(-36, -29, 30), over(4, -1, 2), over(6, 4, 15)},
                {over(-3, 8, 3), over(-3, -8, 3), T(5.0)}}};
    for (std::size_t i = 0; i < stages; ++i)
      for (std::size_t j = 0; j < stages; ++j) {
        const T x = T(1.0) + c[i];
        T value(1.0);
        for (std::size_t k = 0; k < stages; ++k)
          if (k != j) value *= (x - c[k]) / (c[j] - c[k]);
        next_value[i][j] = value;
        next_change[i][j] = value * x / c[j] - T(j == stages - 1 ? 1.0 : 0.0);
      }
  }
};

}  // namespace liebench
