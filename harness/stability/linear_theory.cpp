#include "harness/stability/linear_theory.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>

#include "integrators/bdf_coefficients.h"
#include "integrators/crouch_grossman.h"
#include "integrators/faltinsen_adams.h"
#include "integrators/half_explicit_tableau.h"
#include "integrators/runge_kutta_tableau.h"

namespace liebench {

namespace {

using Complex = std::complex<double>;

double largest_eigenvalue(const Eigen::MatrixXcd& matrix) {
  return Eigen::ComplexEigenSolver<Eigen::MatrixXcd>(matrix, false).eigenvalues().cwiseAbs().maxCoeff();
}

double bdf_radius(int k, Complex z) {
  const auto alpha = bdf_coefficients<double>(k).alpha;
  Eigen::MatrixXcd companion = Eigen::MatrixXcd::Zero(k, k);
  for (int i = 1; i <= k; ++i) companion(0, i - 1) = -alpha[std::size_t(i)] / (alpha[0] - z);
  for (int i = 1; i < k; ++i) companion(i, i - 1) = 1.0;
  return largest_eigenvalue(companion);
}

template <std::size_t s>
Complex stability_function_of(const ExplicitTableau<s>& tableau, Complex z) {
  Complex value = 1.0;
  std::array<Complex, s> stage;
  for (std::size_t i = 0; i < s; ++i) {
    stage[i] = 1.0;
    for (std::size_t j = 0; j < i; ++j) stage[i] += z * value_of<double>(tableau.a[i][j]) * stage[j];
    value += z * value_of<double>(tableau.b[i]) * stage[i];
  }
  return value;
}

// P(z) / P(-z), P(z) = sum_j (2s - j)! s! / ((2s)! j! (s - j)!) z^j.
Complex diagonal_pade(int s, Complex z) {
  Complex numerator = 0.0, denominator = 0.0, power = 1.0;
  double coefficient = 1.0;
  for (int j = 0; j <= s; ++j) {
    numerator += coefficient * power;
    denominator += (j % 2 == 0 ? coefficient : -coefficient) * power;
    power *= z;
    coefficient *= double(s - j) / double((2 * s - j) * (j + 1));
  }
  return numerator / denominator;
}

// zeta^k - zeta^{k-1} = z sum_i b_i zeta^{k-i}
double adams_radius(int k, Complex z) {
  Eigen::MatrixXcd companion = Eigen::MatrixXcd::Zero(k, k);
  for (int i = 0; i < k; ++i)
    companion(0, i) = z * value_of<double>(adams_bashforth[std::size_t(k - 1)][std::size_t(i)]);
  companion(0, 0) += 1.0;
  for (int i = 1; i < k; ++i) companion(i, i - 1) = 1.0;
  return largest_eigenvalue(companion);
}

bool is_verlet(const Contestant& method) {
  return method.is("rattlie") || method.is("shakelie") || method.is("liemid");
}

// Of (x, h x', h w), w the velocity that the force at t_n was taken with: with D = h Dq,
// D = h x' - (stiffness x + damping h w) / 2, x <- x + D, h w <- 2 D - h x', h x' <- D - (stiffness x + damping h w) / 2, x and w the new
// ones there.
double verlet_radius(Complex z) {
  const double damping = -2.0 * z.real(), stiffness = std::norm(z);
  const auto step = [&](const Eigen::Vector3d& y) {
    const double D = y(1) - 0.5 * (stiffness * y(0) + damping * y(2)), x = y(0) + D, w = 2.0 * D - y(1);
    return Eigen::Vector3d(x, D - 0.5 * (stiffness * x + damping * w), w);
  };
  Eigen::Matrix3d matrix;
  matrix << step(Eigen::Vector3d::UnitX()), step(Eigen::Vector3d::UnitY()), step(Eigen::Vector3d::UnitZ());
  return largest_eigenvalue(matrix.cast<Complex>());
}

template <std::size_t s>
Complex half_explicit_function_of(const HalfExplicitTableau<s>& tableau, Complex z) {
  std::array<Complex, s + 1> stage;
  for (std::size_t i = 0; i <= tableau.end; ++i) {
    stage[i] = 1.0;
    for (std::size_t j = 0; j < i; ++j) stage[i] += z * value_of<double>(tableau.a[i][j]) * stage[j];
  }
  return stage[tableau.end];
}
Complex half_explicit_function(const std::string& tableau, Complex z) {
  if (tableau == "herk3") return half_explicit_function_of(herk_three, z);
  if (tableau == "hedop5") return half_explicit_function_of(hedop_five, z);
  return half_explicit_function_of(herk_four, z);
}

struct Alpha {
  double alpha_m, alpha_f, beta, gamma;
  explicit Alpha(double rho)
      : alpha_m((2.0 * rho - 1.0) / (rho + 1.0)),
        alpha_f(rho / (rho + 1.0)),
        beta(1.0 / ((rho + 1.0) * (rho + 1.0))),
        gamma((3.0 - rho) / (2.0 * (rho + 1.0))) {}
};

// Of generalized-alpha, the last of those that the theory knows.
double known_rho_inf(const Contestant& method) {
  if (const std::optional<double> rho = method.rho_inf()) return *rho;
  throw std::logic_error("no linear theory of " + method.name + ": harness/stability/linear_theory.cpp");
}

}  // namespace

std::optional<Complex> stability_function(const Contestant& method, Complex z) {
  if (method.is("crouch_grossman")) return stability_function_of(crouch_grossman_three, z);
  if (method.is("commutator_free")) return stability_function_of(classical_four, z);
  if (method.is("implicit_midpoint") || method.is("newmark")) return diagonal_pade(1, z);
  if (method.is("gauss")) return diagonal_pade(method.options.integer("stages"), z);
  if (method.is("radau")) return (1.0 + z * (0.4 + z * 0.05)) / (1.0 - z * (0.6 - z * (0.15 - z / 60.0)));
  if (method.is("half_explicit")) return half_explicit_function(method.options.choice("tableau"), z);
  if (method.is("rkmk_variable")) return stability_function_of(dormand_prince_five, z);
  if (!method.is("rkmk")) return std::nullopt;
  const std::string& tableau = method.options.choice("tableau");
  if (tableau == "dopri5") return stability_function_of(dormand_prince_five, z);
  if (tableau == "butcher6") return stability_function_of(butcher_six, z);
  return stability_function_of(classical_four, z);
}

bool explicit_in_forces(const Contestant& method) {
  for (const char* name : {"rkmk", "rkmk_variable", "commutator_free", "crouch_grossman", "faltinsen_adams",
                           "half_explicit", "rattlie", "shakelie", "liemid"})
    if (method.is(name)) return true;
  return false;
}

double spectral_radius(const Contestant& method, Complex z) {
  if (const auto R = stability_function(method, z)) return std::abs(*R);
  if (is_verlet(method)) return verlet_radius(z);
  if (method.is("faltinsen_adams")) return adams_radius(method.steps(), z);
  if (method.options.has("k")) {
    // A real system of second order has z and its conjugate; both polynomials have roots of the same sizes.
    return bdf_radius(method.steps(), z);
  }
  const Alpha p(known_rho_inf(method));
  const double damping = -2.0 * z.real(), stiffness = std::norm(z);  // 2 xi Omega and Omega^2
  // Unknowns at n + 1 (x, h x', h^2 a, h^2 x''), with h^2 x'' = -damping h x' - stiffness x at n + 1 and at n.
  Eigen::Matrix4d left, right;
  left << 1.0, 0.0, -p.beta, 0.0,                     //
      0.0, 1.0, -p.gamma, 0.0,                        //
      0.0, 0.0, 1.0 - p.alpha_m, -(1.0 - p.alpha_f),  //
      stiffness, damping, 0.0, 1.0;
  right << 1.0, 1.0, 0.5 - p.beta, 0.0,  //
      0.0, 1.0, 1.0 - p.gamma, 0.0,      //
      0.0, 0.0, -p.alpha_m, p.alpha_f,   //
      0.0, 0.0, 0.0, 0.0;
  return largest_eigenvalue((left.partialPivLu().solve(right)).cast<Complex>());
}

double adams_increment_radius(int k, double angle) {
  if (k == 1) return 0.0;
  const Complex unit(0.0, 1.0);
  const auto t = [&](double a) { return (1.0 - std::exp(-unit * a)) / (unit * a); };
  const int n = k - 1;
  Eigen::MatrixXcd companion = Eigen::MatrixXcd::Zero(n, n);
  for (int i = 1; i <= n; ++i) {
    const Complex gain = value_of<double>(adams_bashforth[std::size_t(k - 1)][std::size_t(i)]) / double(i) *
                         (1.0 - 1.0 / t(-i * angle)) * t(angle) / t(i * angle);
    for (int j = 0; j < i; ++j) companion(0, j) += gain * std::exp(-unit * (j * angle));
  }
  for (int j = 1; j < n; ++j) companion(j, j - 1) = 1.0;
  return largest_eigenvalue(companion);
}

double truncation_spectral_radius(int k, double angle) {
  const auto alpha = bdf_coefficients<double>(k).alpha;
  const Complex i_angle(0.0, angle);
  // Coefficients of d_0, ..., d_3.
  using Row = Eigen::Vector4cd;
  const auto d = [](int j) { return Row(Row::Unit(j)); };
  const Row s = -(d(1) + d(2)) + 0.5 * i_angle * (d(2) - d(1));
  Row w = alpha[0] * d(0) - alpha[2] * d(1) + alpha[3] * s;
  if (k == 4) {
    const Row z = -i_angle * (s + 2.0 * d(3));
    w += alpha[4] * (s - d(3) - 0.5 * z + i_angle / 12.0 * z);
  }
  const Row p = i_angle * (w - d(0));
  Row v = w - 0.5 * p;
  if (k == 4) v += i_angle / 6.0 * p;
  const int n = k - 1;
  Eigen::MatrixXcd companion = Eigen::MatrixXcd::Zero(n, n);
  for (int j = 0; j < n; ++j) companion(0, j) = -v(j + 1) / v(0);
  for (int j = 1; j < n; ++j) companion(j, j - 1) = 1.0;
  return largest_eigenvalue(companion);
}

double velocity_spectral_radius(const Contestant& method, Complex z) {
  if (const auto R = stability_function(method, z)) return std::abs(*R);
  // The momentum before and behind a step have the same length, whatever it turns by.
  if (is_verlet(method)) return 1.0;
  if (method.is("faltinsen_adams")) return adams_radius(method.steps(), z);
  if (method.options.has("k")) return bdf_radius(method.steps(), z);
  const Alpha p(known_rho_inf(method));
  // (v, h a, h v')
  Eigen::Matrix3cd left, right;
  left << 1.0, -p.gamma, 0.0,                    //
      0.0, 1.0 - p.alpha_m, -(1.0 - p.alpha_f),  //
      -z, 0.0, 1.0;
  right << 1.0, 1.0 - p.gamma, 0.0,  //
      0.0, -p.alpha_m, p.alpha_f,    //
      0.0, 0.0, 0.0;
  return largest_eigenvalue(left.partialPivLu().solve(right));
}

}  // namespace liebench
