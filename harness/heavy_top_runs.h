#pragma once

#include <memory>

#include "harness/references/heavy_top_reference.h"
#include "harness/run.h"

namespace liebench {

// Runs of the heavy top in the formulation System<T>. Instantiated in harness/instances/, the formulations of one
// kind and scalar in one file.
template <template <class> class System, class T>
RunResult run_heavy_top(const RunRequest& request, const HeavyTopReference& reference);

// The run in double, counted in Counted.
template <template <class> class System>
RunResult audit_heavy_top(const RunRequest& request, const HeavyTopReference& reference);

// The run in double, to be timed.
template <template <class> class System>
std::unique_ptr<TimedRun> timed_heavy_top(const RunRequest& request, const HeavyTopReference& reference);

}  // namespace liebench
