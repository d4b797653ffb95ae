#include <cvode/cvode.h>
#include <sundials/sundials_config.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <iterator>

#include "harness/outside/stepping_solver.h"

namespace liebench {

std::string_view sundials_version() {
  return SUNDIALS_VERSION;
}

namespace outside {

namespace {

constexpr FailureFlags flags{CV_CONV_FAILURE, CV_LSETUP_FAIL, CV_LSOLVE_FAIL, CV_RHSFUNC_FAIL,
                             CV_UNREC_RHSFUNC_ERR};

// Without acceleration.
struct FixedPointSolver {
  Owned<SUNNonlinearSolver> solver;

  FixedPointSolver(const Owned<SUNContext>& context, const Owned<N_Vector>& v)
      : solver(require(SUNNonlinSol_FixedPoint(v.get(), 0, context.get()), "SUNNonlinSol_FixedPoint")) {}
};

// CVODE with `Algebra` for the equations of its steps, which outlives its memory.
template <class Equations, class Algebra>
class Cvode : public QuaternionSolver<Equations> {
  using Base = QuaternionSolver<Equations>;

 public:
  void restart() {
    back_to_start();
    require(CVodeReInit(memory_.get(), 0.0, y_.get()), "CVodeReInit");
    require(CVodeSetStopTime(memory_.get(), duration_), "CVodeSetStopTime");
  }
  StepEnd step() {
    return step_by(flags,
                   [&](double* t) { return CVode(memory_.get(), duration_, y_.get(), t, CV_ONE_STEP); });
  }

 protected:
  using Base::back_to_start, Base::context_, Base::derivative, Base::duration_, Base::equations_,
      Base::error_, Base::step_by, Base::y_;

  Cvode(int family, const OptionValues& options, const typename Equations::Data& data, double duration)
      : Base(data, duration),
        algebra_(context_, y_),
        memory_(require(CVodeCreate(family, context_.get()), "CVodeCreate")) {
    const double tolerance = options.real("tolerance");
    require(CVodeInit(memory_.get(), derivative, 0.0, y_.get()), "CVodeInit");
    require(CVodeSetErrHandlerFn(memory_.get(), LastError::handler, &error_), "CVodeSetErrHandlerFn");
    require(CVodeSetUserData(memory_.get(), &equations_), "CVodeSetUserData");
    require(CVodeSStolerances(memory_.get(), tolerance, tolerance), "CVodeSStolerances");
    require(CVodeSetStopTime(memory_.get(), duration_), "CVodeSetStopTime");
  }
  ~Cvode() = default;

  OutsideCounts counts_of_steps() const {
    OutsideCounts counts;
    counts.residuals = statistic(memory_, CVodeGetNumRhsEvals);
    counts.rejected_steps =
        statistic(memory_, CVodeGetNumErrTestFails) + statistic(memory_, CVodeGetNumStepSolveFails);
    return counts;
  }

  Algebra algebra_;
  OwnedMemory<CVodeFree> memory_;
};

// BDF with Newton's method. After every step quaternions are normalised, and the estimate of their error loses the part
// along them [Eich 1993]; CVODE has this for BDF alone.
template <class Equations>
class CvodeBdf final : public Cvode<Equations, DenseSolver> {
  using Base = Cvode<Equations, DenseSolver>;
  using Base::algebra_, Base::equations_, Base::memory_, Base::size;

 public:
  CvodeBdf(const OptionValues& options, const typename Equations::Data& data, double duration)
      : Base(CV_BDF, options, data, duration) {
    require(CVodeSetLinearSolver(memory_.get(), algebra_.solver.get(), algebra_.matrix.get()),
            "CVodeSetLinearSolver");
    require(CVodeSetJacFn(memory_.get(), Base::jacobian), "CVodeSetJacFn");
    if (!std::empty(equations_.quaternions()))
      require(CVodeSetProjFn(memory_.get(), project), "CVodeSetProjFn");
  }

  OutsideCounts counts() const {
    OutsideCounts counts = Base::counts_of_steps();
    counts.jacobians = statistic(memory_, CVodeGetNumJacEvals);
    counts.factorizations = statistic(memory_, CVodeGetNumLinSolvSetups);
    counts.newton_iterations = statistic(memory_, CVodeGetNumNonlinSolvIters);
    counts.solves = counts.newton_iterations;
    return counts;
  }

 private:
  static int project(double, N_Vector y, N_Vector correction, double, N_Vector error, void* equations) {
    auto change = numbers_of<size>(correction);
    change.setZero();
    for (const Eigen::Index place : static_cast<const Equations*>(equations)->quaternions()) {
      const Vector4 p = numbers_of<size>(y).template segment<4>(place), unit = p.normalized();
      change.template segment<4>(place) = unit - p;
      if (error == nullptr) continue;
      auto along = numbers_of<size>(error).template segment<4>(place);
      along -= along.dot(unit) * unit;
    }
    return computed(change);
  }
};

// Adams-Moulton formulas with fixed-point iteration, as CVODE's guide has it for equations that are not stiff. Nothing
// is normalised but what is read: the length of a quaternion, which has no effect, stays within the error of the
// steps.
template <class Equations>
class CvodeAdams final : public Cvode<Equations, FixedPointSolver> {
  using Base = Cvode<Equations, FixedPointSolver>;

 public:
  CvodeAdams(const OptionValues& options, const typename Equations::Data& data, double duration)
      : Base(CV_ADAMS, options, data, duration) {
    require(CVodeSetNonlinearSolver(Base::memory_.get(), Base::algebra_.solver.get()),
            "CVodeSetNonlinearSolver");
  }

  OutsideCounts counts() const { return Base::counts_of_steps(); }
};

}  // namespace

OutsideRuns cvode_bdf_runs() {
  return runs_of<CvodeBdf>();
}
OutsideRuns cvode_adams_runs() {
  return runs_of<CvodeAdams>();
}

}  // namespace outside

}  // namespace liebench
