#pragma once

#include <limits>
#include <string_view>

namespace liebench {

// How a step, and so a run, ended. A numerical failure is a recorded outcome, never an exception.
enum class Outcome {
  ok,
  newton_diverged,     // the increments grow, or stay above the round-off floor, with a fresh Newton matrix
  singular_matrix,     // the Newton matrix, or a matrix of the starting procedure, has a zero pivot
  non_finite,          // a residual or a state holds an infinity or a NaN
  rotation_too_large,  // an increment turns by pi or more: the logarithm is not unique there
  step_limit,          // more steps than allowed
};

constexpr std::string_view name(Outcome outcome) {
  switch (outcome) {
    case Outcome::ok:
      return "ok";
    case Outcome::newton_diverged:
      return "newton_diverged";
    case Outcome::singular_matrix:
      return "singular_matrix";
    case Outcome::non_finite:
      return "non_finite";
    case Outcome::rotation_too_large:
      return "rotation_too_large";
    case Outcome::step_limit:
      return "step_limit";
  }
  return "unknown";
}

// How one step ended. `residual`: where it failed, the maximum norm of the scaled residual (h r, Phi / h) of
// the last Newton iteration; NaN where there is none.
struct StepResult {
  Outcome outcome = Outcome::ok;
  double residual = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace liebench
