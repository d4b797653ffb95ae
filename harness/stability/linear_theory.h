#pragma once

#include <complex>
#include <optional>

#include "harness/stability/contestant.h"

// What linear theory says of the methods: from the literature, not from their code, with which a test compares it
// (tests/harness/stability/contestant_test.cpp).

namespace liebench {

// The spectral radius of the method on x'' = 2 Re(mu) x' - |mu|^2 x, whose solutions are exp(mu t) and its conjugate, z = h mu: by
// the characteristic polynomial of the method in the literature, not by its code. Errors of the linear motion grow where it is
// above 1. Not of a BDF method that chooses its steps and orders: it has no such polynomial.
//
//   k-step BDF         sum_{i=0}^k alpha_i zeta^{k-i} = z zeta^k                      [Hairer & Wanner, Solving ODE II, V.1]
//   generalized-alpha  amplification matrix of (x, h x', h^2 a)                      [Chung & Hulbert 1993]
//   Runge-Kutta        R(z) = 1 + z b^T (I - z A)^{-1} (1, ..., 1) of the tableau, Pade's (s, s) of Gauss and (2, 3) of Radau IIA
//                      [Hairer & Wanner, IV.2, IV.3]
//   Adams-Bashforth    zeta^k - zeta^{k-1} = z sum_i b_i zeta^{k-i}
//   RATTLie, SHAKELie, LIEMID   Stoermer & Verlet's method
double spectral_radius(const Contestant& method, std::complex<double> z);

// R(z) of a Runge-Kutta method in a linear space; empty for any other.
std::optional<std::complex<double>> stability_function(const Contestant& method, std::complex<double> z);

// Whether a step takes its forces where it begins, or nothing but what it has computed before: what is stiff is then unstable.
bool explicit_in_forces(const Contestant& method);

// The same of v' = lambda v, z = h lambda, the law of a velocity without restoring force.
double velocity_spectral_radius(const Contestant& method, std::complex<double> z);

// Of Faltinsen's Adams-Bashforth method at a constant rotation by `angle` a step: how a disturbance d of the increments across the axis
// grows at undisturbed velocities. With [e_3, .] = i on the plane across and the eigenvalue t(a) = (1 - exp(-i a)) / (i a) of T(a e_3)
// there, a logarithm over i steps is disturbed by D_i, and the increment by
//
//   D_i = t(a) / t(i a) sum_{j=0}^{i-1} exp(-i j a) d_{n-j},   d_{n+1} = sum_{i=1}^{k-1} b_{i+1} (1 - 1 / t(-i a)) D_i / i
double adams_increment_radius(int k, double angle);

// Of variant "bch" of Faltinsen BDF, k = 3, 4, at a constant rotation by `angle` a step: how a disturbance d of the increments across the
// axis grows at undisturbed velocities, where the series are cut off; with [e_3, .] = i on the plane across,
//
//   w' = alpha_0 d_0 - alpha_2 d_1 + alpha_3 s' + alpha_4 c',   s' = -(d_1 + d_2) + i angle (d_2 - d_1) / 2
//   z' = -i angle (s' + 2 d_3),   c' = s' - d_3 - z' / 2 + i angle z' / 12
//   0 = w' - p' / 2 + i angle p' / 6,   p' = i angle (w' - d_0)                       (the last term of each for k = 4 alone)
double truncation_spectral_radius(int k, double angle);

}  // namespace liebench
