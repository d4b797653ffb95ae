#include <cmath>
#include <memory>
#include <string>

#include "benchmarks/floors/bliedf2nd_variable.h"
#include "benchmarks/floors/rkmk_variable.h"
#include "benchmarks/step.h"

// Steps that their method chooses, in time of an accepted one with all that were rejected before it.

namespace liebench::benchmarks {

namespace {

constexpr double length = 2.0;  // s
// What round-off makes of itself over thousands of steps: 1e-12 of a step in the velocity, where there is a constraint.
constexpr double most_apart = 1e-8;

// The interval once, by both: as many steps, as many rejected, and the same end.
template <class Floor, class Audited>
void compare_courses(const std::string& name, const MethodOptions& options) {
  Floor floor = started(Floor{}, length);
  const auto general = started<Audited>(options, length);
  int steps = 0, own = 0;
  for (; !general->finished(); ++steps)
    if (general->step().outcome != Outcome::ok) refuse(name, "failed in step", steps, steps);
  for (; !floor.finished(); ++own)
    if (!floor.step()) refuse(name, "failed in step", own, own);
  if (steps != own) refuse(name, "steps", steps, own);
  const double rejections = double(general->audit().rejections);
  if (rejections != double(floor.rejections()))
    refuse(name, "rejected steps", rejections, double(floor.rejections()));
  const double position = floors::distance(floor.configuration(),
                                           Audited::Group::template cast<double>(general->configuration()));
  const double velocity =
      floors::distance(floor.velocity(), general->velocity().template cast<double>().eval());
  if (!(position <= most_apart)) refuse(name, "position, distance and tolerance", position, most_apart);
  if (!(velocity <= most_apart)) refuse(name, "velocity, distance and tolerance", velocity, most_apart);
  if (std::getenv("LIEBENCH_FLOOR_DETAILS"))
    std::fprintf(stderr, "%s: %.1e %.1e, %d steps, %g rejected\n", name.c_str(), position, velocity, steps,
                 rejections);
}

template <class Floor, class S>
void add(const std::string& name, const MethodOptions& options) {
  compare_courses<Floor, Audited<typename S::template rebind<Counted>>>(name, options);
  benchmark::RegisterBenchmark((name + "/general").c_str(), [options](benchmark::State& state) {
    const std::unique_ptr<AnyStepper<S>> at_start = started<S>(options, length), stepper = at_start->clone();
    for (auto _ : state) {
      if (stepper->finished()) stepper->assign(*at_start);
      if (stepper->step().outcome != Outcome::ok) {
        state.SkipWithError("the step failed");
        break;
      }
      benchmark::DoNotOptimize(stepper->velocity());
    }
  });
  benchmark::RegisterBenchmark((name + "/floor").c_str(), [](benchmark::State& state) {
    const Floor at_start = started(Floor{}, length);
    Floor floor = at_start;
    for (auto _ : state) {
      if (floor.finished()) floor = at_start;
      if (!floor.step()) {
        state.SkipWithError("the step failed");
        break;
      }
      benchmark::DoNotOptimize(floor.velocity());
    }
  });
}

}  // namespace

void add_step_size_control() {
  using SO3System = HeavyTopSO3<double>;
  using R3xSO3System = HeavyTopR3xSO3<double>;
  add<floors::RkmkVariable, SO3System>("rkmk_variable/SO3", RkmkVariable::Options{});
  add<floors::BLieDF2ndVariable<floors::SO3Top>, SO3System>("bliedf2nd_variable/SO3",
                                                            BLieDF2ndVariable::Options{});
  add<floors::BLieDF2ndVariable<floors::Index3Top>, R3xSO3System>("bliedf2nd_variable/R3xSO3/index3",
                                                                  BLieDF2ndVariable::Options{});
  add<floors::BLieDF2ndVariable<floors::StabilizedTop>, R3xSO3System>(
      "bliedf2nd_variable/R3xSO3/stabilized_index2",
      BLieDF2ndVariable::Options{.form = Form::stabilized_index2});
}

}  // namespace liebench::benchmarks
