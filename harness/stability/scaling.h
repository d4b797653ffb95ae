#pragma once

#include "harness/table.h"

namespace liebench {

// What the scaling of the step equation by the step size is for: the Newton matrix of the paper's top (R^3 x SO(3), index 3,
// BLieDF2nd with k = 3) in the unknowns (Dq, h lambda) with the residual (h r, Phi / h), and in (h Dq, lambda) with (r, Phi), as the
// equations stand. For each step size: the condition of both; the rank that a rank-revealing factorization in double makes of them,
// of 9; and the relative error of lambda where both are solved in double for a right side whose solution is known.
Table scaling_table();

}  // namespace liebench
