#pragma once

#include <memory>

#include "harness/outside/outside_run.h"
#include "harness/outside/quaternion_scene.h"
#include "harness/outside/quaternion_top.h"

// Runs of a solver from outside on a scene without constraints, as those on the heavy top in outside_run.h.

namespace liebench::outside {

template <class Solver>
RunResult run_scene(const RunRequest& request, const AssembledScene& scene, const SceneObserver& observe) {
  const QuaternionScene::Data model = quaternion_model(scene);
  const OwnState own(scene, model);
  Solver solver(request.options, model, to_double(request.step_size));
  RunResult result =
      follow(solver, request, [&](const detail::ObservedStep& step, const QuaternionScene::Vector& y) {
        observe(step, own.configuration(y), own.velocity(y));
      });
  append(result.end_state, own.configuration(solver.y()));
  append(result.end_state, own.velocity(solver.y()));
  return result;
}

template <class Solver>
std::unique_ptr<TimedRun> timed_scene(const RunRequest& request, const AssembledScene& scene) {
  return std::make_unique<TimedSolver<Solver>>(request, quaternion_model(scene));
}

// Of a solver without constraints.
template <template <class> class Solver>
OutsideRuns runs_of() {
  using OfTop = Solver<QuaternionTop>;
  using OfScene = Solver<QuaternionScene>;
  return {&run<OfTop>, &timed<OfTop>, &run_scene<OfScene>, &timed_scene<OfScene>};
}

}  // namespace liebench::outside
