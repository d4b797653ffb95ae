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
//   Equations                           what it integrates, with the type Data of what they are made of
//   Solver(options, data, duration)     made, and ready to step from t = 0; `options` of its method
//   restart()                           ready again, and nothing is made anew
//   step()                              one step that it accepts; the last ends where the interval does
//   time(), finished(), y()             what it holds now
//   counts()                            since it was ready

namespace liebench::outside {

// How a step ended, and where it did not end well what the solver says of it.
struct StepEnd {
  Outcome outcome = Outcome::ok;
  std::string message{};
};

// All steps of `solver`. `observe(step, y)` sees where each of them ends.
template <class Solver, class Observer>
RunResult follow(Solver& solver, const RunRequest& request, const Observer& observe) {
  RunResult result;
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
    observe(detail::ObservedStep{n, Extended(solver.time()), solver.finished()}, solver.y());
    result.steps = n;
  }
  result.outside = solver.counts();
  return result;
}

template <class Vector>
void append(std::vector<double>& state, const Vector& numbers) {
  state.insert(state.end(), numbers.begin(), numbers.end());
}

// On the heavy top, in the formulation Equations::System.
template <class Solver>
RunResult run(const RunRequest& request, const HeavyTopReference& reference) {
  using Equations = typename Solver::Equations;
  using System = typename Equations::template System<double>;
  const System system(reference.parameters());
  const auto exact = detail::exact_solution<Equations::template System>(reference);
  detail::Monitor<System> monitor(system, detail::drift_stride(request));
  Solver solver(request.options, reference.parameters(), to_double(request.step_size));
  RunResult result = follow(solver, request, [&](const detail::ObservedStep& step, const auto& y) {
    monitor.observe(step, Equations::configuration(y), Equations::velocity(y), Equations::multipliers(y),
                    exact(step.t));
  });
  if (result.outcome == Outcome::ok) monitor.report(result);
  append(result.end_state, System::Group::stacked(Equations::configuration(solver.y())));
  append(result.end_state, Equations::velocity(solver.y()));
  append(result.end_state, Equations::multipliers(solver.y()));
  return result;
}

// The start is the solver's making. Its copy for the steps is the solver itself, made ready again.
template <class Solver>
class TimedSolver final : public TimedRun {
 public:
  using Data = typename Solver::Equations::Data;

  TimedSolver(const RunRequest& request, const Data& data)
      : options_(request.options), data_(data), duration_(to_double(request.step_size)) {
    start();
    while (!solver_->finished() && solver_->step().outcome == Outcome::ok) ++steps_;
  }
  bool start() override {
    solver_.emplace(options_, data_, duration_);
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
  Data data_;
  double duration_;
  std::uint64_t steps_ = 0;
  std::optional<Solver> solver_;
};

template <class Solver>
std::unique_ptr<TimedRun> timed(const RunRequest& request, const HeavyTopReference& reference) {
  return std::make_unique<TimedSolver<Solver>>(request, reference.parameters());
}

}  // namespace liebench::outside
