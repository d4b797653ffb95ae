#pragma once

#include <memory>

#include "groups/extended.h"
#include "integrators/list.h"
#include "problems/heavy_top.h"
#include "tests/support/any_stepper.h"

// The steppers of the heavy top take minutes to compile. Those in extended precision are instantiated in the test of the
// orders of each method, those in double in the test of the laws of each formulation, once, and linked everywhere else.

namespace liebench {

using Rotation = HeavyTopSO3<Extended>;
using Body = HeavyTopR3xSO3<Extended>;

template <class Method, class S>
using StepperMaker = std::unique_ptr<AnyStepper<S>>(const typename Method::Options&, const S&);

extern template StepperMaker<BLieDF2nd, Rotation> make_stepper<BLieDF2nd, Rotation, NoAudit>;
extern template StepperMaker<BLieDF2nd, Body> make_stepper<BLieDF2nd, Body, NoAudit>;
extern template StepperMaker<FaltinsenBdf, Rotation> make_stepper<FaltinsenBdf, Rotation, NoAudit>;
extern template StepperMaker<FaltinsenBdf, Body> make_stepper<FaltinsenBdf, Body, NoAudit>;
extern template StepperMaker<GeneralizedAlpha, Rotation> make_stepper<GeneralizedAlpha, Rotation, NoAudit>;
extern template StepperMaker<GeneralizedAlpha, Body> make_stepper<GeneralizedAlpha, Body, NoAudit>;

extern template StepperMaker<BLieDF2nd, HeavyTopSO3<double>>
    make_stepper<BLieDF2nd, HeavyTopSO3<double>, NoAudit>;
extern template StepperMaker<BLieDF2nd, HeavyTopR3xSO3<double>>
    make_stepper<BLieDF2nd, HeavyTopR3xSO3<double>, NoAudit>;
extern template StepperMaker<FaltinsenBdf, HeavyTopSO3<double>>
    make_stepper<FaltinsenBdf, HeavyTopSO3<double>, NoAudit>;
extern template StepperMaker<FaltinsenBdf, HeavyTopR3xSO3<double>>
    make_stepper<FaltinsenBdf, HeavyTopR3xSO3<double>, NoAudit>;

}  // namespace liebench
