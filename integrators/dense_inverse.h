#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "groups/scalar.h"

namespace liebench {

// The inverse of a matrix of at most `most` rows in its own place, by Gauss-Jordan elimination with partial pivoting; `a` holds n x n
// numbers column by column. False where a pivot is zero or not finite; the matrix is spoilt then. For matrices that are applied many
// times: a product takes what a back-substitution does, without its chain of divisions.
template <std::size_t most, class T>
bool invert(T* a, std::size_t n) {
  using std::abs;
  const auto at = [&](std::size_t i, std::size_t j) -> T& { return a[j * n + i]; };
  std::array<std::size_t, most> pivots{};
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (abs(at(pivot, k)) < abs(at(i, k))) pivot = i;
    const T value = at(pivot, k);
    if (!(T(0.0) < abs(value)) || !std::isfinite(to_double(value))) return false;
    pivots[k] = pivot;
    if (pivot != k)
      for (std::size_t j = 0; j < n; ++j) std::swap(at(k, j), at(pivot, j));
    at(k, k) = T(1.0);
    for (std::size_t j = 0; j < n; ++j) at(k, j) /= value;
    std::array<T, most> column;
    for (std::size_t i = 0; i < n; ++i) {
      column[i] = i == k ? T(0.0) : at(i, k);
      if (i != k) at(i, k) = T(0.0);
    }
    for (std::size_t j = 0; j < n; ++j) {
      const T factor = at(k, j);
      for (std::size_t i = 0; i < n; ++i) at(i, j) -= column[i] * factor;
    }
  }
  for (std::size_t k = n; k-- > 0;)
    if (pivots[k] != k)
      for (std::size_t i = 0; i < n; ++i) std::swap(at(i, k), at(i, pivots[k]));
  return true;
}

}  // namespace liebench
