#include "harness/heavy_top_runs_impl.h"

template liebench::RunResult liebench::run_heavy_top<liebench::HeavyTopUDQ, liebench::Extended>(
    const RunRequest&, const HeavyTopReference&);
