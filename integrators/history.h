#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace liebench {

// The last `depth` vectors of an equidistant sequence, newest first, 1 <= depth <= capacity. Kept in place: for the few
// small vectors of a multistep method moving them is cheaper than the index arithmetic of a ring.
template <class Vector, int capacity>
class History {
 public:
  explicit History(int depth = capacity) requires(Vector::SizeAtCompileTime != Eigen::Dynamic)
      : History(depth, Vector::Constant(typename Vector::Scalar(0.0))) {}
  // `zero` has the size of all vectors to come.
  History(int depth, const Vector& zero) : depth_(depth) { values_.fill(zero); }

  void push(const Vector& value) {
    for (std::size_t i = std::size_t(depth_) - 1; i > 0; --i) values_[i] = values_[i - 1];
    values_[0] = value;
    if (size_ < depth_) ++size_;
  }

  // The i-th newest, 0 <= i < size(); zero beyond.
  const Vector& operator[](int i) const { return values_[std::size_t(i)]; }
  Vector& operator[](int i) { return values_[std::size_t(i)]; }
  int size() const { return size_; }

  // The next value of the polynomial of degree s - 1 through all s = size() >= 1 values:
  // sum_{i=0}^{s-1} (-1)^i binomial(s, i+1) x_{n-i}.
  Vector extrapolated() const {
    using T = typename Vector::Scalar;
    const auto& weights = extrapolation_weights[std::size_t(size_ - 1)];
    Vector sum = T(weights[0]) * values_[0];
    for (int i = 1; i < size_; ++i) sum += T(weights[std::size_t(i)]) * values_[std::size_t(i)];
    return sum;
  }

 private:
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
};

}  // namespace liebench
