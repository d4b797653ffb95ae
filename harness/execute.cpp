#include "harness/execute.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <numeric>
#include <thread>

#include "harness/errors.h"
#include "harness/progress.h"
#include "harness/provenance.h"
#include "harness/record.h"

namespace liebench {

namespace {

// The interval of the reference that serves a run: the next of 0.1, 0.2, 0.5, 1, 2, 5, 10, ... s. It depends on the run
// alone, so that a record does not depend on what else is run, and few intervals serve all runs.
double reference_duration(const RunSpec& run) {
  const double least = run.duration() * (1.0 - 1e-12);
  for (int exponent = -1;; ++exponent)
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double duration = digit * std::pow(10.0, exponent);
      if (duration >= least) return duration;
    }
}

// Runs that differ in nothing but method and grid share one reference.
std::string reference_key(const RunSpec& run) {
  return fmt::format("{}{}{}", run.problem->name, run.parameters.dump(), reference_duration(run));
}

}  // namespace

PreparedProblems::PreparedProblems(const std::vector<RunSpec>& runs, const ReferenceCache& cache,
                                   Progress& progress) {
  const auto message = [&](std::string_view text) { progress.message(std::string(text)); };
  for (const RunSpec& run : runs) {
    const auto [place, fresh] = problems_.try_emplace(reference_key(run));
    if (!fresh) continue;
    try {
      place->second = run.problem->prepare(run.parameters, reference_duration(run), cache, message);
    } catch (const std::exception& error) {
      throw MachineError("no reference solution: " + std::string(error.what()));
    }
  }
}

const PreparedProblem& PreparedProblems::of(const RunSpec& run) const {
  return *problems_.at(reference_key(run));
}

double expected_work(const RunSpec& run) {
  const double step = run.precision == Precision::extended ? 12.0 : 2.0;
  // How many steps a method will choose nobody knows before.
  const double steps = run.method->chooses_steps ? 1e4 : double(run.request.steps);
  return steps * step * (run.formulation->constraints > 0 ? 2.0 : 1.0) + 1.0;
}

int default_jobs() {
  return std::max(1, int(std::thread::hardware_concurrency()));
}

void execute(const std::vector<RunSpec>& runs, int jobs, const ReferenceCache& cache, Progress& progress,
             const std::function<void(std::size_t, const Json&)>& take) {
  const PreparedProblems problems(runs, cache, progress);
  const Json origin = provenance();
  std::vector<std::size_t> order(runs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return expected_work(runs[a]) > expected_work(runs[b]);
  });

  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    try {
      for (std::size_t i = next++; i < order.size(); i = next++) {
        const RunSpec& run = runs[order[i]];
        const PreparedProblem& problem = problems.of(run);
        const RunResult result = problem.run(run.formulation->name, run.precision, run.request);
        const Json record = make_record(run, result, problem, origin);
        const std::lock_guard lock(mutex);
        take(order[i], record);
        progress.advance(expected_work(run));
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      next = order.size();
    }
  };
  std::vector<std::jthread> threads;
  for (int i = 1; i < jobs; ++i) threads.emplace_back(work);
  work();
  threads.clear();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace liebench
