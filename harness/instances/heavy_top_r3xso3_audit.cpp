#include "harness/heavy_top_runs_impl.h"

template liebench::RunResult liebench::audit_heavy_top<liebench::HeavyTopR3xSO3>(const RunRequest&,
                                                                                 const HeavyTopReference&);
