#pragma once

#include "harness/heavy_top_runs.h"
#include "harness/instances/run_time_steppers.h"
#include "harness/run_method.h"
#include "problems/audited_system.h"
#include "problems/heavy_top.h"

namespace liebench {

namespace detail {

// The solution of the reference in the formulation System.
template <template <class> class System>
auto exact_solution(const HeavyTopReference& reference) {
  return [&reference, system = System<Extended>(reference.parameters())](const Extended& t) {
    const HeavyTopState s = reference.at(t);
    return SolutionPoint<System<Extended>>{t, system.configuration(s.R), system.velocity(s.R, s.omega),
                                           system.acceleration(s.R, s.omega, s.omega_dot),
                                           system.multipliers(s.R, s.omega, s.omega_dot)};
  };
}

}  // namespace detail

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
