#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "groups/scalar.h"

// Difference quotients that know their error, as witnesses for derivatives that a system gives in closed form
// (problems/check_system.h). In a scalar of 106 bits they leave the round-off of double alone: the step can be so small that
// neither truncation nor noise reaches it. In double they leave some 1e-9.

namespace liebench {

using CheckVector = Eigen::VectorXd;
using CheckMatrix = Eigen::MatrixXd;
template <class T>
using WitnessVector = Eigen::Matrix<T, Eigen::Dynamic, 1>;

inline constexpr double double_eps = std::numeric_limits<double>::epsilon();
// An entry is a sum of fewer than ten products of at most four rounded factors, and both sides of a comparison err.
inline constexpr double roundings = 64.0;

// The largest entry; 0 where there is none, NaN where one is.
template <class Derived>
double max_norm(const Eigen::MatrixBase<Derived>& A) {
  double largest = 0.0;
  for (Eigen::Index j = 0; j < A.cols(); ++j)
    for (Eigen::Index i = 0; i < A.rows(); ++i) {
      const double size = std::abs(to_double(A(i, j)));
      if (!(size <= largest)) largest = size;
      if (std::isnan(largest)) return largest;
    }
  return largest;
}

// A derivative from the left and from the right: the same number where the function is smooth, two where it has a kink (a contact
// that begins). A closed form may give any number between them, but for the error.
struct SidedDerivative {
  CheckVector left, right, error;

  // Of the numbers between them the nearest to x; NaN where one of them is none.
  double nearest(Eigen::Index i, double x) const {
    const double low = std::min(left(i), right(i)), high = std::max(left(i), right(i));
    if (!std::isfinite(left(i)) || !std::isfinite(right(i))) return std::numeric_limits<double>::quiet_NaN();
    return x < low ? low : x > high ? high : x;
  }
};

// f'(0) of a vector function of one number, from either side by
//
//   D(d) = (4 f(d/2) - f(d) - 3 f(0)) / d,  error d^2 f''' / 12
//
// which is exact where f is quadratic on the side, so that |x| x has its derivative at 0. D(d/2) is given, and |D(d) - D(d/2)|, more
// than its truncation (Richardson), in the error; with it the noise of eight values of f and its argument, each of a few roundings.
// `unit` is the size of the variable. The step: in a scalar with more than 64 bits sixteen times the root of its eps, where noise is
// a sixteenth of the round-off of double and truncation far below; in double the cube root, where both are alike.
// `argument`: the size of what the variable is added to.
template <class T, class F>
SidedDerivative sided_derivative(const F& f, double unit, double argument = 0.0) {
  const double eps = to_double(Eigen::NumTraits<T>::epsilon());
  const double d = unit * (ScalarTraits<T>::extended ? 16.0 * std::sqrt(eps) : std::cbrt(eps));
  const WitnessVector<T> center = f(T(0.0));
  double size = max_norm(center);
  const auto side = [&](double h, CheckVector& error) {
    const WitnessVector<T> far = f(T(h)), middle = f(T(0.5 * h)), near = f(T(0.25 * h));
    const WitnessVector<T> coarse = (middle * T(4.0) - far - center * T(3.0)) / T(h);
    const WitnessVector<T> fine = (near * T(4.0) - middle - center * T(3.0)) / T(0.5 * h);
    CheckVector value(fine.size());
    for (Eigen::Index i = 0; i < fine.size(); ++i) {
      value(i) = to_double(fine(i));
      error(i) = std::max(error(i), std::abs(to_double(T(coarse(i) - fine(i)))));
    }
    size = std::max(size, max_norm(far));
    return value;
  };
  SidedDerivative result;
  result.error = CheckVector::Zero(center.size());
  result.left = side(-d, result.error);
  result.right = side(d, result.error);
  result.error.array() +=
      roundings * eps / d * (size + argument * std::max(max_norm(result.left), max_norm(result.right)));
  return result;
}

struct SecondDerivative {
  CheckVector value, error;
};

// f''(0) by (16 (f(d) + f(-d)) - (f(2d) + f(-2d)) - 30 f(0)) / (12 d^2), error d^4 f^(6) / 90, with d and 2 d, whose difference
// bounds the truncation. d is the sixth root of eps, where truncation and noise eps / d^2 are alike; `size` that of what f is made of.
template <class T, class F>
SecondDerivative second_derivative(const F& f, double unit, double size) {
  const double eps = to_double(Eigen::NumTraits<T>::epsilon());
  const double d = unit * std::pow(eps, 1.0 / 6.0);
  const WitnessVector<T> center = f(T(0.0));
  const auto pair = [&](double h) { return WitnessVector<T>(f(T(h)) + f(T(-h))); };
  const WitnessVector<T> one = pair(d), two = pair(2.0 * d), four = pair(4.0 * d);
  const WitnessVector<T> fine = (one * T(16.0) - two - center * T(30.0)) / (T(d) * T(d) * T(12.0));
  const WitnessVector<T> coarse = (two * T(16.0) - four - center * T(30.0)) / (T(d) * T(d) * T(48.0));
  SecondDerivative result{CheckVector(fine.size()), CheckVector(fine.size())};
  for (Eigen::Index i = 0; i < fine.size(); ++i) {
    result.value(i) = to_double(fine(i));
    result.error(i) = std::abs(to_double(T(coarse(i) - fine(i)))) + roundings * eps / (d * d) * size;
  }
  return result;
}

}  // namespace liebench
