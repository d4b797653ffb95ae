#pragma once

#include <complex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/methods.h"
#include "integrators/option.h"

namespace liebench {

// A method with its options as the stability suite runs it: a row of its picture.
struct Contestant {
  const MethodInfo* method = nullptr;
  OptionValues options;    // complete but for the form, and what depends on it
  std::string name;        // as in all tables, method_name()
  bool safeguard = false;  // the option of the kernel

  // A generalized-alpha method has one step.
  int steps() const;
  // Of convergence.
  int order() const;
  bool is(std::string_view integrator) const { return method->name == integrator; }
  // "explicit", "implicit" or "" where no correction term is computed.
  std::string_view correction() const;
  // Whether the method has the option `safeguard`, for it solves an equation in each step.
  bool can_be_safeguarded() const;
  // rho_inf of generalized-alpha.
  std::optional<double> rho_inf() const;
  // All options for a form; "" for a system without constraints. `modified_start`: where it means something.
  OptionValues options_for(std::string_view form, bool modified_start = true) const;
};

// Every method of the list with the options that set its members apart.
const std::vector<Contestant>& contestants(bool safeguard);
// One that the suite wants beside them.
Contestant contestant(std::string_view integrator,
                      const std::vector<std::pair<std::string, OptionValue>>& options);

// The spectral radius of the method on x'' = 2 Re(mu) x' - |mu|^2 x, whose solutions are exp(mu t) and its conjugate, z = h mu: by
// the characteristic polynomial of the method in the literature, not by its code. Errors of the linear motion grow where it is
// above 1.
//
//   k-step BDF         sum_{i=0}^k alpha_i zeta^{k-i} = z zeta^k                      [Hairer & Wanner, Solving ODE II, V.1]
//   generalized-alpha  amplification matrix of (x, h x', h^2 a)                      [Chung & Hulbert 1993]
//   explicit           R(z) = 1 + z b^T (I - z A)^{-1} (1, ..., 1) of the tableau   [Hairer & Wanner, IV.2]
double spectral_radius(const Contestant& method, std::complex<double> z);

// R(z) of an explicit Runge-Kutta method in a linear space; empty for any other.
std::optional<std::complex<double>> stability_function(const Contestant& method, std::complex<double> z);

// The same of v' = lambda v, z = h lambda, the law of a velocity without restoring force.
double velocity_spectral_radius(const Contestant& method, std::complex<double> z);

// Of variant "bch" of Faltinsen BDF, k = 3, 4, at a constant rotation by `angle` a step: how a disturbance d of the increments across the
// axis grows at undisturbed velocities, where the series are cut off; with [e_3, .] = i on the plane across,
//
//   w' = alpha_0 d_0 - alpha_2 d_1 + alpha_3 s' + alpha_4 c',   s' = -(d_1 + d_2) + i angle (d_2 - d_1) / 2
//   z' = -i angle (s' + 2 d_3),   c' = s' - d_3 - z' / 2 + i angle z' / 12
//   0 = w' - p' / 2 + i angle p' / 6,   p' = i angle (w' - d_0)                       (the last term of each for k = 4 alone)
double truncation_spectral_radius(int k, double angle);

}  // namespace liebench
