#pragma once

#include <cmath>
#include <string>

#include "harness/record.h"
#include "harness/record_reader.h"
#include "harness/study.h"

// Records made by make_record without a run: their numbers are the test's.

namespace liebench {

// A problem that says who made its reference and runs nothing.
class NoProblem final : public PreparedProblem {
 public:
  explicit NoProblem(double reference_error = 1e-30) : reference_error_(reference_error) {}
  RunResult run(std::string_view, Precision, const RunRequest&) const override { return {}; }
  std::unique_ptr<TimedRun> timed(std::string_view, const RunRequest&) const override { return nullptr; }
  std::string reference_method() const override { return "none"; }
  double reference_error() const override { return reference_error_; }

 private:
  double reference_error_;
};

struct SampleRun {
  std::string study = "sample";
  std::string formulation = "R3xSO3";
  int k = 2;
  bool correction = true;
  bool modified_start = false;
  std::string precision = "extended";
  double step_size = 1e-3;
  double t_end = 2.0;
  bool local = false;  // one step after the starting values instead of [0, t_end]
};

inline RunSpec sample_spec(const SampleRun& sample) {
  Json study;
  study["name"] = sample.study;
  study["problems"] = Json::array({{{"name", "heavy_top"}, {"formulation", sample.formulation}}});
  study["integrators"] =
      Json::array({{{"name", "bliedf2nd"}, {"k", sample.k}, {"correction", sample.correction}}});
  if (sample.formulation == "R3xSO3") study["integrators"][0]["modified_start"] = sample.modified_start;
  study["start"] = "reference";
  study["step_sizes"] = Json::array({sample.step_size});
  if (sample.local)
    study["steps"] = 1;
  else
    study["t_end"] = sample.t_end;
  study["precision"] = sample.precision;
  return read_study(study).runs.at(0);
}

inline Json sample_provenance() {
  return Json::parse(R"({"commit": "c", "dirty": false, "compiler": "x", "flags": "f", "cpu": "p",
                         "libraries": {"eigen": "3.4.0"}, "date": "2024-01-31T12:00:00Z"})");
}

// A run that ended well with these errors, the same in all norms.
inline RunResult sample_result(double q, double v, double lambda, bool constrained = true) {
  RunResult result;
  result.q = ErrorNorms{q, q, q};
  result.v = ErrorNorms{v, v, v};
  result.drift = Drift{.energy = 1e-9, .position_constraint = {}, .velocity_constraint = {}, .group = 1e-15};
  if (constrained) {
    result.lambda = ErrorNorms{lambda, lambda, lambda};
    result.drift->position_constraint = 1e-12;
    result.drift->velocity_constraint = 1e-3;
  }
  return result;
}

inline RunResult sample_failure() {
  RunResult result;
  result.outcome = Outcome::newton_diverged;
  result.failure = RunFailure{.time = 0.25, .step = 250, .residual = 3.5, .message = "it does not converge"};
  return result;
}

inline Json sample_record(const SampleRun& sample, const RunResult& result) {
  return make_record(sample_spec(sample), result, NoProblem(), sample_provenance());
}

inline RecordRow row_of(const Json& record) {
  return record_rows({record}).front();
}

// A run whose error in q, v and lambda is that step size to the power `order`.
inline Json power_law_record(const SampleRun& sample, double order) {
  const double error = std::pow(sample.step_size, order);
  return sample_record(sample, sample_result(error, error, error, sample.formulation == "R3xSO3"));
}

}  // namespace liebench
