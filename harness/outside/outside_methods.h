#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/references/heavy_top_reference.h"
#include "harness/run.h"
#include "integrators/fits.h"
#include "integrators/option.h"

// Solvers from outside: what one reaches for where no Lie group method is at hand. They run on the heavy top, each in
// the formulation whose unknowns it has, and those without constraints on scenes without joints, over a whole interval with
// steps of their own; errors are those of that formulation or scene, and the costs what the solver itself counts. They
// are SUNDIALS's, where this program was built with it, and are listed and described where it was not.

namespace liebench {

struct AssembledScene;

namespace detail {
struct ObservedStep;
}

// Sees where each step of a scene ends: an element of the scene's group, stacked, and velocities.
using SceneObserver =
    std::function<void(const detail::ObservedStep&, const Eigen::VectorXd&, const Eigen::VectorXd&)>;

// Null where the program was built without the solver; of scenes where the solver runs on none, too.
struct OutsideRuns {
  RunResult (*run)(const RunRequest&, const HeavyTopReference&) = nullptr;
  std::unique_ptr<TimedRun> (*timed)(const RunRequest&, const HeavyTopReference&) = nullptr;
  // Without errors, which its caller has by `SceneObserver`.
  RunResult (*run_scene)(const RunRequest&, const AssembledScene&, const SceneObserver&) = nullptr;
  std::unique_ptr<TimedRun> (*timed_scene)(const RunRequest&, const AssembledScene&) = nullptr;
};

struct OutsideMethod {
  std::string_view name;
  std::string_view summary;
  Fits fits;
  std::string_view formulation;  // of the heavy top
  bool scenes;                   // those without joints, too
  std::span<const OptionInfo> options;
  std::string (*title)(const OptionValues&);
  ConvergenceOrders (*orders)(const OptionValues&);  // the highest, of a method that chooses its order
  OutsideRuns runs;
};

// The explicit list.
const std::vector<OutsideMethod>& outside_methods();
// Null where none has this name.
const OutsideMethod* find_outside_method(std::string_view name);

// Why none of them can run: a sentence, empty where they can.
std::string_view outside_obstacle();

// "6.4.1"; empty where this program was built without SUNDIALS.
std::string_view sundials_version();

namespace outside {

// Of harness/outside/cvode.cpp and its neighbours; empty where they were not built.
OutsideRuns cvode_bdf_runs();
OutsideRuns cvode_adams_runs();
OutsideRuns arkode_erk_runs();
OutsideRuns arkode_dirk_runs();
OutsideRuns ida_runs();

}  // namespace outside

}  // namespace liebench
