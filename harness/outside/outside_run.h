#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/heavy_top_solution.h"
#include "harness/monitor.h"
#include "harness/outside/outside_methods.h"

// Runs of a solver from outside, as those of a method of integrators/list.h in harness/run_method.h. A Solver is
//
//   System<T>                                the formulation in which its errors are looked at
//   Solver(options, parameters, duration)    made, and ready to step from t = 0; `options` of its method
//   restart()                                ready again, and nothing is made anew
//   step()                                   one step that it accepts; the last ends where the interval does
//   time(), finished()
//   configuration(), velocity(), multipliers()    what it holds now, the quaternion normalised
//   counts()                                 since it was ready

namespace liebench::outside {

// How a step ended, and where it did not end well what the solver says of it.
struct StepEnd {
  Outcome outcome = Outcome::ok;
  std::string message{};
};

template <class Solver>
std::vector<double> state_of(const Solver& solver) {
  using Group = typename Solver::template System<double>::Group;
  std::vector<double> state;
  const auto append = [&](const auto& vector) { state.insert(state.end(), vector.begin(), vector.end()); };
  append(Group::stacked(solver.configuration()));
  append(solver.velocity());
  append(solver.multipliers());
  return state;
}

template <class Solver>
RunResult run(const RunRequest& request, const HeavyTopReference& reference) {
  using System = typename Solver::template System<double>;
  RunResult result;
  const System system(reference.parameters());
  const auto exact = detail::exact_solution<Solver::template System>(reference);
  detail::Monitor<System> monitor(system, detail::drift_stride(request));
  Solver solver(request.options, reference.parameters(), to_double(request.step_size));
  for (std::uint64_t n = 1; !solver.finished(); ++n) {
    const StepEnd end = n > request.steps ? StepEnd{Outcome::step_limit,
                                                    std::string(detail::explanation(Outcome::step_limit))}
                                          : solver.step();
    if (end.outcome != Outcome::ok) {
      result.outcome = end.outcome;
      result.failure = RunFailure{.time = solver.time(),
                                  .step = n,
                                  .residual = std::numeric_limits<double>::quiet_NaN(),
                                  .message = end.message};
      break;
    }
    const Extended t(solver.time());
    monitor.observe({n, t, solver.finished()}, solver.configuration(), solver.velocity(),
                    solver.multipliers(), exact(t));
    result.steps = n;
  }
  if (result.outcome == Outcome::ok) monitor.report(result);
  result.outside = solver.counts();
  result.end_state = state_of(solver);
  return result;
}

// The start is the solver's making. Its copy for the steps is the solver itself, made ready again.
template <class Solver>
class TimedSolver final : public TimedRun {
 public:
  TimedSolver(const RunRequest& request, const HeavyTopReference& reference)
      : options_(request.options),
        parameters_(reference.parameters()),
        duration_(to_double(request.step_size)) {
    start();
    while (!solver_->finished() && solver_->step().outcome == Outcome::ok) ++steps_;
  }
  bool start() override {
    solver_.emplace(options_, parameters_, duration_);
    return true;
  }
  bool follow() override {
    solver_->restart();
    while (!solver_->finished())
      if (solver_->step().outcome != Outcome::ok) return false;
    return true;
  }
  std::uint64_t steps() const override { return steps_; }

 private:
  OptionValues options_;
  HeavyTopParameters parameters_;
  double duration_;
  std::uint64_t steps_ = 0;
  std::optional<Solver> solver_;
};

template <class Solver>
OutsideRuns runs_of() {
  return {&run<Solver>,
          [](const RunRequest& request, const HeavyTopReference& reference) -> std::unique_ptr<TimedRun> {
            return std::make_unique<TimedSolver<Solver>>(request, reference);
          }};
}

}  // namespace liebench::outside
