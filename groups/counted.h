#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>

#include "groups/scalar.h"

// Counted: a double that counts the floating point operations it takes part in. Comparisons, copies and changes of sign
// are not counted. What a template does for Counted it does for double: the counts are those of the arithmetic as it is
// written, before a compiler folds or shares any of it, and so the same on every machine.

namespace liebench {

// Floating point operations by kind.
struct Operations {
  std::uint64_t add = 0;  // and subtract
  std::uint64_t multiply = 0;
  std::uint64_t divide = 0;
  std::uint64_t square_root = 0;
  std::uint64_t transcendental = 0;  // sin, cos, asin, atan2, tanh

  std::uint64_t total() const { return add + multiply + divide + square_root + transcendental; }
};

inline Operations operator-(const Operations& a, const Operations& b) {
  return {a.add - b.add, a.multiply - b.multiply, a.divide - b.divide, a.square_root - b.square_root,
          a.transcendental - b.transcendental};
}

class Counted {
 public:
  Counted() = default;
  Counted(double value)
      : value_(value) {}  // NOLINT(google-explicit-constructor): constants are no operations
  explicit operator double() const { return value_; }
  double value() const { return value_; }

  // Of this thread, since it began.
  static Operations& operations() {
    thread_local Operations counts;
    return counts;
  }

  friend Counted operator+(const Counted& a, const Counted& b) {
    ++operations().add;
    return a.value_ + b.value_;
  }
  friend Counted operator-(const Counted& a, const Counted& b) {
    ++operations().add;
    return a.value_ - b.value_;
  }
  friend Counted operator*(const Counted& a, const Counted& b) {
    ++operations().multiply;
    return a.value_ * b.value_;
  }
  friend Counted operator/(const Counted& a, const Counted& b) {
    ++operations().divide;
    return a.value_ / b.value_;
  }
  Counted operator-() const { return -value_; }
  Counted& operator+=(const Counted& b) { return *this = *this + b; }
  Counted& operator-=(const Counted& b) { return *this = *this - b; }
  Counted& operator*=(const Counted& b) { return *this = *this * b; }
  Counted& operator/=(const Counted& b) { return *this = *this / b; }

  friend bool operator<(const Counted& a, const Counted& b) { return a.value_ < b.value_; }
  friend bool operator>(const Counted& a, const Counted& b) { return a.value_ > b.value_; }
  friend bool operator<=(const Counted& a, const Counted& b) { return a.value_ <= b.value_; }
  friend bool operator>=(const Counted& a, const Counted& b) { return a.value_ >= b.value_; }
  friend bool operator==(const Counted& a, const Counted& b) { return a.value_ == b.value_; }

  friend Counted sqrt(const Counted& x) {
    ++operations().square_root;
    return std::sqrt(x.value_);
  }
  friend Counted sin(const Counted& x) {
    ++operations().transcendental;
    return std::sin(x.value_);
  }
  friend Counted cos(const Counted& x) {
    ++operations().transcendental;
    return std::cos(x.value_);
  }
  friend Counted asin(const Counted& x) {
    ++operations().transcendental;
    return std::asin(x.value_);
  }
  friend Counted atan2(const Counted& y, const Counted& x) {
    ++operations().transcendental;
    return std::atan2(y.value_, x.value_);
  }
  friend Counted tanh(const Counted& x) {
    ++operations().transcendental;
    return std::tanh(x.value_);
  }
  friend Counted abs(const Counted& x) { return std::abs(x.value_); }
  friend bool isfinite(const Counted& x) { return std::isfinite(x.value_); }

 private:
  double value_ = 0.0;
};

inline double to_double(const Counted& x) {
  return x.value();
}

template <>
struct ScalarTraits<Counted> {
  using Coefficient = double;
  static constexpr bool extended = false;
  using Linear = Counted;
};

}  // namespace liebench

template <>
struct Eigen::NumTraits<liebench::Counted> : Eigen::NumTraits<double> {
  using Real = liebench::Counted;
  using NonInteger = liebench::Counted;
  using Nested = liebench::Counted;
  using Literal = double;
  enum { RequireInitialization = 0, ReadCost = 1, AddCost = 1, MulCost = 1 };
  static liebench::Counted epsilon() { return NumTraits<double>::epsilon(); }
  static liebench::Counted dummy_precision() { return NumTraits<double>::dummy_precision(); }
};
