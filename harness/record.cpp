#include "harness/record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/errors.h"
#include "harness/median.h"
#include "harness/provenance.h"
#include "harness/timing.h"

namespace liebench {

namespace {

// A number that is not finite would be written as null: no record may hold one.
double finite(double x, std::string_view what) {
  if (!std::isfinite(x)) throw std::logic_error(fmt::format("a record would hold {} = {}", what, x));
  return x;
}

Json norms(const ErrorNorms& e) {
  Json j;
  j["end_relative"] = finite(e.end_relative, "end_relative");
  j["end_absolute"] = finite(e.end_absolute, "end_absolute");
  j["max_absolute"] = finite(e.max_absolute, "max_absolute");
  return j;
}

Json drift(const Drift& d) {
  Json j;
  j["energy"] = finite(d.energy, "energy");
  j["angular_momentum"] = finite(d.angular_momentum, "angular_momentum");
  if (d.position_constraint) j["position_constraint"] = finite(*d.position_constraint, "position_constraint");
  if (d.velocity_constraint) j["velocity_constraint"] = finite(*d.velocity_constraint, "velocity_constraint");
  j["group"] = finite(d.group, "group");
  return j;
}

Json cost_to_json(const RunCost& c) {
  Json j;
  j["residuals"] = c.system.forces;
  j["jacobians"] = c.system.stiffnesses;
  j["factorizations"] = c.kernel.factorizations;
  Json& causes = j["factorizations_by_cause"];
  causes["start"] = c.kernel.factorizations_start;
  causes["first"] = c.kernel.factorizations_first;
  causes["refresh"] = c.kernel.factorizations_refresh;
  causes["slow_convergence"] = c.kernel.factorizations_slow;
  j["solves"] = c.kernel.solves;
  j["newton_iterations"] = c.kernel.iterations;
  j["exp"] = c.group.exp;
  j["log"] = c.group.log;
  j["tangent"] = c.group.tangent;
  j["tangent_inverse"] = c.group.tangent_inverse;
  j["commutators"] = c.group.commutators;
  if (c.operations) {
    j["flops"] = c.operations->total();
    Json& kinds = j["flops_by_kind"];
    kinds["add"] = c.operations->add;
    kinds["multiply"] = c.operations->multiply;
    kinds["divide"] = c.operations->divide;
    kinds["square_root"] = c.operations->square_root;
    kinds["transcendental"] = c.operations->transcendental;
  }
  return j;
}

Json cost_to_json(const OutsideCounts& c) {
  Json j;
  j["residuals"] = c.residuals;
  const auto add = [&](const char* key, const std::optional<std::uint64_t>& count) {
    if (count) j[key] = *count;
  };
  add("jacobians", c.jacobians);
  add("factorizations", c.factorizations);
  add("solves", c.solves);
  add("newton_iterations", c.newton_iterations);
  j["rejected_steps"] = c.rejected_steps;
  return j;
}

Json time_to_json(const RunTimes& times) {
  const double middle = median(times.per_step);
  const auto [least, most] = std::minmax_element(times.per_step.begin(), times.per_step.end());
  // Nobody can use more digits of a time.
  const auto tenths = [](double ns) { return std::round(ns * 10.0) / 10.0; };
  Json j;
  Json& per_step = j["ns_per_step"];
  per_step["median"] = tenths(middle);
  per_step["min"] = tenths(*least);
  per_step["max"] = tenths(*most);
  per_step["repetitions"] = times.per_step.size();
  for (const double ns : times.per_step) per_step["samples"].push_back(tenths(ns));
  j["start_ns"] = std::round(times.start);
  j["total_ns"] = std::round(times.start + middle * double(times.steps));
  j["spread"] = std::round(spread_of(times.per_step) * 1e4) / 1e4;
  if (!times.steady) j["unsteady"] = true;
  return j;
}

}  // namespace

Json with_time(Json record, const RunTimes& times) {
  record.erase("provenance");
  record["time"] = time_to_json(times);
  record["provenance"] = provenance();
  return record;
}

Json make_record(const RunSpec& run, const RunResult& result, const PreparedProblem& problem,
                 const Json& provenance) {
  Json j;
  j["schema"] = record_schema;
  j["key"] = run.key();
  j["study"] = run.study;
  j["problem"] = run.problem->name;
  j["formulation"] = run.formulation->name;
  j["parameters"] = run.parameters;
  j["integrator"] = run.method->name;
  j["options"] = options_to_json(*run.method, run.request.options);
  j["start"] = name(run.request.start);
  j["precision"] = name(run.precision);
  if (run.method->chooses_steps) {
    const std::uint64_t steps = std::max<std::uint64_t>(1, result.steps);
    j["step_size"] = run.duration() / double(steps);
    j["steps"] = steps;
  } else {
    j["step_size"] = run.step_size();
    j["requested_step_size"] = run.requested_step_size;
    j["steps"] = run.request.steps;
  }
  j["t_0"] = run.t_0;
  j["t_end"] = run.t_end;
  if (run.local_steps > 0) j["local_steps"] = run.local_steps;
  j["outcome"] = name(result.outcome);
  if (result.failure) {
    Json& failure = j["failure"];
    failure["time"] = run.t_0 + result.failure->time;
    failure["step"] = result.failure->step;
    // Absent where it overflowed, and where the failure has none.
    if (std::isfinite(result.failure->residual)) failure["residual"] = result.failure->residual;
    failure["message"] = result.failure->message;
  }
  j["reference"]["method"] = problem.reference_method();
  j["reference"]["error_estimate"] = finite(problem.reference_error(), "reference.error_estimate");
  if (result.q) {
    Json& errors = j["errors"];
    errors["q"] = norms(*result.q);
    errors["v"] = norms(*result.v);
    if (result.lambda) errors["lambda"] = norms(*result.lambda);
  }
  if (result.agreement_time) j["agreement_time"] = run.t_0 + *result.agreement_time;
  if (result.drift) j["drift"] = drift(*result.drift);
  if (result.solver) j["solver"] = name(*result.solver);
  if (result.outside) {
    j["cost"] = cost_to_json(*result.outside);
  } else {
    j["cost"] = cost_to_json(result.cost);
    if (run.method->chooses_steps) j["cost"]["rejected_steps"] = result.cost.kernel.rejections;
  }
  j["provenance"] = provenance;
  return j;
}

}  // namespace liebench
