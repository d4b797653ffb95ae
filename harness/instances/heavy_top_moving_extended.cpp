#include "harness/heavy_top_runs_impl.h"

namespace liebench {

template RunResult run_heavy_top<HeavyTopSE3, Extended>(const RunRequest&, const HeavyTopReference&);
template RunResult run_heavy_top<HeavyTopS3R3, Extended>(const RunRequest&, const HeavyTopReference&);
template RunResult run_heavy_top<HeavyTopUDQ, Extended>(const RunRequest&, const HeavyTopReference&);

}  // namespace liebench
