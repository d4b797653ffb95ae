#include "harness/heavy_top_runs_impl.h"

namespace liebench {

template RunResult audit_heavy_top<HeavyTopSE3>(const RunRequest&, const HeavyTopReference&);
template RunResult audit_heavy_top<HeavyTopS3R3>(const RunRequest&, const HeavyTopReference&);
template RunResult audit_heavy_top<HeavyTopUDQ>(const RunRequest&, const HeavyTopReference&);

}  // namespace liebench
