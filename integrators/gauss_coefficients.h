#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace liebench {

// The collocation method of Gauss with s stages, of order 2 s [Hairer, Norsett & Wanner, Solving ODE I, II.7], in the precision of
// T. c_i are the roots of the Legendre polynomial P_s on [0, 1], by Newton's iteration; x = 2 c - 1, and with the polynomials
// l_j(x) = b_j sum_{k<s} (2 k + 1) P_k(x_j) P_k(x) of degree s - 1 that are 1 in x_j and 0 in the other nodes
//
//   b_j = 1 / ((1 - x_j^2) P_s'(x_j)^2),   a_ij = integral of l_j over [0, c_i]
//   centred_ij = a_ij - b_j / 2 = b_j / 2 (x_i + sum_{0<k<s} P_k(x_j) (P_{k+1}(x_i) - P_{k-1}(x_i)))
//
// the integral over [1/2, c_i] as seen from both ends alike. All sums are of numbers of the size of the result: nothing is lost, as the
// solution of the linear systems of the simplifying assumptions would.
template <class T>
struct GaussCoefficients {
  static constexpr int most_stages = 12;
  using Row = std::array<T, std::size_t(most_stages)>;
  using Matrix = std::array<Row, std::size_t(most_stages)>;

  int stages;
  Row c{}, b{};
  Matrix a{}, centred{};
  // l_j(1 + c_i): a step further.
  Matrix extrapolation{};

  explicit GaussCoefficients(int s) : stages(s) {
    Row x{};
    for (std::size_t i = 0; i < size(); ++i) {
      // The upper half mirrored: the method is symmetric to the last bit.
      const std::size_t mirror = size() - 1 - i;
      x[i] = mirror < i ? T(-x[mirror]) : mirror == i ? T(0.0) : root(i);
    }
    Matrix at_nodes_of{}, next{};  // P_k(x_i), P_k(x_i + 2), k < s
    Row derivative{};
    for (std::size_t i = 0; i < size(); ++i) {
      const Values P = legendre(x[i]), Q = legendre(T(x[i] + T(2.0)));
      for (std::size_t k = 0; k < size(); ++k) {
        at_nodes_of[i][k] = P[k];
        next[i][k] = Q[k];
      }
      derivative[i] = slope(x[i], P);
      c[i] = (T(1.0) + x[i]) * T(0.5);
      b[i] = T(1.0) / ((T(1.0) - x[i] * x[i]) * derivative[i] * derivative[i]);
    }
    for (std::size_t i = 0; i < size(); ++i) {
      const Values P = legendre(x[i]);
      for (std::size_t j = 0; j < size(); ++j) {
        T integral = x[i], value(1.0);
        for (std::size_t k = 1; k < size(); ++k) {
          integral += at_nodes_of[j][k] * (P[k + 1] - P[k - 1]);
          value += T(double(2 * k + 1)) * at_nodes_of[j][k] * next[i][k];
        }
        const T half = b[j] * T(0.5);
        centred[i][j] = half * integral;
        a[i][j] = half + centred[i][j];
        extrapolation[i][j] = b[j] * value;
      }
    }
  }

 private:
  std::size_t size() const { return std::size_t(stages); }

  // P_0, ..., P_{s+1} at x.
  using Values = std::array<T, std::size_t(most_stages) + 2>;
  Values legendre(const T& x) const {
    Values P{};
    P[0] = T(1.0);
    P[1] = x;
    for (std::size_t k = 1; k <= size(); ++k)
      P[k + 1] = (T(double(2 * k + 1)) * x * P[k] - T(double(k)) * P[k - 1]) / T(double(k + 1));
    return P;
  }
  // P_s'
  T slope(const T& x, const Values& P) const {
    return T(double(stages)) * (P[size() - 1] - x * P[size()]) / (T(1.0) - x * x);
  }
  // The i-th root from below. The start is right to 0.03 at least, and each pass doubles the digits: seven serve 106 bits.
  T root(std::size_t i) const {
    T x(-std::cos(std::numbers::pi * (double(i) + 0.75) / (stages + 0.5)));
    for (int pass = 0; pass < 7; ++pass) {
      const Values P = legendre(x);
      x -= P[size()] / slope(x, P);
    }
    return x;
  }
};

}  // namespace liebench
