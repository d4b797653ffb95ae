#pragma once

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "harness/instances/run_time_steppers.h"
#include "harness/listed_parameters.h"
#include "harness/listed_system.h"
#include "harness/run_method.h"
#include "problems/audited_system.h"
#include "problems/list.h"

// A ListedSystem of any class that says of itself what problems/list.h asks for.

namespace liebench {

namespace detail {

template <template <class> class System>
class ListedRuns final : public ListedInstance {
  using S = System<double>;
  using Exact = System<Extended>;
  using Parameters = typename S::Parameters;
  using Vector = RunTimeSystem<Extended>::Vector;

 public:
  explicit ListedRuns(const Parameters& parameters) : parameters_(parameters) {}

  // In double: run as it is timed, and once more with a scalar that counts.
  RunResult run(Precision precision, const RunRequest& request,
                const IntegratedReference& reference) const override {
    const auto exact = solution(reference);
    if (precision == Precision::extended) return accuracy_run(request, Audited{Exact(parameters_)}, exact);
    RunResult result = accuracy_run(request, S(parameters_), exact);
    const RunResult audit = audit_run(request, Audited{System<Counted>(parameters_)}, exact);
    require_same_path(result, audit, S::name, request);
    result.cost = audit.cost;
    return result;
  }
  std::unique_ptr<TimedRun> timed(const RunRequest& request,
                                  const IntegratedReference& reference) const override {
    return timed_run(request, S(parameters_), solution(reference));
  }

  RunTimeSystem<Extended> extended() const override {
    return RunTimeSystem<Extended>(std::make_shared<ErasedSystem<Exact>>(Exact(parameters_)));
  }
  double separation(const Vector& q, const Vector& p) const override {
    using Group = typename Exact::Group;
    return Group::separation(Group::unstacked(q), Group::unstacked(p)).template lpNorm<Eigen::Infinity>();
  }

 private:
  auto solution(const IntegratedReference& reference) const {
    return [&reference](const Extended& t) {
      const IntegratedReference::Point p = reference.at(t);
      return SolutionPoint<Exact>{p.t, Exact::Group::unstacked(p.q), p.v, p.acceleration, p.lambda};
    };
  }

  Parameters parameters_;
};

template <template <class> class System>
ListedSystem listed_system() {
  using S = System<double>;
  using Parameters = typename S::Parameters;
  std::vector<ListedParameter> parameters;
  Parameters defaults;
  for (const auto& entry : S::parameter_list) {
    const std::span<double> numbers = entry.numbers(defaults);
    parameters.push_back({entry.text, entry.single, {numbers.begin(), numbers.end()}});
  }
  return {.name = S::name,
          .summary = S::summary,
          .formulation = S::formulation,
          .formulation_summary =
              fmt::format("{} velocities, {} constraints", S::Group::dimension, S::constraints),
          .constraints = S::constraints,
          .parameters = std::move(parameters),
          .refusal = [](const ParameterNumbers& numbers) -> std::optional<ParameterRefusal> {
            if constexpr (requires(const Parameters& p) { S::refusal(p); })
              return S::refusal(parameters_of<System>(numbers));
            else
              return std::nullopt;
          },
          .make = [](const ParameterNumbers& numbers) -> std::unique_ptr<ListedInstance> {
            return std::make_unique<ListedRuns<System>>(parameters_of<System>(numbers));
          }};
}

template <template <class> class... Systems>
std::vector<ListedSystem> listed_systems_of(SystemList<Systems...>) {
  return {listed_system<Systems>()...};
}

}  // namespace detail

}  // namespace liebench
