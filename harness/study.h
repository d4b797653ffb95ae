#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/methods.h"
#include "harness/problems.h"
#include "harness/run.h"
#include "harness/strict_json.h"

// A study: what to run. Read strictly, expanded to single runs, and checked as a whole before the first of
// them starts.

namespace liebench {

// One run of a study, complete: nothing in it is a default any more.
struct RunSpec {
  std::string study;
  const ProblemInfo* problem = nullptr;
  const FormulationInfo* formulation = nullptr;
  Json parameters;
  const MethodInfo* method = nullptr;
  RunRequest request;
  Precision precision = Precision::double_precision;
  double requested_step_size = 0.0;  // as the study has it, s
  double t_0 = 0.0;                  // s
  double t_end = 0.0;                // s
  int local_steps = 0;  // steps after the start instead of a fixed interval; 0: the interval counts

  double step_size() const { return to_double(request.step_size); }
  double duration() const;  // from t_0 to the end, s
  // Everything that the numbers of the run depend on, in canonical form: the record's key is its hash.
  Json canonical_input() const;
  std::string key() const;
};

struct Study {
  std::string name;
  std::vector<RunSpec> runs;  // in the order of the file: problems, integrators, precisions, step sizes
};

// The largest number of steps that a run may ask for.
inline constexpr double most_steps = 1e9;

// The most steps that a method may choose: what takes more ends as step_limit.
inline constexpr std::uint64_t most_chosen_steps = 10'000'000;

// Version of the numerical code: part of every key, raised whenever a change alters results.
inline constexpr int numerical_version = 5;

// Throws InputError with the JSON pointer of the first thing that is wrong.
Study read_study(const Json& study);

std::string_view name(Precision precision);
std::string_view name(Start start);

}  // namespace liebench
