#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "groups/scalar.h"

namespace liebench {

// LU factorization with partial pivoting of a small matrix of fixed size n, and its back-substitution. The
// loops over columns are unrolled at compile time, so that every inner loop has a fixed length: for n = 9 a third of
// the instructions of Eigen's PartialPivLU (benchmarks/kernel_benchmark.cpp). Plain loops, for Eigen's blocks of fixed size
// would be as many types to compile.
template <class T, int n>
class DenseLu {
 public:
  DenseLu() { lu_.setConstant(T(0.0)); }

  using Matrix = Eigen::Matrix<T, n, n>;
  using Vector = Eigen::Matrix<T, n, 1>;

  // False where a pivot is zero or not finite; the factors are then unusable.
  bool factorize(const Matrix& A) {
    lu_ = A;
    std::iota(rows_.begin(), rows_.end(), 0);
    return [&]<std::size_t... j>(std::index_sequence<j...>) {
      return (eliminate<int(j)>() && ...);
    }
    (std::make_index_sequence<std::size_t(n)>{});
  }

  // x with A x = b. Entry by entry with all indices known at compile time, so that x stays in registers: packets of two
  // would start at another row in every column and so read across what was just stored, which stalls the processor.
  Vector solve(const Vector& b) const {
    return [&]<std::size_t... j>(std::index_sequence<j...>) {
      std::array<T, std::size_t(n)> x{b(rows_[j])...};
      (substitute_forward<j>(x, std::make_index_sequence<std::size_t(n) - 1 - j>{}), ...);
      (substitute_backward<std::size_t(n) - 1 - j>(x, std::make_index_sequence<std::size_t(n) - 1 - j>{}),
       ...);
      return Vector(Eigen::Map<const Vector>(x.data()));
    }
    (std::make_index_sequence<std::size_t(n)>{});
  }

 private:
  // The matrix column by column, as Eigen stores it.
  T* column(int j) { return lu_.data() + j * n; }
  const T* column(int j) const { return lu_.data() + j * n; }

  template <int j>
  bool eliminate() {
    using std::abs;
    T* const pivot_column = column(j);
    int pivot = j;
    T largest = abs(pivot_column[j]);
    for (int i = j + 1; i < n; ++i) {
      const T size = abs(pivot_column[i]);
      if (largest < size) {
        largest = size;
        pivot = i;
      }
    }
    if (!(T(0.0) < largest) || !std::isfinite(to_double(largest))) return false;
    if (pivot != j) {
      for (int c = 0; c < n; ++c) std::swap(column(c)[j], column(c)[pivot]);
      std::swap(rows_[std::size_t(j)], rows_[std::size_t(pivot)]);
    }
    inverse_pivots_[std::size_t(j)] = T(1.0) / pivot_column[j];
    // Divided, not multiplied by the inverse: only so do two equal rows leave an exact zero.
    for (int i = j + 1; i < n; ++i) pivot_column[i] /= pivot_column[j];
    for (int c = j + 1; c < n; ++c) {
      T* const changed = column(c);
      const T factor = changed[j];
      for (int i = j + 1; i < n; ++i) changed[i] -= factor * pivot_column[i];
    }
    return true;
  }

  template <std::size_t j, std::size_t... i>
  void substitute_forward(std::array<T, std::size_t(n)>& x, std::index_sequence<i...>) const {
    ((x[j + 1 + i] -= x[j] * column(int(j))[j + 1 + i]), ...);
  }

  template <std::size_t j, std::size_t... i>
  void substitute_backward(std::array<T, std::size_t(n)>& x, std::index_sequence<i...>) const {
    x[j] *= inverse_pivots_[j];
    ((x[i] -= x[j] * column(int(j))[i]), ...);
  }

  Matrix lu_;
  std::array<T, std::size_t(n)> inverse_pivots_{};
  std::array<int, std::size_t(n)> rows_{};  // rows_[i]: the row of A that pivoting brought to place i
};

}  // namespace liebench
