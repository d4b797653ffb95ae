#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

namespace liebench::floors {

// LU factorization with partial pivoting and back-substitution by plain loops over fixed bounds. a[j] is column j.
template <int n>
struct Lu {
  double a[n][n];
  double inverse_pivot[n];
  int row[n];  // row[i]: the row of the matrix that pivoting brought to place i

  // Factorizes a in place; false where a pivot is zero or not finite.
  bool factorize() {
    for (int i = 0; i < n; ++i) row[i] = i;
    for (int j = 0; j < n; ++j) {
      int pivot = j;
      double largest = std::abs(a[j][j]);
      for (int i = j + 1; i < n; ++i)
        if (largest < std::abs(a[j][i])) {
          largest = std::abs(a[j][i]);
          pivot = i;
        }
      if (!(0.0 < largest) || !std::isfinite(largest)) return false;
      if (pivot != j) {
        for (int c = 0; c < n; ++c) std::swap(a[c][j], a[c][pivot]);
        std::swap(row[j], row[pivot]);
      }
      inverse_pivot[j] = 1.0 / a[j][j];
      for (int i = j + 1; i < n; ++i) a[j][i] /= a[j][j];
      for (int c = j + 1; c < n; ++c)
        for (int i = j + 1; i < n; ++i) a[c][i] -= a[c][j] * a[j][i];
    }
    return true;
  }

  void solve(const double (&b)[n], double (&x)[n]) const {
#pragma GCC unroll 36
    for (int i = 0; i < n; ++i) x[i] = b[row[i]];
#pragma GCC unroll 36
    for (int j = 0; j < n; ++j)
#pragma GCC unroll 36
      for (int i = j + 1; i < n; ++i) x[i] -= x[j] * a[j][i];
#pragma GCC unroll 36
    for (int j = n - 1; j >= 0; --j) {
      x[j] *= inverse_pivot[j];
#pragma GCC unroll 36
      for (int i = 0; i < j; ++i) x[i] -= x[j] * a[j][i];
    }
  }

  // Writes the block M with its upper left corner at (r, c).
  template <class Block>
  void set(int r, int c, const Block& M) {
    a[c][r] = M.xx, a[c + 1][r] = M.xy, a[c + 2][r] = M.xz;
    a[c][r + 1] = M.yx, a[c + 1][r + 1] = M.yy, a[c + 2][r + 1] = M.yz;
    a[c][r + 2] = M.zx, a[c + 1][r + 2] = M.zy, a[c + 2][r + 2] = M.zz;
  }
};

}  // namespace liebench::floors
