#include "harness/correction_stability.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <array>
#include <complex>
#include <stdexcept>

#include "integrators/lie_correction.h"

namespace liebench {

namespace {

using Complex = std::complex<double>;

// h^2 dL as a row of factors of the errors e_0, e_1, ... (newest first), from weights of the changes e_i - e_{i+1}.
Eigen::VectorXcd correction_factors(const std::array<CorrectionWeights<double>::Weights, 3>& derivatives,
                                    int changes, bool higher, Complex x) {
  Eigen::VectorXcd factors = Eigen::VectorXcd::Zero(changes + 1);
  for (std::size_t i = 0; i < std::size_t(changes); ++i) {
    const double a = derivatives[0][i], b = derivatives[1][i], c = derivatives[2][i];
    const Complex weight = x / 12.0 * (higher ? a + (x * b - x * x * a - c) / 60.0 : Complex(a));
    factors(Eigen::Index(i)) += weight;
    factors(Eigen::Index(i + 1)) -= weight;
  }
  return factors;
}

// Of z^n + p_1 z^{n-1} + ... + p_n.
double largest_root(const Eigen::VectorXcd& p) {
  const Eigen::Index n = p.size();
  Eigen::MatrixXcd companion = Eigen::MatrixXcd::Zero(n, n);
  companion.row(0) = -p.transpose();
  for (Eigen::Index i = 1; i < n; ++i) companion(i, i - 1) = 1.0;
  return Eigen::ComplexEigenSolver<Eigen::MatrixXcd>(companion, false).eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace

double correction_spectral_radius(int k, bool implicit, double h_times_speed) {
  if (k < 3 || k > 6) throw std::invalid_argument("a correction term has k from 3 to 6");
  const CorrectionWeights<double> weights(k);
  const Complex x(0.0, h_times_speed);
  if (!implicit)
    return largest_root(
        correction_factors(weights.explicit_derivative, weights.explicit_changes, weights.higher, x));
  const Eigen::VectorXcd factors =
      correction_factors(weights.implicit_derivative, weights.implicit_changes, weights.higher, x);
  return largest_root(factors.tail(factors.size() - 1) / (1.0 + factors(0)));
}

double correction_stability_bound(int k, bool implicit, double limit) {
  // The implicit recursion has a root at 1 for every h |v|: a constant error stays.
  constexpr double unity = 1.0 + 1e-9;
  constexpr double spacing = 1e-3;
  double stable = 0.0;
  while (stable + spacing <= limit && correction_spectral_radius(k, implicit, stable + spacing) <= unity)
    stable += spacing;
  if (stable + spacing > limit) return limit;
  double unstable = stable + spacing;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (stable + unstable);
    (correction_spectral_radius(k, implicit, middle) <= unity ? stable : unstable) = middle;
  }
  return stable;
}

}  // namespace liebench
