#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "groups/entrywise.h"

namespace liebench {

// The last `depth` vectors of an equidistant sequence, newest first, 1 <= depth <= capacity. A ring where their size is known at
// run time only; small vectors of fixed size are moved, which is cheaper than the arithmetic of indices.
template <class Vector, int capacity>
class History {
 public:
  explicit History(int depth = capacity) requires(Vector::SizeAtCompileTime != Eigen::Dynamic)
      : History(depth, Vector::Constant(typename Vector::Scalar(0.0))) {}
  // `zero` has the size of all vectors to come.
  History(int depth, const Vector& zero) : depth_(depth) { values_.fill(zero); }

  void push(const Vector& value) {
    if constexpr (ring) {
      newest_ = (newest_ == 0 ? depth_ : newest_) - 1;
      set(values_[std::size_t(newest_)], value);
    } else {
      for (std::size_t i = std::size_t(depth_) - 1; i > 0; --i) values_[i] = values_[i - 1];
      values_[0] = value;
    }
    if (size_ < depth_) ++size_;
  }

  // The i-th newest, 0 <= i < size(); zero beyond.
  const Vector& operator[](int i) const { return values_[place(i)]; }
  Vector& operator[](int i) { return values_[place(i)]; }
  int size() const { return size_; }

  // sum += weight(i) times the i-th newest, i = first, ..., last - 1.
  template <class Weight>
  void add_weighted(int first, int last, const Weight& weight, Vector& sum) const {
    if constexpr (!goes_by_entries<Vector>) {
      for (int i = first; i < last; ++i) sum += weight(i) * (*this)[i];
    } else if (sum.size() == 6) {
      for (int i = first; i < last; ++i) set(sum, sum + weight(i) * (*this)[i]);
    } else {
      add_in_threes(first, last, weight, sum);
    }
  }

  // The next value of the polynomial of degree s - 1 through all s = size() >= 1 values:
  // sum_{i=0}^{s-1} (-1)^i binomial(s, i+1) x_{n-i}.
  Vector extrapolated() const {
    using T = typename Vector::Scalar;
    const auto& weights = extrapolation_weights[std::size_t(size_ - 1)];
    Vector sum;
    set(sum, T(weights[0]) * (*this)[0]);
    add_weighted(
        1, size_, [&](int i) { return T(weights[std::size_t(i)]); }, sum);
    return sum;
  }

 private:
  static constexpr bool ring = Vector::SizeAtCompileTime == Eigen::Dynamic;
  std::size_t place(int i) const {
    if constexpr (!ring) return std::size_t(i);
    const int sum = newest_ + i;
    return std::size_t(sum < depth_ ? sum : sum - depth_);
  }

  // One pass over the rows, three of them in registers.
  template <class Weight>
  void add_in_threes(int first, int last, const Weight& weight, Vector& sum) const {
    using T = typename Vector::Scalar;
    T* const to = sum.data();
    Eigen::Index row = 0;
    for (; row + 3 <= sum.size(); row += 3) {
      T x = to[row], y = to[row + 1], z = to[row + 2];
      for (int i = first; i < last; ++i) {
        const T w = weight(i);
        const T* const from = (*this)[i].data() + row;
        x += w * from[0];
        y += w * from[1];
        z += w * from[2];
      }
      to[row] = x;
      to[row + 1] = y;
      to[row + 2] = z;
    }
    for (; row < sum.size(); ++row)
      for (int i = first; i < last; ++i) to[row] += weight(i) * (*this)[i](row);
  }

  // Row s - 1: the weights for s values. A table, for the divisions of the recursion would take longer than a sum.
  static constexpr auto extrapolation_weights = [] {
    std::array<std::array<double, std::size_t(capacity)>, std::size_t(capacity)> rows{};
    for (int s = 1; s <= capacity; ++s) {
      double weight = s;
      for (int i = 0; i < s; ++i) {
        rows[std::size_t(s - 1)][std::size_t(i)] = weight;
        weight = -weight * (s - i - 1) / (i + 2);
      }
    }
    return rows;
  }();

  std::array<Vector, std::size_t(capacity)> values_;
  int depth_;
  int size_ = 0;
  int newest_ = 0;  // of a ring
};

}  // namespace liebench
