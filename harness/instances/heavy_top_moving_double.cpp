#include "harness/heavy_top_runs_impl.h"

namespace liebench {

template RunResult run_heavy_top<HeavyTopSE3, double>(const RunRequest&, const HeavyTopReference&);
template std::unique_ptr<TimedRun> timed_heavy_top<HeavyTopSE3>(const RunRequest&, const HeavyTopReference&);

template RunResult run_heavy_top<HeavyTopS3R3, double>(const RunRequest&, const HeavyTopReference&);
template std::unique_ptr<TimedRun> timed_heavy_top<HeavyTopS3R3>(const RunRequest&, const HeavyTopReference&);

template RunResult run_heavy_top<HeavyTopUDQ, double>(const RunRequest&, const HeavyTopReference&);
template std::unique_ptr<TimedRun> timed_heavy_top<HeavyTopUDQ>(const RunRequest&, const HeavyTopReference&);

}  // namespace liebench
