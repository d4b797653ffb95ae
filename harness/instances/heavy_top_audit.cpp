#include "harness/heavy_top_runs_impl.h"
#include "harness/instances/heavy_top_steppers.h"

namespace liebench {

template RunResult audit_heavy_top<HeavyTopSO3>(const RunRequest&, const HeavyTopReference&);
template RunResult audit_heavy_top<HeavyTopS3>(const RunRequest&, const HeavyTopReference&);
template RunResult audit_heavy_top<HeavyTopR3xSO3>(const RunRequest&, const HeavyTopReference&);
template RunResult audit_heavy_top<HeavyTopR3xS3>(const RunRequest&, const HeavyTopReference&);
template RunResult audit_heavy_top<HeavyTopSE3>(const RunRequest&, const HeavyTopReference&);
template RunResult audit_heavy_top<HeavyTopS3R3>(const RunRequest&, const HeavyTopReference&);
template RunResult audit_heavy_top<HeavyTopUDQ>(const RunRequest&, const HeavyTopReference&);

template StepperMaker<CountedSO3> any_stepper;
template StepperMaker<CountedR3xSO3> any_stepper;

}  // namespace liebench
