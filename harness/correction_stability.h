#pragma once

namespace liebench {

// The stability of the correction term of BLieDF2nd in the index-3 form.
//
// There the constraint fixes the increments, so that errors e of the velocity obey e_{n+1} = -h^2 dL_k. Linearised about
// a constant velocity v, whose commutator [v, .] has the eigenvalues x = +-i h |v| (in units of 1/h),
//
//   h^2 dL = x/12 ( a + (x b - x^2 a - c) / 60 )
//
// with a = h v', b = h^2 v'', c = h^3 v''' of the errors by the formulas of integrators/lie_correction.h (for k = 3, 4 the
// first term alone). This is a linear recursion in k (explicit) or k + 1 (implicit) errors.

// The spectral radius of that recursion: the largest |z| of its solutions z^n. 3 <= k <= 6.
double correction_spectral_radius(int k, bool implicit, double h_times_speed);

// The largest h |v| up to which the spectral radius is at most 1, searched up to `limit`.
double correction_stability_bound(int k, bool implicit, double limit = 10.0);

}  // namespace liebench
