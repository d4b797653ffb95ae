#include "benchmarks/step.h"
#include "harness/instances/scene_steppers.h"
#include "integrators/bliedf2nd.h"
#include "problems/scene_examples.h"

// Steps of scenes: chains of N bodies, and the heavy top beside the one written by hand (the "floor" of this pair).

namespace liebench::benchmarks {

namespace {

template <class S>
std::unique_ptr<AnyStepper<S>> started_itself(const MethodOptions& options, const S& system, double h) {
  std::unique_ptr<AnyStepper<S>> stepper = any_stepper(options, system);
  std::vector<SolutionPoint<S>> points(std::size_t(stepper->starting_points()));
  if (stepper->start_itself(h, points).outcome != Outcome::ok) std::exit(1);
  return stepper;
}

// The first 0.2 s of a chain let go from the horizontal, again and again.
template <class System>
void chain_step(benchmark::State& state) {
  const System system(make_scene_model<double>(chain(int(state.range(0)))));
  const auto at_start = started_itself(BLieDF2nd::Options{.k = 3}, system, 1e-3);
  const auto stepper = at_start->clone();
  for (auto _ : state) {
    if (stepper->time() > 0.2) stepper->assign(*at_start);
    if (stepper->step().outcome != Outcome::ok) {
      state.SkipWithError("the step failed");
      break;
    }
  }
  state.SetComplexityN(state.range(0));
  state.counters["per_body"] = benchmark::Counter(
      double(state.range(0)), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
// Without the heap.
BENCHMARK_TEMPLATE(chain_step, SmallScene)->DenseRange(1, small_scene)->Name("scene/small_chain/k=3/bodies");
BENCHMARK_TEMPLATE(chain_step, Scene)
    ->RangeMultiplier(10)
    ->Range(10, 10000)
    ->Complexity(benchmark::oN)
    ->Unit(benchmark::kMicrosecond)
    ->Name("scene/chain/k=3/bodies");

void heavy_top_pair(const std::string& name, const MethodOptions& options) {
  benchmark::RegisterBenchmark((name + "/general").c_str(), [options](benchmark::State& state) {
    const SmallScene system(make_scene_model<double>(heavy_top_scene(BodyKind::r3xso3)));
    measure(state, *started_itself(options, system, 1e-4));
  });
  benchmark::RegisterBenchmark((name + "/floor").c_str(), [options](benchmark::State& state) {
    measure(state, *started<HeavyTopR3xSO3<double>>(options, 1e-4));
  });
}

}  // namespace

void add_scenes() {
  heavy_top_pair("scene/heavy_top/index3/k=3", BLieDF2nd::Options{.k = 3});
  heavy_top_pair("scene/heavy_top/stabilized_index2/k=3",
                 BLieDF2nd::Options{.k = 3, .form = Form::stabilized_index2});
  heavy_top_pair("scene/heavy_top/generalized_alpha", GeneralizedAlpha::Options{});
}

}  // namespace liebench::benchmarks
