#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "benchmarks/step.h"
#include "harness/median.h"

// Google Benchmark's program with a table at its end: general stepper and floor of the same name side by side.

namespace {

using liebench::median;

class PairReporter : public benchmark::ConsoleReporter {
 public:
  using ConsoleReporter::ConsoleReporter;

  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
      const std::string& name = run.run_name.function_name;
      for (const char* side : {"/general", "/floor"})
        if (name.ends_with(side))
          times_[name.substr(0, name.size() - std::strlen(side))][side].push_back(
              run.GetAdjustedCPUTime() / benchmark::GetTimeUnitMultiplier(run.time_unit) * 1e9);
    }
  }

  void Finalize() override {
    ConsoleReporter::Finalize();
    if (times_.empty()) return;
    std::printf("\nMedians of %zu repetitions, ns a step\n\n", repetitions());
    std::printf("%-56s %8s %8s %6s   %s\n", "method", "general", "floor", "ratio", "of the shortest");
    for (const auto& [name, sides] : times_) {
      std::printf("%-56s", name.c_str());
      for (const char* side : {"/general", "/floor"}) {
        if (sides.contains(side)) {
          std::printf(" %8.1f", median(sides.at(side)));
        } else {
          std::printf(" %8s", "-");
        }
      }
      if (sides.size() == 2) {
        const auto &general = sides.at("/general"), &floor = sides.at("/floor");
        const double of_shortest =
            *std::min_element(general.begin(), general.end()) / *std::min_element(floor.begin(), floor.end());
        std::printf(" %6.2f   %.2f\n", median(general) / median(floor), of_shortest);
      } else {
        std::printf(" %6s\n", "-");
      }
    }
  }

 private:
  std::size_t repetitions() const { return times_.begin()->second.begin()->second.size(); }

  std::map<std::string, std::map<std::string, std::vector<double>>> times_;
};

}  // namespace

// --floors stands for the options of the comparison: the pairs alone, their repetitions in random order, so that a
// disturbance of the machine meets both sides.
int main(int argc, char** argv) {
  std::vector<char*> arguments{argv, argv + argc};
  std::string filter = "--benchmark_filter=/(general|floor)$", repetitions = "--benchmark_repetitions=21",
              interleaving = "--benchmark_enable_random_interleaving=true",
              time = "--benchmark_min_time=0.05";
  const auto floors = std::find_if(arguments.begin() + 1, arguments.end(),
                                   [](const char* a) { return std::strcmp(a, "--floors") == 0; });
  if (floors != arguments.end()) {
    arguments.erase(floors);
    // Before those of the user, which so have the last word.
    arguments.insert(arguments.begin() + 1,
                     {filter.data(), repetitions.data(), interleaving.data(), time.data()});
  }
  int count = int(arguments.size());
  arguments.push_back(nullptr);
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 1;
  liebench::benchmarks::add_bliedf2nd();
  liebench::benchmarks::add_generalized_alpha();
  liebench::benchmarks::add_faltinsen_bdf();
  liebench::benchmarks::add_explicit_methods();
  liebench::benchmarks::add_half_explicit();
  liebench::benchmarks::add_momentum_methods();
  liebench::benchmarks::add_gauss();
  liebench::benchmarks::add_radau();
  liebench::benchmarks::add_symmetric_methods();
  liebench::benchmarks::add_centred_bdf();
  liebench::benchmarks::add_step_size_control();
  liebench::benchmarks::add_scenes();
  PairReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  benchmark::Shutdown();
}
