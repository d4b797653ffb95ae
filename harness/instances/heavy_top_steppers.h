#pragma once

#include "harness/instances/run_time_steppers.h"
#include "problems/audited_system.h"
#include "problems/heavy_top.h"

// The steppers of the paper's two formulations take minutes to compile: those of the runs serve tests and benchmarks, too
// (library liebench_runs).

namespace liebench {

using ExtendedSO3 = Audited<HeavyTopSO3<Extended>>;
using ExtendedR3xSO3 = Audited<HeavyTopR3xSO3<Extended>>;
using ExtendedR3xS3 = Audited<HeavyTopR3xS3<Extended>>;
using ExtendedSE3 = Audited<HeavyTopSE3<Extended>>;
using ExtendedUDQ = Audited<HeavyTopUDQ<Extended>>;
using CountedSO3 = Audited<HeavyTopSO3<Counted>>;
using CountedR3xSO3 = Audited<HeavyTopR3xSO3<Counted>>;

extern template StepperMaker<HeavyTopSO3<double>> any_stepper;
extern template StepperMaker<HeavyTopR3xSO3<double>> any_stepper;
extern template StepperMaker<ExtendedSO3> any_stepper;
extern template StepperMaker<ExtendedR3xSO3> any_stepper;
extern template StepperMaker<ExtendedR3xS3> any_stepper;
extern template StepperMaker<ExtendedSE3> any_stepper;
extern template StepperMaker<ExtendedUDQ> any_stepper;
extern template StepperMaker<CountedSO3> any_stepper;
extern template StepperMaker<CountedR3xSO3> any_stepper;

}  // namespace liebench
