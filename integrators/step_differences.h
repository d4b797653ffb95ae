#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace liebench {

// Differences of a sequence on points t_{n+1}, t_n, ... that are h_1, h_2, ... apart, from its slopes
// x_i = (U(t_{n+2-i}) - U(t_{n+1-i})) / h_i, i = 1, 2, ... With Delta_i = h_1 + ... + h_i they are, l = 0, 1, ...,
//
//   phi_l = Delta_1 ... Delta_l U[t_{n+1}, ..., t_{n-l}] = sum_{i=1}^{l+1} D_{l,i} x_i
//
// and so Newton's formula for the polynomial through the k + 1 newest points is, at t_{n+1},
//
//   U'(t_{n+1}) = sum_{l=0}^{k-1} phi_l = sum_{i=1}^k gamma_i x_i,   gamma_i = sum_{l=0}^{k-1} D_{l,i}
//
// the BDF formula of order k for any steps [Hairer, Norsett & Wanner, Solving ODE I, III.5]: alpha_0 = gamma_1 / h_1,
// its error is phi_k + phi_{k+1} + ..., and phi_l = 0 predicts x_1 from x_2, ..., x_{l+1}.
template <class T>
struct StepDifferences {
  static constexpr std::size_t most = 5;  // slopes
  // D_{l,i} by [l][i - 1].
  std::array<std::array<T, most>, most> D;
  // sum_i D_{l,i} h_i^2 and sum_i D_{l,i} h_i^2 (m_i - t_{n+1}), m_i the middle of the i-th step.
  std::array<T, most> square_moment, cubic_moment;
  std::array<T, most> middle;  // m_i - t_{n+1}

  // From h_1, h_2, ..., at most `most` of them; what belongs to more is zero.
  explicit StepDifferences(std::span<const T> steps) {
    const std::size_t n = steps.size();
    // Of U[t_{n+1-a}, ..., t_{n+1-a-l}] in x, row a.
    std::array<std::array<T, most>, most> divided;
    for (auto* rows : {&D, &divided})
      for (auto& row : *rows) row.fill(T(0.0));
    for (auto* moments : {&square_moment, &cubic_moment, &middle}) moments->fill(T(0.0));
    std::array<T, most> ends;  // t_{n+1} - t_{n+1-i}
    T end(0.0);
    for (std::size_t i = 0; i < n; ++i) {
      divided[i][i] = T(1.0);
      middle[i] = -(end + steps[i] / T(2.0));
      end = end + steps[i];
      ends[i] = end;
    }
    T product(1.0);
    for (std::size_t l = 0; l < n; ++l) {
      for (std::size_t i = 0; i <= l; ++i) {
        D[l][i] = product * divided[0][i];
        const T moment = D[l][i] * (steps[i] * steps[i]);
        square_moment[l] = square_moment[l] + moment;
        cubic_moment[l] = cubic_moment[l] + moment * middle[i];
      }
      product = product * ends[l];
      for (std::size_t a = 0; a + l + 1 < n; ++a) {
        const T width = a == 0 ? ends[l + 1] : T(ends[a + l + 1] - ends[a - 1]);
        for (std::size_t i = a; i <= a + l + 1; ++i)
          divided[a][i] = (divided[a][i] - divided[a + 1][i]) / width;
      }
    }
  }
};

}  // namespace liebench
