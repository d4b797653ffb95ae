#include "harness/heavy_top_runs_impl.h"
#include "harness/instances/heavy_top_steppers.h"

namespace liebench {

template RunResult run_heavy_top<HeavyTopR3xSO3, double>(const RunRequest&, const HeavyTopReference&);
template std::unique_ptr<TimedRun> timed_heavy_top<HeavyTopR3xSO3>(const RunRequest&,
                                                                   const HeavyTopReference&);

template RunResult run_heavy_top<HeavyTopR3xS3, double>(const RunRequest&, const HeavyTopReference&);
template std::unique_ptr<TimedRun> timed_heavy_top<HeavyTopR3xS3>(const RunRequest&,
                                                                  const HeavyTopReference&);

template StepperMaker<HeavyTopR3xSO3<double>> any_stepper;

}  // namespace liebench
