#pragma once

#include "harness/references/heavy_top_reference.h"
#include "harness/run.h"

namespace liebench {

// One run of the heavy top in the formulation System<T>. Instantiated in harness/instances/, one file a
// formulation and scalar, so that they compile side by side.
template <template <class> class System, class T>
RunResult run_heavy_top(const RunRequest& request, const HeavyTopReference& reference);

}  // namespace liebench
