#include "harness/timing.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <sched.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>

#include "harness/errors.h"
#include "harness/execute.h"
#include "harness/median.h"
#include "harness/progress.h"

namespace liebench {

namespace {

// The calling thread on one processor, as long as this lives; where the system does not allow it, as it was.
class Pinned {
 public:
  Pinned() {
    const int processor = sched_getcpu();
    if (processor < 0 || sched_getaffinity(0, sizeof(before_), &before_) != 0) return;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(processor, &one);
    pinned_ = sched_setaffinity(0, sizeof(one), &one) == 0;
  }
  ~Pinned() {
    if (pinned_) sched_setaffinity(0, sizeof(before_), &before_);
  }
  Pinned(const Pinned&) = delete;
  Pinned& operator=(const Pinned&) = delete;

 private:
  cpu_set_t before_{};
  bool pinned_ = false;
};

// Keeps the time of every repetition by the name of its benchmark, ns an iteration; prints nothing.
class Collector final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      const std::string& name = run.run_name.function_name;
      if (run.error_occurred) throw std::logic_error(fmt::format("{}: {}", name, run.error_message));
      times[name].push_back(run.GetAdjustedCPUTime() / benchmark::GetTimeUnitMultiplier(run.time_unit) * 1e9);
    }
  }

  std::map<std::string, std::vector<double>> times;
};

// Google Benchmark takes its options from a command line only.
void initialize(const TimingRules& rules) {
  std::array<std::string, 4> words{"liebench", "--benchmark_enable_random_interleaving=true",
                                   fmt::format("--benchmark_repetitions={}", rules.repetitions),
                                   fmt::format("--benchmark_min_time={}", rules.least_time)};
  std::array<char*, 5> arguments{};
  for (std::size_t i = 0; i < words.size(); ++i) arguments[i] = words[i].data();
  int count = int(words.size());
  benchmark::Initialize(&count, arguments.data());
}

struct TimedCase {
  std::size_t index;
  std::unique_ptr<TimedRun> run;
  RunTimes times{};
  std::vector<double> starts{};
};

// One round of all cases that are not steady yet.
void time_round(std::vector<TimedCase>& cases, const TimingRules& rules) {
  benchmark::ClearRegisteredBenchmarks();
  const auto add = [&](const TimedCase& timed, const char* part, bool (TimedRun::*work)()) {
    benchmark::RegisterBenchmark(fmt::format("{} {}", timed.index, part).c_str(),
                                 [run = timed.run.get(), work](benchmark::State& state) {
                                   for (auto _ : state)
                                     if (!(run->*work)())
                                       state.SkipWithError("a run that had ended well failed");
                                 });
  };
  for (const TimedCase& timed : cases) {
    if (timed.times.steady) continue;
    add(timed, "start", &TimedRun::start);
    add(timed, "steps", &TimedRun::follow);
  }
  initialize(rules);
  Collector collector;
  benchmark::RunSpecifiedBenchmarks(&collector);
  benchmark::ClearRegisteredBenchmarks();
  for (TimedCase& timed : cases) {
    if (timed.times.steady) continue;
    for (const double ns : collector.times[fmt::format("{} start", timed.index)]) timed.starts.push_back(ns);
    for (const double ns : collector.times[fmt::format("{} steps", timed.index)])
      timed.times.per_step.push_back(ns / double(timed.times.steps));
    timed.times.start = median(timed.starts);
    timed.times.steady = spread_of(timed.times.per_step) <= rules.spread;
  }
}

}  // namespace

double spread_of(const std::vector<double>& repetitions) {
  if (repetitions.size() < 2) return 0.0;
  std::vector<double> sorted = repetitions;
  std::sort(sorted.begin(), sorted.end());
  const auto quantile = [&](double part) {
    const double place = part * double(sorted.size() - 1);
    const auto below = std::size_t(place);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (place - double(below)) * (sorted[above] - sorted[below]);
  };
  return (quantile(0.75) - quantile(0.25)) / quantile(0.5);
}

bool is_timed(const RunSpec& run) {
  return run.precision == Precision::double_precision;
}

void time_runs(const std::vector<RunSpec>& runs, const TimingRules& rules, const ReferenceCache& cache,
               Progress& progress, const std::function<void(std::size_t, const RunTimes&)>& take) {
  const PreparedProblems problems(runs, cache, progress);
  // By formulation and step size, in the order of their first run.
  std::vector<std::vector<std::size_t>> groups;
  std::map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const RunSpec& run = runs[i];
    if (!is_timed(run)) throw std::logic_error("only runs in double are timed");
    const auto [place, fresh] =
        places.try_emplace(fmt::format("{} {} {} {}", run.problem->name, run.formulation->name,
                                       run.parameters.dump(), run.requested_step_size),
                           groups.size());
    if (fresh) groups.emplace_back();
    groups[place->second].push_back(i);
  }
  const Pinned pinned;
  for (const std::vector<std::size_t>& group : groups) {
    std::vector<TimedCase> cases;
    for (const std::size_t i : group) {
      TimedCase timed{.index = i,
                      .run = problems.of(runs[i]).timed(runs[i].formulation->name, runs[i].request)};
      timed.times.steps = timed.run->steps();
      timed.times.steady = false;
      if (!timed.run->start()) throw std::logic_error("the start of a run that had ended well failed");
      cases.push_back(std::move(timed));
    }
    for (int round = 0; round < rules.most_rounds; ++round) {
      if (std::all_of(cases.begin(), cases.end(), [](const TimedCase& timed) { return timed.times.steady; }))
        break;
      time_round(cases, rules);
    }
    for (const TimedCase& timed : cases) {
      take(timed.index, timed.times);
      progress.advance(1.0);
    }
  }
}

}  // namespace liebench
