#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "harness/monitor.h"
#include "harness/run.h"
#include "integrators/settled_stepper.h"
#include "integrators/starting_values.h"

// The inside of the seam: everything from here down is a template on system and scalar.

namespace liebench {

namespace detail {

// A solution point in the scalar of the run: by way of double, unless that is Extended.
template <MechanicalSystem S>
SolutionPoint<S> rounded(const SolutionPoint<typename S::template rebind<Extended>>& p) {
  using T = typename S::Scalar;
  using Exact = typename S::template rebind<Extended>::Group;
  using Rounded = typename S::template rebind<double>::Group;
  if constexpr (std::is_same_v<T, Extended>) {
    return p;
  } else if constexpr (SizedLieGroup<typename S::Group>) {
    const auto in_scalar = [](const auto& v) { return v.template cast<double>().template cast<T>().eval(); };
    return {T(to_double(p.t)), in_scalar(p.q), in_scalar(p.v), in_scalar(p.acceleration),
            in_scalar(p.lambda)};
  } else {
    const auto in_scalar = [](const auto& v) { return v.template cast<double>().template cast<T>().eval(); };
    return {.t = T(to_double(p.t)),
            .q = Rounded::template cast<T>(Exact::template cast<double>(p.q)),
            .v = in_scalar(p.v),
            .acceleration = in_scalar(p.acceleration),
            .lambda = in_scalar(p.lambda)};
  }
}

template <class T>
Extended extended_time(const T& t) {
  if constexpr (std::is_same_v<T, Extended>)
    return t;
  else
    return Extended(to_double(t));
}

template <class T>
T step_size_of(const RunRequest& request) {
  if constexpr (std::is_same_v<T, Extended>)
    return request.step_size;
  else
    return T(to_double(request.step_size));
}

// A stepper with the points that it starts from.
template <MechanicalSystem S>
struct Beginning {
  std::array<SolutionPoint<S>, std::size_t(most_starting_points)> room;

  std::span<SolutionPoint<S>> points(const AnyStepper<S>& stepper) {
    return std::span(room).first(std::size_t(stepper.starting_points()));
  }

  // What "start": "reference" takes from the reference solution. `exact(t)` is the solution point at t.
  template <class Solution>
  void take_reference(const AnyStepper<S>& stepper, const RunRequest& request, const Solution& exact) {
    std::size_t j = 0;
    for (auto& point : points(stepper)) point = rounded<S>(exact(request.step_size * Extended(double(j++))));
  }

  // Of a reference start take_reference() goes before.
  StepResult start(AnyStepper<S>& stepper, const RunRequest& request) {
    const auto h = step_size_of<typename S::Scalar>(request);
    return request.start == Start::self ? stepper.start_itself(h, points(stepper))
                                        : stepper.start(h, points(stepper));
  }
};

// Counts what happens on this thread during its life.
class Counting {
 public:
  template <MechanicalSystem S>
  RunCost cost(const AnyStepper<S>& stepper) const {
    RunCost cost;
    cost.kernel = stepper.audit();
    cost.system = SystemCalls::counts() - system_;
    cost.group = GroupCalls::counts() - group_;
    if constexpr (std::is_same_v<typename S::Scalar, Counted>)
      cost.operations = Counted::operations() - operations_;
    return cost;
  }

 private:
  SystemCalls system_ = SystemCalls::counts();
  GroupCalls group_ = GroupCalls::counts();
  Operations operations_ = Counted::operations();
};

template <MechanicalSystem S>
std::vector<double> state_of(const AnyStepper<S>& stepper) {
  using Group = typename S::Group;
  std::vector<double> state;
  const auto append = [&](const auto& vector) {
    for (Eigen::Index i = 0; i < vector.size(); ++i) state.push_back(to_double(vector(i)));
  };
  append(Group::stacked(stepper.configuration()).eval());
  append(stepper.velocity());
  append(stepper.multipliers());
  return state;
}

// One run. `observe(step, q, v, lambda)` sees every state, those of the method's own start included; of the last starting point
// as the method goes on from it.
template <MechanicalSystem S, class Solution, class Observer>
void follow(AnyStepper<S>& stepper, const RunRequest& request, const Solution& exact, const Observer& observe,
            RunResult& result) {
  const Counting counting;
  Beginning<S> beginning;
  const bool own_steps = request.chooses_steps;
  const auto first = std::uint64_t(stepper.steps());
  const auto time_of = [&](std::uint64_t n) {
    return own_steps ? extended_time(stepper.time()) : request.step_size * Extended(double(n));
  };
  const auto fail = [&](const StepResult& step, std::uint64_t n) {
    result.outcome = step.outcome;
    result.failure = RunFailure{.time = to_double(time_of(n)),
                                .step = n,
                                .residual = step.residual,
                                .message = std::string(explanation(step.outcome))};
  };
  const auto observe_state = [&](std::uint64_t n) {
    const bool last = own_steps ? stepper.finished() : n == request.steps;
    observe(ObservedStep{n, time_of(n), last}, stepper.configuration(), stepper.velocity(),
            stepper.multipliers());
    result.steps = n;
  };
  if (request.start == Start::reference) beginning.take_reference(stepper, request, exact);
  const StepResult start = beginning.start(stepper, request);
  if (start.outcome != Outcome::ok) {
    fail(start, first - 1);
  } else {
    if (request.start == Start::self) {
      for (std::uint64_t n = 1; n + 1 < first; ++n)
        observe(ObservedStep{n, time_of(n), n == request.steps}, beginning.room[n].q, beginning.room[n].v,
                beginning.room[n].lambda);
      if (first > 1) observe_state(first - 1);
    }
    for (std::uint64_t n = first; result.outcome == Outcome::ok && !stepper.finished(); ++n) {
      if (n > request.steps) {
        if (own_steps) fail({Outcome::step_limit}, n);
        break;
      }
      if (const StepResult step = stepper.step(); step.outcome != Outcome::ok)
        fail(step, n);
      else
        observe_state(n);
    }
  }
  result.cost = counting.cost(stepper);
  result.end_state = state_of(stepper);
}

template <MechanicalSystem S>
class TimedStepper final : public TimedRun {
 public:
  template <class Solution>
  TimedStepper(std::unique_ptr<AnyStepper<S>> stepper, const RunRequest& request, const Solution& exact)
      : request_(request), fresh_(std::move(stepper)), started_(fresh_->clone()), running_(fresh_->clone()) {
    if (request.start == Start::reference) beginning_.take_reference(*fresh_, request, exact);
    steps_ = request.steps + 1 - std::uint64_t(fresh_->steps());
    if (!request.chooses_steps || !start()) return;
    running_->assign(*started_);
    for (steps_ = 0; !running_->finished() && running_->step().outcome == Outcome::ok;) ++steps_;
  }
  bool start() override {
    started_->assign(*fresh_);
    return beginning_.start(*started_, request_).outcome == Outcome::ok;
  }
  bool follow() override {
    running_->assign(*started_);
    return running_->advance(steps()).outcome == Outcome::ok;
  }
  std::uint64_t steps() const override { return steps_; }

 private:
  RunRequest request_;
  std::uint64_t steps_;
  Beginning<S> beginning_;
  std::unique_ptr<AnyStepper<S>> fresh_, started_, running_;
};

// The options of the method that the request names, of the list of all.
MethodOptions options_of(const RunRequest& request);

}  // namespace detail

// Runs the request and compares it with the exact solution. In double nothing is counted (the run is the code that is
// timed); in extended precision the audit is part of it.
template <MechanicalSystem S, class Solution>
RunResult accuracy_run(const RunRequest& request, const S& system, const Solution& exact) {
  RunResult result;
  detail::Monitor<S> monitor(system, detail::drift_stride(request));
  const auto observe = [&](const detail::ObservedStep& step, const auto& q, const auto& v,
                           const auto& lambda) { monitor.observe(step, q, v, lambda, exact(step.t)); };
  const auto stepper = any_stepper(detail::options_of(request), system);
  detail::follow(*stepper, request, exact, observe, result);
  if (result.outcome == Outcome::ok) monitor.report(result);
  return result;
}

// The same run, counted.
template <MechanicalSystem S, class Solution>
RunResult audit_run(const RunRequest& request, const S& system, const Solution& exact) {
  RunResult result;
  const auto stepper = any_stepper(detail::options_of(request), system);
  detail::follow(
      *stepper, request, exact, [](const auto&...) {}, result);
  return result;
}

template <MechanicalSystem S, class Solution>
std::unique_ptr<TimedRun> timed_run(const RunRequest& request, const S& system, const Solution& exact) {
  return std::make_unique<detail::TimedStepper<S>>(any_stepper(detail::options_of(request), system), request,
                                                   exact);
}

}  // namespace liebench
