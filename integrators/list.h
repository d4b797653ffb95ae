#pragma once

#include "integrators/bliedf2nd.h"
#include "integrators/faltinsen_bdf.h"
#include "integrators/generalized_alpha.h"

namespace liebench {

template <class... Methods>
struct IntegratorList {};

// Every integrator of the program. A method that is not in this list is nowhere; one that is in it is in
// every command.
using Integrators = IntegratorList<BLieDF2nd, GeneralizedAlpha, FaltinsenBdf>;

}  // namespace liebench
