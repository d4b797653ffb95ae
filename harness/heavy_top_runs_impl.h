#pragma once

#include "harness/heavy_top_runs.h"
#include "harness/heavy_top_solution.h"
#include "harness/instances/run_time_steppers.h"
#include "harness/run_method.h"
#include "problems/audited_system.h"
#include "problems/heavy_top.h"

namespace liebench {

template <template <class> class System, class T>
RunResult run_heavy_top(const RunRequest& request, const HeavyTopReference& reference) {
  const System<T> system(reference.parameters());
  const auto exact = detail::exact_solution<System>(reference);
  if constexpr (std::is_same_v<T, double>)
    return accuracy_run(request, system, exact);
  else
    return accuracy_run(request, Audited<System<T>>(system), exact);
}

template <template <class> class System>
RunResult audit_heavy_top(const RunRequest& request, const HeavyTopReference& reference) {
  const Audited system{System<Counted>(reference.parameters())};
  return audit_run(request, system, detail::exact_solution<System>(reference));
}

template <template <class> class System>
std::unique_ptr<TimedRun> timed_heavy_top(const RunRequest& request, const HeavyTopReference& reference) {
  const System<double> system(reference.parameters());
  return timed_run(request, system, detail::exact_solution<System>(reference));
}

}  // namespace liebench
