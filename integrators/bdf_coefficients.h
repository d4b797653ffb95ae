#pragma once

#include <array>
#include <cstddef>

#include "groups/scalar.h"

namespace liebench {

// Coefficients of the k-step BDF method, 1 <= k <= 6 (those are zero-stable), to the scalar's own precision:
//   alpha_0 ... alpha_k   (1/h) sum_{i=0}^k alpha_i x_{n+1-i} = x'_{n+1}, eqs. (2) and (3)
//   gamma_1 ... gamma_k   gamma_i = sum_{j=0}^{i-1} alpha_j, eq. (5); gamma[0] is gamma_1
// and zero beyond.
template <class T>
struct BdfCoefficients {
  static constexpr int most_steps = 6;
  std::array<T, most_steps + 1> alpha;
  std::array<T, most_steps> gamma;
};

// From the backward differences, sum_{j=1}^k (1/j) nabla^j: alpha_i = (-1)^i sum_{j>=max(i,1)} binomial(j, i)
// / j. The sums are over integers (times 60 = lcm(1..6)), so that each coefficient is rounded once.
template <class T>
BdfCoefficients<T> bdf_coefficients(int k) {
  BdfCoefficients<T> c;
  c.alpha.fill(T(0.0));
  c.gamma.fill(T(0.0));
  long partial = 0;
  for (int i = 0; i <= k; ++i) {
    long sixtieths = 0;
    for (int j = i > 1 ? i : 1; j <= k; ++j) {
      long binomial = 1;
      for (int m = 1; m <= i; ++m) binomial = binomial * (j - m + 1) / m;
      sixtieths += (i % 2 == 0 ? 1 : -1) * binomial * (60 / j);
    }
    c.alpha[std::size_t(i)] = T(double(sixtieths)) / T(60.0);
    partial += sixtieths;
    if (i < k) c.gamma[std::size_t(i)] = T(double(partial)) / T(60.0);
  }
  return c;
}

}  // namespace liebench
