#include <benchmark/benchmark.h>

#include "benchmarks/fast_top.h"
#include "integrators/list.h"

// One step of each method on the fast heavy top. Registered as method/formulation/k/step size.

namespace {

using namespace liebench;

template <int k, class S>
void bliedf2nd_step(benchmark::State& state) {
  const double h = std::pow(10.0, -double(state.range(0)));
  const S system{HeavyTopParameters{}};
  using Stepper = BLieDF2nd::Stepper<k, S>;
  const auto points = fast_top_points(system, h, Stepper::starting_points);
  Stepper stepper(system, {.k = k});
  stepper.start(h, points);
  const BLieDF2nd::Stepper<k, S> at_start = stepper;
  for (auto _ : state) {
    // The motion of the first 2 s again and again: outside of it accuracy may be lost, and the step with it.
    if (stepper.time() > 2.0) stepper = at_start;
    if (stepper.step().outcome != Outcome::ok) {
      state.SkipWithError("the step failed");
      break;
    }
    benchmark::DoNotOptimize(stepper.velocity());
  }
}

void step_sizes(benchmark::internal::Benchmark* b) {
  b->ArgName("-log10(h)")->Arg(3)->Arg(4)->Arg(6);
}

BENCHMARK(bliedf2nd_step<2, HeavyTopSO3<double>>)->Apply(step_sizes)->Name("bliedf2nd/SO3/k=2");
BENCHMARK(bliedf2nd_step<3, HeavyTopSO3<double>>)->Apply(step_sizes)->Name("bliedf2nd/SO3/k=3");
BENCHMARK(bliedf2nd_step<4, HeavyTopSO3<double>>)->Apply(step_sizes)->Name("bliedf2nd/SO3/k=4");
BENCHMARK(bliedf2nd_step<2, HeavyTopR3xSO3<double>>)->Apply(step_sizes)->Name("bliedf2nd/R3xSO3/k=2");
BENCHMARK(bliedf2nd_step<3, HeavyTopR3xSO3<double>>)->Apply(step_sizes)->Name("bliedf2nd/R3xSO3/k=3");
BENCHMARK(bliedf2nd_step<4, HeavyTopR3xSO3<double>>)->Apply(step_sizes)->Name("bliedf2nd/R3xSO3/k=4");

}  // namespace
