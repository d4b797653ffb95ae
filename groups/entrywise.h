#pragma once

#include <Eigen/Core>
#include <cmath>
#include <type_traits>

namespace liebench {

// visit(i) for i = 0, ..., n - 1. Three at a time, for velocities come in threes, those of one body without a loop, and never in
// packets: what the compiler makes of a loop over 6 or 9 numbers otherwise, with its checks for packets, takes longer than the
// numbers do.
template <class Visitor>
[[gnu::always_inline]] inline void each_entry(Eigen::Index n, const Visitor& visit) {
  if (n == 6) {
    visit(0);
    visit(1);
    visit(2);
    visit(3);
    visit(4);
    visit(5);
    return;
  }
  Eigen::Index i = 0;
  for (; i + 3 <= n; i += 3) {
    visit(i);
    visit(i + 1);
    visit(i + 2);
    asm volatile("");
  }
  for (; i < n; ++i) {
    visit(i);
    asm volatile("");
  }
}

// |x| of every scalar.
template <class T>
T abs_of(const T& x) {
  return x < T(0.0) ? T(-x) : x;
}

// Whether that pays: in double, where the size is known at run time only.
template <class Vector>
inline constexpr bool goes_by_entries =
    Vector::SizeAtCompileTime == Eigen::Dynamic&& std::is_same_v<typename Vector::Scalar, double>;

// to = value, vectors; `to` may be part of the value.
template <class Vector, class Value>
[[gnu::always_inline]] inline void set(Vector&& to, const Eigen::MatrixBase<Value>& value) {
  using Plain = std::remove_reference_t<Vector>;
  if constexpr (!goes_by_entries<Plain>) {
    to = value;
  } else {
    if constexpr (std::is_same_v<typename Plain::PlainObject, Plain>) to.resize(value.size());
    const auto copy = [&](Eigen::Index i) __attribute__((always_inline)) {
      to.coeffRef(i) = value.derived().coeff(i);
    };
    each_entry(value.size(), copy);
  }
}

// The largest |x_i|, zero of none.
template <class Vector>
[[gnu::always_inline]] inline auto largest_entry(const Eigen::MatrixBase<Vector>& x) {
  using T = typename Vector::Scalar;
  if constexpr (!goes_by_entries<Vector>) {
    return T(x.template lpNorm<Eigen::Infinity>());
  } else {
    if (x.size() == 0) return T(0.0);
    T largest = std::abs(x.derived().coeff(0));
    const auto compare = [&](Eigen::Index i) __attribute__((always_inline)) {
      const T entry = std::abs(x.derived().coeff(i));
      if (largest < entry) largest = entry;
    };
    each_entry(x.size(), compare);
    return largest;
  }
}

}  // namespace liebench
