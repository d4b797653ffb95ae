#include "harness/stability/contestant.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <stdexcept>

#include "integrators/bdf_coefficients.h"
#include "integrators/crouch_grossman.h"
#include "integrators/form.h"
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

struct Alpha {
  double alpha_m, alpha_f, beta, gamma;
  explicit Alpha(double rho)
      : alpha_m((2.0 * rho - 1.0) / (rho + 1.0)),
        alpha_f(rho / (rho + 1.0)),
        beta(1.0 / ((rho + 1.0) * (rho + 1.0))),
        gamma((3.0 - rho) / (2.0 * (rho + 1.0))) {}
};

}  // namespace

int Contestant::steps() const {
  return options.has("k") ? options.integer("k") : 1;
}

int Contestant::order() const {
  return method->orders(options).q;
}

std::string_view Contestant::correction() const {
  if (!options.has("correction") || steps() < 3) return "";
  if (options.is_choice("correction")) return "implicit";
  return options.boolean("correction") ? "explicit" : "";
}

std::optional<double> Contestant::rho_inf() const {
  if (!options.has("rho_inf")) return std::nullopt;
  return options.real("rho_inf");
}

bool Contestant::can_be_safeguarded() const {
  return has_option(*method, safeguard_option.name);
}

OptionValues Contestant::options_for(std::string_view form, bool modified_start) const {
  OptionValues values = options;
  values.set("form", std::string(form.empty() ? "index3" : form));
  values.set("modified_start", modified_start);
  values.set("safeguard", safeguard);
  for (const std::string_view key : {form_option.name, modified_start_option.name, safeguard_option.name})
    if (!has_option(*method, key)) values.erase(key);
  for (const OptionInfo& info : method->options)
    if (!applies(info, !form.empty(), values) || goes_without_saying(info, values)) values.erase(info.name);
  return values;
}

Contestant contestant(std::string_view integrator,
                      const std::vector<std::pair<std::string, OptionValue>>& options) {
  const MethodInfo* method = find_method(integrator);
  if (method == nullptr) throw std::logic_error("no integrator " + std::string(integrator));
  Contestant result;
  result.method = method;
  for (const OptionInfo& info : method->options)
    if (info.scope == OptionScope::everywhere) result.options.set(info.name, option_default(info));
  for (const auto& [key, value] : options) result.options.set(key, value);
  result.name = method->title(result.options);
  return result;
}

const std::vector<Contestant>& contestants(bool safeguard) {
  const auto list = [](bool safeguarded) {
    std::vector<Contestant> all;
    for (const int k : {1, 2, 3, 4, 5, 6}) all.push_back(contestant("bliedf2nd", {{"k", k}}));
    all.push_back(contestant("bliedf2nd", {{"k", 3}, {"correction", false}}));
    for (const int k : {4, 5, 6})
      all.push_back(contestant("bliedf2nd", {{"k", k}, {"correction", std::string("implicit")}}));
    for (const double rho : {1.0, 0.9, 0.5, 0.0})
      all.push_back(contestant("generalized_alpha", {{"rho_inf", rho}}));
    for (const int k : {2, 3, 4})
      all.push_back(contestant("faltinsen_bdf", {{"k", k}, {"variant", std::string("exact")}}));
    for (const int k : {3, 4})
      all.push_back(contestant("faltinsen_bdf", {{"k", k}, {"variant", std::string("bch")}}));
    for (const char* tableau : {"rk4", "dopri5", "butcher6"})
      all.push_back(contestant("rkmk", {{"tableau", std::string(tableau)}}));
    all.push_back(contestant("commutator_free", {}));
    all.push_back(contestant("crouch_grossman", {}));
    for (Contestant& each : all) each.safeguard = safeguarded;
    return all;
  };
  static const std::vector<Contestant> plain = list(false), safeguarded = list(true);
  return safeguard ? safeguarded : plain;
}

std::optional<Complex> stability_function(const Contestant& method, Complex z) {
  if (method.is("crouch_grossman")) return stability_function_of(crouch_grossman_three, z);
  if (method.is("commutator_free")) return stability_function_of(classical_four, z);
  if (!method.is("rkmk")) return std::nullopt;
  const std::string& tableau = method.options.choice("tableau");
  if (tableau == "dopri5") return stability_function_of(dormand_prince_five, z);
  if (tableau == "butcher6") return stability_function_of(butcher_six, z);
  return stability_function_of(classical_four, z);
}

double spectral_radius(const Contestant& method, Complex z) {
  if (const auto R = stability_function(method, z)) return std::abs(*R);
  if (method.options.has("k")) {
    // A real system of second order has z and its conjugate; both polynomials have roots of the same sizes.
    return bdf_radius(method.steps(), z);
  }
  const Alpha p(*method.rho_inf());
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
  if (method.options.has("k")) return bdf_radius(method.steps(), z);
  const Alpha p(*method.rho_inf());
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
