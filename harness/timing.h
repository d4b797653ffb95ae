#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "harness/study.h"

namespace liebench {

class Progress;

// How runs are timed.
struct TimingRules {
  double least_time = 0.01;  // of one repetition, s: shorter runs are repeated within it
  int repetitions = 5;       // of one round
  int most_rounds = 4;       // a run that is not steady is timed in another round, so many at most
  double spread =
      0.05;  // a run is steady where the quartiles of its repetitions lie this near, relative to the median
};

// Whether a run can be timed: in double.
bool is_timed(const RunSpec& run);

// Times `runs`, which ended well, by Google Benchmark: one after the other on one processor, those of one formulation and step
// size in one group whose repetitions are in random order, so that a disturbance of the machine meets all methods alike.
// CPU time of the thread. Hands each result to `take(index, times)`, group by group.
void time_runs(const std::vector<RunSpec>& runs, const TimingRules& rules, const ReferenceCache& cache,
               Progress& progress, const std::function<void(std::size_t, const RunTimes&)>& take);

// The interquartile range of the repetitions over their median.
double spread_of(const std::vector<double>& repetitions);

}  // namespace liebench
