#include "harness/heavy_top_runs_impl.h"

template liebench::RunResult liebench::run_heavy_top<liebench::HeavyTopS3, double>(const RunRequest&,
                                                                                   const HeavyTopReference&);

template std::unique_ptr<liebench::TimedRun> liebench::timed_heavy_top<liebench::HeavyTopS3>(
    const RunRequest&, const HeavyTopReference&);
