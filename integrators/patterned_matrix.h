#pragma once

#include <klu.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <type_traits>
#include <vector>

#include "groups/counted.h"
#include "groups/flattened.h"
#include "groups/scalar.h"
#include "integrators/linear_solver.h"

namespace liebench {

// A square matrix whose entries are added in the same order each time it is formed, and the solution of linear systems with it:
// dense LU with partial pivoting where it is small, SuiteSparse's KLU where it is not. The pattern, its ordering and the place of
// each entry are found once; later matrices of the pattern are factorized with the pivots of the one before, as long as these
// are good.
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
    if (other.factors_ != nullptr) refactorize();
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
  // False where it is singular, or not finite.
  bool factorize() {
    if (!dense_ && slots_.empty()) find_pattern();
    return refactorize();
  }
  bool finite() const {
    if (dense_) return matrix_.allFinite();
    return std::all_of(values_.begin(), values_.end(), [](double x) { return std::isfinite(x); });
  }

  // x with A x = b, in place.
  template <class Vector>
  void solve(Vector& b) const {
    if (dense_)
      solve_dense(b);
    else
      solve_sparse(b);
  }

 private:
  struct Entry {
    std::int32_t row, column;
    double value;
  };
  struct Common : klu_common {
    Common() { klu_defaults(this); }
  };
  struct FreeSymbolic {
    Common* common;
    void operator()(klu_symbolic* p) const { klu_free_symbolic(&p, common); }
  };
  struct FreeNumeric {
    Common* common;
    void operator()(klu_numeric* p) const { klu_free_numeric(&p, common); }
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
    if (!finite()) return false;
    const int n = int(size_);
    if (symbolic_ == nullptr) {
      common_ = std::make_unique<Common>();
      symbolic_ = {klu_analyze(n, begins_.data(), row_of_.data(), common_.get()),
                   FreeSymbolic{common_.get()}};
      if (symbolic_ == nullptr) return false;
    }
    if (factors_ != nullptr) {
      const bool done = klu_refactor(begins_.data(), row_of_.data(), values_.data(), symbolic_.get(),
                                     factors_.get(), common_.get()) != 0;
      klu_rgrowth(begins_.data(), row_of_.data(), values_.data(), symbolic_.get(), factors_.get(),
                  common_.get());
      // The old pivots serve while they do not let the entries grow.
      if (done && common_->status == KLU_OK && common_->rgrowth > 1e-6) return count_factorization();
    }
    factors_ = {klu_factor(begins_.data(), row_of_.data(), values_.data(), symbolic_.get(), common_.get()),
                FreeNumeric{common_.get()}};
    if (factors_ == nullptr || common_->status != KLU_OK) {
      factors_.reset();
      return false;
    }
    return count_factorization();
  }
  // What a counting scalar would see.
  bool count_factorization() const {
    if constexpr (std::is_same_v<T, Counted>) {
      klu_flops(symbolic_.get(), factors_.get(), common_.get());
      Counted::operations().multiply += std::uint64_t(common_->flops) / 2;
      Counted::operations().add += std::uint64_t(common_->flops) / 2;
      Counted::operations().divide += std::uint64_t(size_);
    }
    return true;
  }

  template <class Vector>
  void solve_sparse(Vector& b) const {
    Eigen::VectorXd x = b.template cast<double>();
    klu_solve(symbolic_.get(), factors_.get(), int(size_), 1, x.data(), common_.get());
    b = x.template cast<T>();
    if constexpr (std::is_same_v<T, Counted>) {
      const auto entries = std::uint64_t(factors_->lnz + factors_->unz);
      Counted::operations().multiply += entries;
      Counted::operations().add += entries;
    }
  }

  bool factorize_dense() {
    return inlined<T>([&] {
      using std::abs;
      const Eigen::Index n = size_;
      order_.resize(std::size_t(n));
      std::iota(order_.begin(), order_.end(), Eigen::Index{0});
      inverse_pivots_.resize(std::size_t(n));
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
  // Of the sizes that small scenes have (a body more has 6 unknowns more, a joint 3 or a few), with n known to the compiler.
  template <class Vector>
  void solve_dense(Vector& b) const {
    switch (size_) {
      case 6:
        return solve_sized<6>(b);
      case 9:
        return solve_sized<9>(b);
      case 12:
        return solve_sized<12>(b);
      case 18:
        return solve_sized<18>(b);
      default: {
        std::array<T, std::size_t(largest_dense)> x;
        return solve_in(x, size_, b);
      }
    }
  }
  template <int n, class Vector>
  void solve_sized(Vector& b) const {
    std::array<T, std::size_t(n)> x;  // in registers, as far as there are some
    solve_in(x, std::integral_constant<int, n>(), b);
  }
  template <class Room, class Size, class Vector>
  [[gnu::always_inline]] void solve_in(Room& x, Size n, Vector& b) const {
    for (std::size_t j = 0; j < std::size_t(n); ++j) x[j] = b(order_[j]);
    substitute(n, matrix_.data(), inverse_pivots_.data(), x.data());
    std::copy_n(x.begin(), std::size_t(n), b.data());
  }
  template <class Size>
  [[gnu::always_inline]] static void substitute(Size size, const T* A, const T* inverse_pivots, T* x) {
    const int n = int(size);
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
  std::unique_ptr<Common> common_;
  std::unique_ptr<klu_symbolic, FreeSymbolic> symbolic_{nullptr, FreeSymbolic{nullptr}};
  std::unique_ptr<klu_numeric, FreeNumeric> factors_{nullptr, FreeNumeric{nullptr}};
};

}  // namespace liebench
