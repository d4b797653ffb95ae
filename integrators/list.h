#pragma once

#include "integrators/bliedf2nd.h"
#include "integrators/bliedf2nd_variable.h"
#include "integrators/commutator_free.h"
#include "integrators/crouch_grossman.h"
#include "integrators/faltinsen_bdf.h"
#include "integrators/generalized_alpha.h"
#include "integrators/rkmk.h"
#include "integrators/rkmk_variable.h"

namespace liebench {

template <class... Methods>
struct IntegratorList {};

// Every integrator of the program. A method that is not in this list is nowhere; one that is in it is in
// every command.
using Integrators = IntegratorList<BLieDF2nd, BLieDF2ndVariable, GeneralizedAlpha, FaltinsenBdf, Rkmk,
                                   RkmkVariable, CommutatorFree, CrouchGrossman>;

}  // namespace liebench
