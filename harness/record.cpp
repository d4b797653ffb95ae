#include "harness/record.h"

#include <fmt/format.h>

#include <cmath>

#include "harness/errors.h"

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

}  // namespace

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
  j["step_size"] = run.step_size();
  j["requested_step_size"] = run.requested_step_size;
  j["steps"] = run.request.steps;
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
  if (result.drift) j["drift"] = drift(*result.drift);
  Json& cost = j["cost"];
  cost["residuals"] = result.audit.residuals;
  cost["jacobians"] = result.audit.jacobians;
  cost["factorizations"] = result.audit.factorizations;
  cost["solves"] = result.audit.solves;
  cost["newton_iterations"] = result.audit.iterations;
  j["provenance"] = provenance;
  return j;
}

}  // namespace liebench
