#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "harness/references/reference_cache.h"
#include "harness/run.h"
#include "harness/strict_json.h"
#include "problems/system_check.h"

// The problems of the program, seen from the harness.

namespace liebench {

// A problem with its parameters and its reference solution, ready to run. The one virtual seam: above it JSON
// and files, below it templates.
class PreparedProblem {
 public:
  virtual ~PreparedProblem() = default;
  // Runs the request and counts what it costs; safe to call from several threads.
  virtual RunResult run(std::string_view formulation, Precision precision,
                        const RunRequest& request) const = 0;
  // The run in double made ready to be timed.
  virtual std::unique_ptr<TimedRun> timed(std::string_view formulation, const RunRequest& request) const = 0;
  virtual std::string reference_method() const = 0;
  virtual double reference_error() const = 0;
};

struct FormulationInfo {
  std::string_view name;
  int constraints;
  std::string_view summary;
};

struct ParameterInfo {
  std::string_view name;
  std::string_view unit;
  std::string shape;  // "positive number", "3 numbers", ...
  Json fallback;
  std::string_view meaning;
};

struct ProblemInfo {
  std::string_view name;
  std::string_view summary;
  std::vector<FormulationInfo> formulations;
  std::vector<ParameterInfo> parameters;
  // The parameters of a study, checked and completed by defaults, in the order of the list above. Throws
  // InputError.
  std::function<Json(const JsonView&)> complete;
  // Why no reference solution over [0, duration] can be had for these parameters in reasonable time: a sentence with
  // what is allowed; empty where there is no obstacle.
  std::function<std::string(const Json& parameters, double duration)> obstacle;
  // Makes the reference solution over [0, duration] (or takes it from the cache). Throws std::runtime_error
  // where none can be made.
  std::function<std::shared_ptr<const PreparedProblem>(const Json& parameters, double duration,
                                                       const ReferenceCache&, const MessageCallback&)>
      prepare;
  // Whether the functions of the problem agree with each other in a formulation (problems/check_system.h). Throws InputError where it
  // is too large for that.
  std::function<SystemCheck(std::string_view formulation, const Json& parameters)> check;
  // Of a problem whose equations of motion may change without a new numerical version: a text that changes with them, part of the
  // keys of records. Empty for others.
  std::function<std::string(const Json& parameters)> fingerprint{};
};

// Every problem: the heavy top, and the systems of problems/list.h.
const std::vector<ProblemInfo>& problems();

// The heavy top of Bruels & Cardona on SO(3) and on R^3 x SO(3).
ProblemInfo heavy_top_info();

}  // namespace liebench
