#include <arkode/arkode_arkstep.h>
#include <arkode/arkode_erkstep.h>

#include "harness/outside/stepping_solver.h"

namespace liebench::outside {

namespace {

constexpr FailureFlags flags{ARK_CONV_FAILURE, ARK_LSETUP_FAIL, ARK_LSOLVE_FAIL, ARK_RHSFUNC_FAIL,
                             ARK_UNREC_RHSFUNC_ERR};

// Quaternions are normalised where they are read, and nowhere else: their length has no effect.
template <class Equations>
class ArkodeErk final : public QuaternionSolver<Equations> {
  using Base = QuaternionSolver<Equations>;
  using Base::back_to_start, Base::context_, Base::derivative, Base::duration_, Base::equations_,
      Base::error_, Base::step_by, Base::y_;

 public:
  ArkodeErk(const OptionValues& options, const typename Equations::Data& data, double duration)
      : Base(data, duration),
        memory_(require(ERKStepCreate(derivative, 0.0, y_.get(), context_.get()), "ERKStepCreate")) {
    const double tolerance = options.real("tolerance");
    require(ERKStepSetErrHandlerFn(memory_.get(), LastError::handler, &error_), "ERKStepSetErrHandlerFn");
    require(ERKStepSetUserData(memory_.get(), &equations_), "ERKStepSetUserData");
    require(ERKStepSStolerances(memory_.get(), tolerance, tolerance), "ERKStepSStolerances");
    require(ERKStepSetOrder(memory_.get(), options.integer("order")), "ERKStepSetOrder");
    require(ERKStepSetStopTime(memory_.get(), duration_), "ERKStepSetStopTime");
  }

  void restart() {
    back_to_start();
    require(ERKStepReInit(memory_.get(), derivative, 0.0, y_.get()), "ERKStepReInit");
    require(ERKStepSetStopTime(memory_.get(), duration_), "ERKStepSetStopTime");
  }
  StepEnd step() {
    return step_by(
        flags, [&](double* t) { return ERKStepEvolve(memory_.get(), duration_, y_.get(), t, ARK_ONE_STEP); });
  }
  OutsideCounts counts() const {
    OutsideCounts counts;
    counts.residuals = statistic(memory_, ERKStepGetNumRhsEvals);
    counts.rejected_steps = statistic(memory_, ERKStepGetNumErrTestFails);
    return counts;
  }

 private:
  OwnedMemory<ERKStepFree> memory_;
};

// As ArkodeErk; the stages by Newton's method.
template <class Equations>
class ArkodeDirk final : public QuaternionSolver<Equations> {
  using Base = QuaternionSolver<Equations>;
  using Base::back_to_start, Base::context_, Base::derivative, Base::duration_, Base::equations_,
      Base::error_, Base::step_by, Base::y_;

 public:
  ArkodeDirk(const OptionValues& options, const typename Equations::Data& data, double duration)
      : Base(data, duration),
        linear_(context_, y_),
        memory_(require(ARKStepCreate(nullptr, derivative, 0.0, y_.get(), context_.get()), "ARKStepCreate")) {
    const double tolerance = options.real("tolerance");
    require(ARKStepSetErrHandlerFn(memory_.get(), LastError::handler, &error_), "ARKStepSetErrHandlerFn");
    require(ARKStepSetUserData(memory_.get(), &equations_), "ARKStepSetUserData");
    require(ARKStepSStolerances(memory_.get(), tolerance, tolerance), "ARKStepSStolerances");
    require(ARKStepSetOrder(memory_.get(), options.integer("order")), "ARKStepSetOrder");
    require(ARKStepSetLinearSolver(memory_.get(), linear_.solver.get(), linear_.matrix.get()),
            "ARKStepSetLinearSolver");
    require(ARKStepSetJacFn(memory_.get(), Base::jacobian), "ARKStepSetJacFn");
    require(ARKStepSetStopTime(memory_.get(), duration_), "ARKStepSetStopTime");
  }

  void restart() {
    back_to_start();
    require(ARKStepReInit(memory_.get(), nullptr, derivative, 0.0, y_.get()), "ARKStepReInit");
    require(ARKStepSetStopTime(memory_.get(), duration_), "ARKStepSetStopTime");
  }
  StepEnd step() {
    return step_by(
        flags, [&](double* t) { return ARKStepEvolve(memory_.get(), duration_, y_.get(), t, ARK_ONE_STEP); });
  }
  OutsideCounts counts() const {
    long explicit_evaluations = 0, implicit_evaluations = 0;
    require(ARKStepGetNumRhsEvals(memory_.get(), &explicit_evaluations, &implicit_evaluations),
            "ARKStepGetNumRhsEvals");
    OutsideCounts counts;
    counts.residuals = std::uint64_t(implicit_evaluations);
    counts.jacobians = statistic(memory_, ARKStepGetNumJacEvals);
    counts.factorizations = statistic(memory_, ARKStepGetNumLinSolvSetups);
    counts.newton_iterations = statistic(memory_, ARKStepGetNumNonlinSolvIters);
    counts.solves = counts.newton_iterations;
    counts.rejected_steps =
        statistic(memory_, ARKStepGetNumErrTestFails) + statistic(memory_, ARKStepGetNumStepSolveFails);
    return counts;
  }

 private:
  DenseSolver linear_;
  OwnedMemory<ARKStepFree> memory_;
};

}  // namespace

OutsideRuns arkode_erk_runs() {
  return runs_of<ArkodeErk>();
}
OutsideRuns arkode_dirk_runs() {
  return runs_of<ArkodeDirk>();
}

}  // namespace liebench::outside
