#include "harness/stability/tolerance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/stability/linear_theory.h"

namespace liebench {

namespace {

// alpha_0 of the highest order that the method may choose; Runge-Kutta methods leave what they estimate.
double lasting_part(const Contestant& method) {
  return method.is("bliedf2nd_variable") ? 25.0 / 12.0 : 1.0;
}

}  // namespace

double permitted_error(const Contestant& method, std::uint64_t steps, Eigen::Index coordinates) {
  return double(steps) * lasting_part(method) * method.tolerance().value() *
         std::sqrt(2.0 * double(coordinates));
}

double permitted_energy(const Contestant& method, std::uint64_t steps, double energy_of_tolerance) {
  return double(steps) * lasting_part(method) * method.tolerance().value() * energy_of_tolerance;
}

void expect_by_tolerance(Finding& finding, double permitted, double survives, double degraded) {
  finding.expected = Grade::survived;
  finding.at_worst = permitted <= survives || finding.outcome != Outcome::ok ? Grade::survived
                     : permitted <= degraded                                 ? Grade::degraded
                                                                             : Grade::failed;
  finding.measured["permitted"] = permitted;
  finding.reason = fmt::format("local errors within the tolerance add up to {:.2g} at most", permitted);
}

double stable_step(const Contestant& method, std::complex<double> mu) {
  if (!stability_function(method, mu)) return std::numeric_limits<double>::infinity();
  const std::complex<double> direction = mu / std::abs(mu);
  double largest = 0.0;
  for (double r = 0.01; r < 10.0; r += 0.01) {
    // On the imaginary axis the radius leaves 1 by terms of a high order first.
    if (spectral_radius(method, r * direction) > 1.0 + 1e-3) break;
    largest = r;
  }
  return largest;
}

double steps_for_oscillation(const Contestant& method, std::complex<double> mu, double amplitude,
                             double length, Eigen::Index coordinates) {
  const bool multistep = method.is("bliedf2nd_variable");
  const double constant = multistep ? 12.0 / 125.0 : 97.0 / 120000.0;
  const double growth = multistep ? std::pow(2.0, 0.2) : 5.0, tolerance = method.tolerance().value();
  const double stable = stable_step(method, mu), frequency = std::abs(mu);
  const double room = tolerance * std::sqrt(2.0 * double(coordinates));
  const double rate = frequency * amplitude, slope = frequency * rate;
  double h = 0.1 * std::min(0.1, std::pow(tolerance, multistep ? 0.5 : 0.2)) /
             std::max(rate + slope / (1.0 + rate), frequency);
  double steps = 0.0;
  for (double t = 0.0; t < length; t += h, ++steps) {
    const double left = amplitude * std::exp(mu.real() * t), of_v = left * frequency;
    const double size = constant * std::hypot(left, of_v / (1.0 + of_v));
    const double accurate = size > 0.0 ? std::pow(room / size, 0.2) : std::numeric_limits<double>::infinity();
    h = std::min(growth * h, std::min(accurate, stable) / frequency);
  }
  return steps;
}

}  // namespace liebench
