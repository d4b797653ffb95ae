#include "harness/heavy_top_runs_impl.h"

template liebench::RunResult liebench::run_heavy_top<liebench::HeavyTopSE3, double>(const RunRequest&,
                                                                                    const HeavyTopReference&);
