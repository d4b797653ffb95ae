#pragma once

#include "harness/heavy_top_runs.h"
#include "harness/run_method.h"
#include "problems/heavy_top.h"

namespace liebench {

template <template <class> class System, class T>
RunResult run_heavy_top(const RunRequest& request, const HeavyTopReference& reference) {
  const System<T> system(reference.parameters());
  const System<Extended> exact_system(reference.parameters());
  const auto exact = [&](const Extended& t) {
    const HeavyTopState s = reference.at(t);
    return SolutionPoint<System<Extended>>{t, exact_system.configuration(s.R),
                                           exact_system.velocity(s.R, s.omega),
                                           exact_system.acceleration(s.R, s.omega, s.omega_dot),
                                           exact_system.multipliers(s.R, s.omega, s.omega_dot)};
  };
  return run_method(request, system, exact);
}

}  // namespace liebench
