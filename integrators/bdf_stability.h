#pragma once

#include <array>
#include <complex>
#include <cstddef>

#include "integrators/bdf_coefficients.h"

namespace liebench {

// Whether the BDF method of order k, 1 <= k <= 6, lets no solution of x' = mu x grow in constant steps h, z = h mu: whether all roots
// of its characteristic polynomial
//
//   p(zeta) = sum_{i=0}^k alpha_i zeta^{k-i} - z zeta^k
//
// lie inside the unit circle. By Schur and Cohn's recursion, which needs none of them: they do where the first coefficient is larger
// than the last and where those of (conj(p_0) p - p_k p^*) / zeta do, p^* with conjugate coefficients in reversed order, of degree
// k - 1 [Henrici 1974, Applied and Computational Complex Analysis I, section 6.8].
inline bool bdf_is_stable(int k, std::complex<double> z) {
  using Complex = std::complex<double>;
  const BdfCoefficients<double> c = bdf_coefficients<double>(k);
  std::array<Complex, BdfCoefficients<double>::most_steps + 1> p{};  // highest power first
  for (std::size_t i = 0; i <= std::size_t(k); ++i) p[i] = c.alpha[i];
  p[0] -= z;
  for (auto degree = std::size_t(k); degree > 0; --degree) {
    const Complex first = p[0], last = p[degree];
    if (!(std::norm(last) < std::norm(first))) return false;
    const auto before = p;
    // The constant term vanishes.
    for (std::size_t i = 0; i < degree; ++i)
      p[i] = (std::conj(first) * before[i] - last * std::conj(before[degree - i])) / std::norm(first);
  }
  return true;
}

}  // namespace liebench
