#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "groups/scalar.h"

namespace liebench {

// LU factorization with partial pivoting of a small matrix of fixed size n, and its back-substitution. The
// loops over columns are unrolled at compile time, so that every block has a fixed size: for n = 9 a third of
// the instructions of Eigen's PartialPivLU (benchmarks/kernel_benchmark.cpp).
template <class T, int n>
class DenseLu {
 public:
  DenseLu() { lu_.setConstant(T(0.0)); }

  using Matrix = Eigen::Matrix<T, n, n>;
  using Vector = Eigen::Matrix<T, n, 1>;

  // False where a pivot is zero or not finite; the factors are then unusable.
  bool factorize(const Matrix& A) {
    lu_ = A;
    return [&]<std::size_t... j>(std::index_sequence<j...>) {
      return (eliminate<int(j)>() && ...);
    }
    (std::make_index_sequence<std::size_t(n)>{});
  }

  // x with A x = b.
  Vector solve(const Vector& b) const {
    Vector x = b;
    for (int j = 0; j < n; ++j) std::swap(x(j), x(pivots_[std::size_t(j)]));
    [&]<std::size_t... j>(std::index_sequence<j...>) {
      (substitute_forward<int(j)>(x), ...);
      (substitute_backward<n - 1 - int(j)>(x), ...);
    }
    (std::make_index_sequence<std::size_t(n)>{});
    return x;
  }

 private:
  template <int j>
  bool eliminate() {
    using std::abs;
    int pivot = j;
    T largest = abs(lu_(j, j));
    for (int i = j + 1; i < n; ++i)
      if (largest < abs(lu_(i, j))) {
        largest = abs(lu_(i, j));
        pivot = i;
      }
    pivots_[std::size_t(j)] = pivot;
    if (!(T(0.0) < largest) || !std::isfinite(to_double(largest))) return false;
    if (pivot != j) lu_.row(j).swap(lu_.row(pivot));
    const T inverse = T(1.0) / lu_(j, j);
    inverse_pivots_[std::size_t(j)] = inverse;
    constexpr int rest = n - 1 - j;
    if constexpr (rest > 0) {
      // Divided, not multiplied by the inverse: only so do two equal rows leave an exact zero.
      lu_.col(j).template tail<rest>() /= lu_(j, j);
      for (int c = j + 1; c < n; ++c)
        lu_.col(c).template tail<rest>() -= lu_(j, c) * lu_.col(j).template tail<rest>();
    }
    return true;
  }

  template <int j>
  void substitute_forward(Vector& x) const {
    constexpr int rest = n - 1 - j;
    if constexpr (rest > 0) x.template tail<rest>() -= x(j) * lu_.col(j).template tail<rest>();
  }

  template <int j>
  void substitute_backward(Vector& x) const {
    x(j) *= inverse_pivots_[std::size_t(j)];
    if constexpr (j > 0) x.template head<j>() -= x(j) * lu_.col(j).template head<j>();
  }

  Matrix lu_;
  std::array<T, std::size_t(n)> inverse_pivots_{};
  std::array<int, std::size_t(n)> pivots_{};
};

}  // namespace liebench
