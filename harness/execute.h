#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "harness/study.h"

namespace liebench {

class Progress;

// The problems of runs with their reference solutions, one for all runs that share it.
class PreparedProblems {
 public:
  // Throws MachineError where a reference can't be made.
  PreparedProblems(const std::vector<RunSpec>& runs, const ReferenceCache& cache, Progress& progress);
  const PreparedProblem& of(const RunSpec& run) const;

 private:
  std::map<std::string, std::shared_ptr<const PreparedProblem>> problems_;
};

// How long a run takes, in arbitrary units: for progress and for the order of work, longest first.
double expected_work(const RunSpec& run);

// Runs all of `runs` on `jobs` threads and hands each record to `take(index, record)`, one call at a time, in
// the order in which the runs end. A reference solution is made once for all runs that share it. The records
// do not depend on `jobs`.
void execute(const std::vector<RunSpec>& runs, int jobs, const ReferenceCache& cache, Progress& progress,
             const std::function<void(std::size_t, const Json&)>& take);

// The number of threads that --jobs stands for by default: the machine's cores.
int default_jobs();

}  // namespace liebench
