#pragma once

#include <span>
#include <vector>

#include "harness/references/heavy_top_wide.h"
#include "problems/heavy_top_parameters.h"

namespace liebench {

// The heavy top at the given times (positive, ascending [s]) by Gragg-Bulirsch-Stoer extrapolation in
// 50-digit arithmetic, on the nine entries of the rotation matrix and Omega,
//
//   R' = R Omega^,    Omega' = J_fix^{-1} ((J_fix Omega) x Omega + m X x (R^T gamma)),
//
// without projection: neither the method nor the coordinates are those of heavy_top_by_taylor. The modified
// midpoint rule with 2, 4, ..., 32 substeps is extrapolated to order 32; the step keeps the difference of the
// last two columns, an estimate for the lower of the two orders, below 1e-35 relative (Hairer, Norsett &
// Wanner 1993, II.9).
//
// Throws std::invalid_argument for bad parameters (see HeavyTopWideData) or times that do not ascend from
// above 0; std::runtime_error when 10^6 steps do not reach the last time.
std::vector<HeavyTopWitness> heavy_top_by_extrapolation(const HeavyTopParameters& parameters,
                                                        std::span<const double> times);

}  // namespace liebench
