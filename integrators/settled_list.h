#pragma once

#include "integrators/bliedf2nd.h"
#include "integrators/bliedf2nd_variable.h"
#include "integrators/centred_bdf.h"
#include "integrators/commutator_free.h"
#include "integrators/crouch_grossman.h"
#include "integrators/faltinsen_adams.h"
#include "integrators/faltinsen_bdf.h"
#include "integrators/gauss.h"
#include "integrators/generalized_alpha.h"
#include "integrators/half_explicit.h"
#include "integrators/implicit_midpoint.h"
#include "integrators/liemid.h"
#include "integrators/newmark.h"
#include "integrators/radau.h"
#include "integrators/rattlie.h"
#include "integrators/rkmk.h"
#include "integrators/rkmk_variable.h"
#include "integrators/shakelie.h"

namespace liebench {

template <class... Methods>
struct IntegratorList {};

// The integrators that are compiled together, system by system (integrators/list.h has all): those of one list share most of what
// Eigen makes of a system, and any change of it compiles them anew.
using SettledIntegrators =
    IntegratorList<BLieDF2nd, BLieDF2ndVariable, GeneralizedAlpha, FaltinsenBdf, CentredBdf, Rattlie,
                   Shakelie, HalfExplicit, Radau, Gauss, ImplicitMidpoint, Newmark, Liemid, Rkmk,
                   RkmkVariable, CommutatorFree, CrouchGrossman, FaltinsenAdams>;

}  // namespace liebench
