#include "harness/heavy_top_runs_impl.h"
#include "harness/instances/heavy_top_steppers.h"

namespace liebench {

template RunResult run_heavy_top<HeavyTopSO3, Extended>(const RunRequest&, const HeavyTopReference&);
template RunResult run_heavy_top<HeavyTopS3, Extended>(const RunRequest&, const HeavyTopReference&);
template RunResult run_heavy_top<HeavyTopR3xSO3, Extended>(const RunRequest&, const HeavyTopReference&);
template RunResult run_heavy_top<HeavyTopR3xS3, Extended>(const RunRequest&, const HeavyTopReference&);
template RunResult run_heavy_top<HeavyTopSE3, Extended>(const RunRequest&, const HeavyTopReference&);
template RunResult run_heavy_top<HeavyTopS3R3, Extended>(const RunRequest&, const HeavyTopReference&);
template RunResult run_heavy_top<HeavyTopUDQ, Extended>(const RunRequest&, const HeavyTopReference&);

template StepperMaker<ExtendedSO3> any_stepper;
template StepperMaker<ExtendedR3xSO3> any_stepper;
template StepperMaker<ExtendedR3xS3> any_stepper;
template StepperMaker<ExtendedSE3> any_stepper;
template StepperMaker<ExtendedUDQ> any_stepper;

}  // namespace liebench
