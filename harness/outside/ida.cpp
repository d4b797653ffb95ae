#include <ida/ida.h>

#include <algorithm>
#include <cmath>

#include "harness/outside/stabilized_top.h"
#include "harness/outside/stepping_solver.h"

namespace liebench::outside {

namespace {

constexpr FailureFlags flags{IDA_CONV_FAIL, IDA_LSETUP_FAIL, IDA_LSOLVE_FAIL, IDA_RES_FAIL, IDA_REP_RES_ERR};

// BDF on the stabilized index-2 form, with the multipliers left out of the test of the error: their estimates do not
// fall with the step size as those of the differential variables do [Petzold & Lotstedt 1986; the guide of IDA,
// IDASetSuppressAlg].
class Ida final : public SteppingSolver<StabilizedTop> {
 public:
  Ida(const OptionValues& options, const HeavyTopParameters& parameters, double duration)
      : SteppingSolver(parameters, duration),
        rate_(new_vector<size>(context_, equations_.initial_rate())),
        linear_(context_, y_),
        memory_(require(IDACreate(context_.get()), "IDACreate")) {
    const double tolerance = options.real("tolerance");
    require(IDAInit(memory_.get(), residual, 0.0, y_.get(), rate_.get()), "IDAInit");
    require(IDASetErrHandlerFn(memory_.get(), LastError::handler, &error_), "IDASetErrHandlerFn");
    require(IDASetUserData(memory_.get(), &equations_), "IDASetUserData");
    require(IDASStolerances(memory_.get(), tolerance, tolerance), "IDASStolerances");
    StabilizedTop::Vector kind = StabilizedTop::Vector::Zero();  // 1: differential
    kind.head<StabilizedTop::differential>().setOnes();
    const auto id = new_vector<size>(context_, kind);
    require(IDASetId(memory_.get(), id.get()), "IDASetId");
    require(IDASetSuppressAlg(memory_.get(), SUNTRUE), "IDASetSuppressAlg");
    require(IDASetLinearSolver(memory_.get(), linear_.solver.get(), linear_.matrix.get()),
            "IDASetLinearSolver");
    require(IDASetJacFn(memory_.get(), jacobian), "IDASetJacFn");
    require(IDASetInitStep(memory_.get(), first_step(tolerance)), "IDASetInitStep");
    require(IDASetStopTime(memory_.get(), duration_), "IDASetStopTime");
  }

  void restart() {
    back_to_start();
    numbers_of<size>(rate_.get()) = equations_.initial_rate();
    require(IDAReInit(memory_.get(), 0.0, y_.get(), rate_.get()), "IDAReInit");
    require(IDASetStopTime(memory_.get(), duration_), "IDASetStopTime");
  }
  StepEnd step() {
    return step_by(flags, [&](double* t) {
      return IDASolve(memory_.get(), duration_, t, y_.get(), rate_.get(), IDA_ONE_STEP);
    });
  }

  OutsideCounts counts() const {
    OutsideCounts counts;
    counts.residuals = statistic(memory_, IDAGetNumResEvals);
    counts.jacobians = statistic(memory_, IDAGetNumJacEvals);
    counts.factorizations = statistic(memory_, IDAGetNumLinSolvSetups);
    counts.newton_iterations = statistic(memory_, IDAGetNumNonlinSolvIters);
    counts.solves = counts.newton_iterations;
    counts.rejected_steps =
        statistic(memory_, IDAGetNumErrTestFails) + statistic(memory_, IDAGetNumStepSolveFails);
    return counts;
  }

 private:
  // The step by which the Euler method errs by the tolerance, h^2 |q''| / 2, as CVODE and ARKODE choose their first.
  // IDA's own choice, of h |q'|, is so short for small tolerances that eta and mu, which are round-off over h there, no
  // longer fulfil the test of Newton's iteration: at 1e-8 it gives up at once.
  double first_step(double tolerance) const {
    const double rate = equations_.initial().segment<3>(10).norm() +
                        std::sqrt(equations_.initial_rate().segment<3>(10).norm());
    return std::min(duration_, std::sqrt(2.0 * tolerance) / std::max(rate, 1e-3));
  }

  static int residual(double, N_Vector y, N_Vector rate, N_Vector F, void* equations) {
    auto result = numbers_of<size>(F);
    static_cast<const StabilizedTop*>(equations)->residual(numbers_of<size>(y), numbers_of<size>(rate),
                                                           result);
    return computed(result);
  }
  static int jacobian(double, double c, N_Vector y, N_Vector, N_Vector, SUNMatrix J, void* equations,
                      N_Vector, N_Vector, N_Vector) {
    auto result = numbers_of<size>(J);
    static_cast<const StabilizedTop*>(equations)->jacobian(numbers_of<size>(y), c, result);
    return computed(result);
  }

  Owned<N_Vector> rate_;
  DenseSolver linear_;
  OwnedMemory<IDAFree> memory_;
};

}  // namespace

OutsideRuns ida_runs() {
  return {.run = &run<Ida>, .timed = &timed<Ida>};
}

}  // namespace liebench::outside
