#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstdint>

#include "harness/stability/case.h"
#include "harness/stability/contestant.h"

// What a tolerance promises of a run, whatever steps the method chooses for it.
//
// A step is accepted where the root mean square of its 2 m local errors is at most 1, an error of theta in units of the tolerance, one
// of v in units of tolerance (1 + |v_i|) (integrators/step_control.h). By Cauchy and Schwarz a linear form sum c_i e_i of them is then at
// most sqrt(2 m) |c|, and N steps add up to N times that where the motion neither damps nor amplifies them. The estimate of BLieDF2nd is
// over alpha_0, and what a step leaves for ever over sigma(1) = 1: up to alpha_0 = 25/12 (k = 4) times as much.

namespace liebench {

// Of N steps in a coordinate of theta (m of them), rad or m; of v it is 1 + |v_i| times as much.
double permitted_error(const Contestant& method, std::uint64_t steps, Eigen::Index coordinates);
// Of N steps in the energy, J: the largest WatchedState::energy_of_tolerance of the run.
double permitted_energy(const Contestant& method, std::uint64_t steps, double energy_of_tolerance);

// Sets what the tolerance lets expect of an amount that survives up to `survives` and is degraded up to `degraded`: to survive, and at
// worst what `permitted` of it is. A run that ended early no tolerance permits.
void expect_by_tolerance(Finding& finding, double permitted, double survives, double degraded);

// The largest |z| on the ray of mu, z = h mu, up to which the spectral radius stays at most 1; infinite for a method that is no explicit
// one.
double stable_step(const Contestant& method, std::complex<double> mu);

// How many steps the method needs for x'' = 2 Re(mu) x' - |mu|^2 x over `length`, amplitude A: in each as many radians |z| as
// its error constant allows at the amplitude that is left,
//
//   C |z|^{p} A (1, |mu| / (1 + A |mu|)) = tol sqrt(2 m),     C |z|^p = 97/120000 |z|^5 for the pair of Dormand & Prince,
//                                                                       12/125 |z|^5 for k = 4 over alpha_0
//
// and no more than stable_step(); from the first step on no more than 2^{1/5} times the last of k = 4, which doubles in
// every fifth step, and 5 times of the other.
double steps_for_oscillation(const Contestant& method, std::complex<double> mu, double amplitude,
                             double length, Eigen::Index coordinates);

}  // namespace liebench
