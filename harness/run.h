#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "groups/audited_group.h"
#include "groups/counted.h"
#include "groups/extended.h"
#include "integrators/audit.h"
#include "integrators/linear_solver.h"
#include "integrators/option.h"
#include "integrators/outcome.h"
#include "problems/audited_system.h"

// One run as the harness sees it: the request that goes down through the seam and the result that comes back.
// Neither knows a group, a system or a scalar type.

namespace liebench {

enum class Precision { double_precision, extended };

// Where the starting values come from.
enum class Start {
  reference,  // the reference solution, eq. (21)
  self        // initial values alone: integrators/self_start.h
};

struct RunRequest {
  std::string integrator;
  OptionValues options;
  Start start = Start::self;
  // h, s, and N: the run covers t_0, ..., t_0 + N h, starting values included. Of a method that chooses its steps the length of the
  // interval, and the most steps that it may choose.
  Extended step_size;
  std::uint64_t steps = 0;
  bool chooses_steps = false;  // of the method
};

// Errors of one solution component, norms as in docs/records.md.
struct ErrorNorms {
  double end_relative = 0.0;
  double end_absolute = 0.0;
  double max_absolute = 0.0;
};

// Largest deviations from what the exact solution keeps, over 1000 to 2000 equidistant steps (all, where a run has
// fewer) and the last.
struct Drift {
  double energy = 0.0;                        // |E_n - E(t_0)|, J
  double angular_momentum = 0.0;              // |L_n - L(t_0)|, see MechanicalSystem, kg m^2/s
  std::optional<double> position_constraint;  // max-norm of Phi(q_n)
  std::optional<double> velocity_constraint;  // max-norm of B(q_n) v_n
  double group = 0.0;                         // see LieGroup: defect
};

struct RunFailure {
  double time = 0.0;
  std::uint64_t step = 0;  // the step that failed: it would have led to t_0 + step h
  double residual = 0.0;
  std::string message;
};

// What a run costs, its start included, counted in an audit run: the same steps as those of the run, to the last bit.
struct RunCost {
  KernelAudit kernel;
  SystemCalls system;
  GroupCalls group;
  std::optional<Operations> operations;  // of runs in double
};

// In place of it, of a solver from outside (harness/outside/): that solver's own statistics. What it does not have is empty.
struct OutsideCounts {
  std::uint64_t residuals = 0;  // right-hand sides, or residuals of the implicit equations
  std::optional<std::uint64_t> jacobians, factorizations, solves, newton_iterations;
  std::uint64_t rejected_steps = 0;
};

// The times of the repetitions of a run in double, ns.
struct RunTimes {
  std::vector<double> per_step;  // one a repetition
  double start = 0.0;            // of the start, the median
  std::uint64_t steps = 0;       // that `per_step` is the time of: those after the start
  bool steady = true;            // the repetitions agree as well as was asked for
};

struct RunResult {
  Outcome outcome = Outcome::ok;
  std::optional<RunFailure> failure;  // exactly where outcome is not ok
  // Of a run that ended well.
  std::optional<ErrorNorms> q, v, lambda;
  std::optional<Drift> drift;
  // Of a chaotic scene, in place of the errors: the time up to which the run and the reference agree, s.
  std::optional<double> agreement_time;
  std::optional<LinearSolver> solver;  // of Newton's equations, where it depends on their number
  RunCost cost;
  std::optional<OutsideCounts> outside;  // of a solver from outside: `cost` is empty then
  std::uint64_t steps = 0;               // that were taken, those of the start included
  std::vector<double> end_state;         // q, v, lambda where the run ended, rounded to double
};

// A run in double made ready to be timed: no counter, no comparison with the reference. Each call does all of its part.
class TimedRun {
 public:
  virtual ~TimedRun() = default;
  virtual bool start() = 0;   // the starting values, and the stepper's start; false where it failed
  virtual bool follow() = 0;  // all steps after the start, from a copy of the started stepper
  virtual std::uint64_t steps() const = 0;  // of follow()
};

namespace detail {

// What the message of a failure says of its outcome.
constexpr std::string_view explanation(Outcome outcome) {
  switch (outcome) {
    case Outcome::ok:
      return "";
    case Outcome::newton_diverged:
      return "Newton's increments do not shrink; the step size is too large here";
    case Outcome::singular_matrix:
      return "the matrix of the step equation has a zero pivot";
    case Outcome::non_finite:
      return "an infinity or a NaN in the state";
    case Outcome::rotation_too_large:
      return "an increment turns by pi or more; the step size is too large here";
    case Outcome::step_limit:
      return "more steps than allowed";
  }
  return "";
}

// The counts are those of the run only where both went through the same numbers: throws std::logic_error where they did not.
void require_same_path(const RunResult& run, const RunResult& audit, std::string_view where,
                       const RunRequest& request);

}  // namespace detail

}  // namespace liebench
