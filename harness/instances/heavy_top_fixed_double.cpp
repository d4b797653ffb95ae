#include "harness/heavy_top_runs_impl.h"
#include "harness/instances/heavy_top_steppers.h"

namespace liebench {

template RunResult run_heavy_top<HeavyTopSO3, double>(const RunRequest&, const HeavyTopReference&);
template std::unique_ptr<TimedRun> timed_heavy_top<HeavyTopSO3>(const RunRequest&, const HeavyTopReference&);

template RunResult run_heavy_top<HeavyTopS3, double>(const RunRequest&, const HeavyTopReference&);
template std::unique_ptr<TimedRun> timed_heavy_top<HeavyTopS3>(const RunRequest&, const HeavyTopReference&);

template StepperMaker<HeavyTopSO3<double>> any_stepper;

}  // namespace liebench
