#include <memory>
#include <string>

#include "benchmarks/step.h"

// Steps that their method chooses, in time of an accepted one with all that were rejected before it. Without floors.

namespace liebench::benchmarks {

namespace {

// From t = 0 over 2 s, again and again.
template <class S>
void add(const std::string& name, const MethodOptions& options) {
  benchmark::RegisterBenchmark((name + "/general").c_str(), [options](benchmark::State& state) {
    const std::unique_ptr<AnyStepper<S>> at_start = started<S>(options, 2.0), stepper = at_start->clone();
    for (auto _ : state) {
      if (stepper->finished()) stepper->assign(*at_start);
      if (stepper->step().outcome != Outcome::ok) {
        state.SkipWithError("the step failed");
        break;
      }
      benchmark::DoNotOptimize(stepper->velocity());
    }
  });
}

}  // namespace

void add_step_size_control() {
  using SO3System = HeavyTopSO3<double>;
  using R3xSO3System = HeavyTopR3xSO3<double>;
  add<SO3System>("rkmk_variable/SO3", RkmkVariable::Options{});
  add<SO3System>("bliedf2nd_variable/SO3", BLieDF2ndVariable::Options{});
  add<R3xSO3System>("bliedf2nd_variable/R3xSO3/index3", BLieDF2ndVariable::Options{});
  add<R3xSO3System>("bliedf2nd_variable/R3xSO3/stabilized_index2",
                    BLieDF2ndVariable::Options{.form = Form::stabilized_index2});
}

}  // namespace liebench::benchmarks
