#pragma once

#include <array>
#include <cstddef>

namespace liebench {

// The last `capacity` vectors of an equidistant sequence, newest first. Kept in place: for the few small
// vectors of a multistep method moving them is cheaper than the index arithmetic of a ring.
template <class Vector, int capacity>
class History {
 public:
  History() {
    for (Vector& value : values_) value.setConstant(typename Vector::Scalar(0.0));
  }

  void push(const Vector& value) {
    for (std::size_t i = std::size_t(capacity) - 1; i > 0; --i) values_[i] = values_[i - 1];
    values_[0] = value;
    if (size_ < capacity) ++size_;
  }

  // The i-th newest, 0 <= i < size().
  const Vector& operator[](int i) const { return values_[std::size_t(i)]; }
  Vector& operator[](int i) { return values_[std::size_t(i)]; }
  int size() const { return size_; }

  // The next value of the polynomial of degree s - 1 through all s = size() >= 1 values:
  // sum_{i=0}^{s-1} (-1)^i binomial(s, i+1) x_{n-i}.
  Vector extrapolated() const {
    using T = typename Vector::Scalar;
    double coefficient = size_;
    Vector sum = T(coefficient) * values_[0];
    for (int i = 1; i < size_; ++i) {
      coefficient = -coefficient * (size_ - i) / (i + 1);
      sum += T(coefficient) * values_[std::size_t(i)];
    }
    return sum;
  }

 private:
  std::array<Vector, std::size_t(capacity)> values_;
  int size_ = 0;
};

}  // namespace liebench
