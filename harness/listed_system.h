#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "groups/extended.h"
#include "harness/references/integrated_reference.h"
#include "harness/run.h"
#include "integrators/run_time_system.h"
#include "problems/parameter.h"
#include "problems/system_check.h"

// The systems of problems/list.h as the harness sees them: neither knows JSON here, nor a group or a scalar type there.

namespace liebench {

// The numbers of all parameters, in the order of the system's list.
using ParameterNumbers = std::vector<std::vector<double>>;

struct ListedParameter {
  ParameterText text;
  bool single;  // a number, not a list of numbers
  std::vector<double> fallback;
};

// A listed system with its parameters.
class ListedInstance {
 public:
  virtual ~ListedInstance() = default;
  // The run, counted.
  virtual RunResult run(Precision precision, const RunRequest& request,
                        const IntegratedReference& reference) const = 0;
  virtual std::unique_ptr<TimedRun> timed(const RunRequest& request,
                                          const IntegratedReference& reference) const = 0;
  // What its reference is made of.
  virtual RunTimeSystem<Extended> extended() const = 0;
  virtual double separation(const RunTimeSystem<Extended>::Vector& q,
                            const RunTimeSystem<Extended>::Vector& p) const = 0;
};

struct ListedSystem {
  std::string_view name, summary, formulation;
  std::string formulation_summary;
  int constraints;
  std::vector<ListedParameter> parameters;
  std::optional<ParameterRefusal> (*refusal)(const ParameterNumbers&);
  std::unique_ptr<ListedInstance> (*make)(const ParameterNumbers&);
};

// Those of problems/list.h, compiled in harness/instances/listed_systems.cpp.
const std::vector<ListedSystem>& listed_systems();

// check_system() of one of them, compiled in harness/instances/listed_checks.cpp.
SystemCheck check_listed_system(std::string_view name, const ParameterNumbers& numbers);

}  // namespace liebench
