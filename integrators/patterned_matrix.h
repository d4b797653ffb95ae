#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <type_traits>
#include <utility>
#include <vector>

#include "groups/counted.h"
#include "groups/flattened.h"
#include "groups/scalar.h"
#include "integrators/klu_factorization.h"
#include "integrators/linear_solver.h"

namespace liebench {

// A square matrix whose entries are added in the same order each time it is formed, and the solution of linear systems with it:
// dense LU with partial pivoting where it is small, KLU where it is not (link liebench::scenes). The pattern, its ordering and the
// place of each entry are found once.
template <class T>
class PatternedMatrix {
 public:
  static constexpr Eigen::Index largest_dense = 48;
  // Of a matrix with so many rows.
  static constexpr LinearSolver solver_of(Eigen::Index size) {
    return size <= largest_dense ? LinearSolver::dense_lu : LinearSolver::klu;
  }

  explicit PatternedMatrix(Eigen::Index size)
      : size_(size), dense_(solver_of(size) == LinearSolver::dense_lu) {
    if (dense_) matrix_.setConstant(size, size, T(0.0));
  }
  PatternedMatrix(const PatternedMatrix& other)
      : size_(other.size_),
        dense_(other.dense_),
        matrix_(other.matrix_),
        order_(other.order_),
        inverse_pivots_(other.inverse_pivots_),
        entries_(other.entries_),
        slots_(other.slots_),
        begins_(other.begins_),
        row_of_(other.row_of_),
        values_(other.values_) {
    if (!other.sparse_.empty()) refactorize();
  }
  PatternedMatrix& operator=(const PatternedMatrix& other) {
    if (this != &other) *this = PatternedMatrix(other);
    return *this;
  }
  PatternedMatrix(PatternedMatrix&&) noexcept = default;
  PatternedMatrix& operator=(PatternedMatrix&&) noexcept = default;
  ~PatternedMatrix() = default;

  Eigen::Index size() const { return size_; }

  // Forms the matrix anew: begin(), add() for each entry, factorize().
  void begin() {
    next_ = 0;
    if (dense_)
      matrix_.setConstant(T(0.0));
    else
      std::fill(values_.begin(), values_.end(), 0.0);
  }
  void add(Eigen::Index row, Eigen::Index column, const T& value) {
    if (dense_)
      matrix_(row, column) += value;
    else if (slots_.empty())
      entries_.push_back({std::int32_t(row), std::int32_t(column), to_double(value)});
    else
      values_[std::size_t(slots_[next_++])] += to_double(value);
  }
  // Column by column.
  template <class Block>
  void add_block(Eigen::Index row, Eigen::Index column, const Block& block) {
    if (dense_) {
      for (Eigen::Index j = 0; j < block.cols(); ++j) {
        T* const to = matrix_.data() + (column + j) * size_ + row;
        for (Eigen::Index i = 0; i < block.rows(); ++i) to[i] += block.coeff(i, j);
      }
    } else {
      for (Eigen::Index j = 0; j < block.cols(); ++j)
        for (Eigen::Index i = 0; i < block.rows(); ++i) add(row + i, column + j, block.coeff(i, j));
    }
  }
  // False where it is singular, or not finite.
  bool factorize() {
    if (!dense_ && slots_.empty()) find_pattern();
    return refactorize();
  }
  bool finite() const {
    if (dense_) return matrix_.allFinite();
    return std::all_of(values_.begin(), values_.end(), [](double x) { return std::isfinite(x); });
  }

  // x with A x = b, or as many of its first entries as x has. x may be b itself.
  template <class Right, class Vector>
  void solve(const Right& b, Vector& x) const {
    if (dense_)
      solve_dense(b, x);
    else
      solve_sparse(b, x);
  }

 private:
  struct Entry {
    std::int32_t row, column;
    double value;
  };

  // Columns one after the other, rows ascending; slots_[k] is the place of the k-th entry added.
  void find_pattern() {
    std::vector<std::size_t> order(entries_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      const Entry &x = entries_[a], &y = entries_[b];
      return x.column != y.column ? x.column < y.column : x.row < y.row;
    });
    slots_.resize(entries_.size());
    begins_.assign(std::size_t(size_) + 1, 0);
    row_of_.clear();
    values_.clear();
    const Entry* last = nullptr;
    for (const std::size_t k : order) {
      const Entry& entry = entries_[k];
      if (last == nullptr || last->row != entry.row || last->column != entry.column) {
        row_of_.push_back(entry.row);
        values_.push_back(0.0);
        ++begins_[std::size_t(entry.column) + 1];
      }
      values_.back() += entry.value;
      slots_[k] = std::int32_t(values_.size() - 1);
      last = &entry;
    }
    std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
    entries_.clear();
    entries_.shrink_to_fit();
  }

  bool refactorize() {
    if (dense_) return factorize_dense();
    if (!finite() || !sparse_.factorize(begins_, row_of_, values_)) return false;
    // What a counting scalar would see.
    if constexpr (std::is_same_v<T, Counted>) {
      const auto pairs = std::uint64_t(sparse_.flops()) / 2;
      Counted::operations().multiply += pairs;
      Counted::operations().add += pairs;
      Counted::operations().divide += std::uint64_t(size_);
    }
    return true;
  }

  template <class Right, class Vector>
  void solve_sparse(const Right& b, Vector& result) const {
    Eigen::VectorXd x = b.template cast<double>();
    sparse_.solve(x.data());
    result = x.head(result.size()).template cast<T>();
    if constexpr (std::is_same_v<T, Counted>) {
      Counted::operations().multiply += sparse_.entries();
      Counted::operations().add += sparse_.entries();
    }
  }

  bool factorize_dense() {
    order_.resize(std::size_t(size_));
    std::iota(order_.begin(), order_.end(), Eigen::Index{0});
    inverse_pivots_.resize(std::size_t(size_));
    switch (size_) {
      case 6:
        return factorize_sized<6>();
      case 9:
        return factorize_sized<9>();
      case 12:
        return factorize_sized<12>();
      case 18:
        return factorize_sized<18>();
      default:
        return factorize_any();
    }
  }
  template <int n>
  [[gnu::noinline]] bool factorize_sized() {
    return [&]<std::size_t... j>(std::index_sequence<j...>) {
      return (eliminate<n, int(j)>(matrix_.data()) && ...);
    }
    (std::make_index_sequence<std::size_t(n)>{});
  }
  // One column, with the lengths of all loops known to the compiler.
  template <int n, int j>
  [[gnu::always_inline]] bool eliminate(T* A) {
    using std::abs;
    T* const pivots = A + j * n;
    int pivot = j;
    T largest = abs(pivots[j]);
#pragma GCC unroll 18
    for (int i = j + 1; i < n; ++i) {
      const T size = abs(pivots[i]);
      if (largest < size) {
        largest = size;
        pivot = i;
      }
    }
    if (!(T(0.0) < largest) || !std::isfinite(to_double(largest))) return false;
    if (pivot != j) {
      std::swap(order_[std::size_t(j)], order_[std::size_t(pivot)]);
      for (int c = 0; c < n; ++c) std::swap(A[c * n + j], A[c * n + pivot]);
    }
    const T diagonal = pivots[j];
    inverse_pivots_[std::size_t(j)] = T(1.0) / diagonal;
#pragma GCC unroll 18
    for (int i = j + 1; i < n; ++i) pivots[i] /= diagonal;
    for (int c = j + 1; c < n; ++c) {
      T* const column = A + c * n;
      const T factor = column[j];
      if (factor == T(0.0)) continue;
#pragma GCC unroll 18
      for (int i = j + 1; i < n; ++i) column[i] -= factor * pivots[i];
    }
    return true;
  }
  bool factorize_any() {
    return inlined<T>([&] {
      using std::abs;
      const Eigen::Index n = size_;
      T* const A = matrix_.data();
      for (Eigen::Index j = 0; j < n; ++j) {
        T* const pivots = A + j * n;
        Eigen::Index pivot = j;
        for (Eigen::Index i = j + 1; i < n; ++i)
          if (abs(pivots[pivot]) < abs(pivots[i])) pivot = i;
        if (!(T(0.0) < abs(pivots[pivot])) || !std::isfinite(to_double(pivots[pivot]))) return false;
        std::swap(order_[std::size_t(j)], order_[std::size_t(pivot)]);
        if (pivot != j)
          for (Eigen::Index c = 0; c < n; ++c) std::swap(A[c * n + j], A[c * n + pivot]);
        inverse_pivots_[std::size_t(j)] = T(1.0) / pivots[j];
        for (Eigen::Index i = j + 1; i < n; ++i) pivots[i] /= pivots[j];
        for (Eigen::Index c = j + 1; c < n; ++c) {
          T* const column = A + c * n;
          const T factor = column[j];
          if (factor == T(0.0)) continue;
          for (Eigen::Index i = j + 1; i < n; ++i) column[i] -= factor * pivots[i];
        }
      }
      return true;
    });
  }
  // Of one or two bodies, free or on spherical joints: with n known to the compiler.
  template <class Right, class Vector>
  void solve_dense(const Right& b, Vector& x) const {
    switch (size_) {
      case 6:
        return solve_sized<6>(b.data(), x.data(), x.size());
      case 9:
        return solve_sized<9>(b.data(), x.data(), x.size());
      case 12:
        return solve_sized<12>(b.data(), x.data(), x.size());
      case 18:
        return solve_sized<18>(b.data(), x.data(), x.size());
      default:
        return solve_in_fours(b.data(), x.data(), x.size());
    }
  }
  template <int n>
  [[gnu::noinline]] void solve_sized(const T* b, T* x, Eigen::Index rows) const {
    std::array<T, std::size_t(n)> room;  // in registers, as far as there are some
    for (std::size_t j = 0; j < std::size_t(n); ++j) room[j] = b[order_[j]];
    substitute<n>(matrix_.data(), inverse_pivots_.data(), room.data());
    if (rows == n)
      std::copy_n(room.begin(), std::size_t(n), x);
    else
      std::copy_n(room.begin(), std::size_t(rows), x);
  }
  template <int n>
  [[gnu::always_inline]] static void substitute(const T* A, const T* inverse_pivots, T* x) {
#pragma GCC unroll 18
    for (int j = 0; j < n; ++j) {
#pragma GCC unroll 18
      for (int i = j + 1; i < n; ++i) x[i] -= A[j * n + i] * x[j];
    }
#pragma GCC unroll 18
    for (int j = n - 1; j >= 0; --j) {
      x[j] *= inverse_pivots[j];
#pragma GCC unroll 18
      for (int i = 0; i < j; ++i) x[i] -= A[j * n + i] * x[j];
    }
  }

  // Four rows at a time in registers, behind the first few that fill no four. Every row takes its subtractions in the order
  // of the columns, as one column after the other would make them: half the time of that for 18 to 36 unknowns.
  [[gnu::noinline]] void solve_in_fours(const T* b, T* x, Eigen::Index rows) const {
    const Eigen::Index n = size_, odd = n % 4;
    const T* const A = matrix_.data();
    const T* const inverse_pivots = inverse_pivots_.data();
    std::array<T, std::size_t(largest_dense)> room;
    T* const y = room.data();
    for (Eigen::Index i = 0; i < n; ++i) y[i] = b[order_[std::size_t(i)]];
    for (Eigen::Index j = 0; j < odd; ++j)
      for (Eigen::Index r = j + 1; r < odd; ++r) subtract(A[j * n + r], y[j], y[r]);
    for (Eigen::Index i = odd; i < n; i += 4) {
      subtract_four(A + i, n, y, 1, i, y + i);
      const T* const D = A + i * n + i;
      T* const z = y + i;
      subtract(D[1], z[0], z[1]);
      subtract(D[2], z[0], z[2]);
      subtract(D[3], z[0], z[3]);
      subtract(D[n + 2], z[1], z[2]);
      subtract(D[n + 3], z[1], z[3]);
      subtract(D[2 * n + 3], z[2], z[3]);
    }
    for (Eigen::Index i = n - 4; i >= odd; i -= 4) {
      subtract_four(A + (n - 1) * n + i, -n, y + n - 1, -1, n - 4 - i, y + i);
      const T* const D = A + i * n + i;
      T* const z = y + i;
      z[3] *= inverse_pivots[i + 3];
      subtract(D[3 * n], z[3], z[0]);
      subtract(D[3 * n + 1], z[3], z[1]);
      subtract(D[3 * n + 2], z[3], z[2]);
      z[2] *= inverse_pivots[i + 2];
      subtract(D[2 * n], z[2], z[0]);
      subtract(D[2 * n + 1], z[2], z[1]);
      z[1] *= inverse_pivots[i + 1];
      subtract(D[n], z[1], z[0]);
      z[0] *= inverse_pivots[i];
    }
    for (Eigen::Index r = 0; r < odd; ++r)
      for (Eigen::Index j = n - 1; j >= odd; --j) subtract(A[j * n + r], y[j], y[r]);
    for (Eigen::Index j = odd - 1; j >= 0; --j) {
      y[j] *= inverse_pivots[j];
      for (Eigen::Index r = 0; r < j; ++r) subtract(A[j * n + r], y[j], y[r]);
    }
    std::copy_n(y, rows, x);
  }
  [[gnu::always_inline]] static void subtract(const T& a, const T& y, T& from) {
    from -= a * y;
    asm volatile("");  // no packets of a few
  }
  // to_r -= a_r y for four rows r and `count` columns, each a stride further.
  [[gnu::always_inline]] static void subtract_four(const T* a, Eigen::Index stride, const T* y,
                                                   Eigen::Index step, Eigen::Index count, T* to) {
    T t0 = to[0], t1 = to[1], t2 = to[2], t3 = to[3];
    for (; count > 0; --count, a += stride, y += step) {
      t0 -= a[0] * *y;
      t1 -= a[1] * *y;
      t2 -= a[2] * *y;
      t3 -= a[3] * *y;
      asm volatile("");
    }
    to[0] = t0;
    to[1] = t1;
    to[2] = t2;
    to[3] = t3;
  }

  Eigen::Index size_;
  bool dense_;
  std::size_t next_ = 0;
  // Dense: the matrix, then its factors.
  Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic> matrix_;
  std::vector<Eigen::Index> order_;  // the row of A that has become row j
  std::vector<T> inverse_pivots_;
  // Sparse, by columns.
  std::vector<Entry> entries_;
  std::vector<std::int32_t> slots_, begins_, row_of_;
  std::vector<double> values_;
  KluFactorization sparse_;
};

}  // namespace liebench
