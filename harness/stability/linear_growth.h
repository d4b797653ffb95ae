#pragma once

#include <complex>

#include "harness/stability/contestant.h"
#include "plots/region_map.h"

namespace liebench {

// log10 of the growth per step of the method on x'' = 2 Re(mu) x' - |mu|^2 x, z = h mu, measured: the steps that it takes are those of
// every run, from starting values of no regularity. To about 1e-2 of
// the radius near the unit circle; where it is damped to round-off in a few dozen steps, to a third of the logarithm.
double linear_growth(const Contestant& method, std::complex<double> z);

// Where in the complex plane the methods are stable: by linear_growth() on a grid, one panel a method.
RegionMap stability_regions(int jobs);

}  // namespace liebench
