#pragma once

#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "benchmarks/fast_top.h"
#include "benchmarks/floors/floor.h"
#include "integrators/audit.h"
#include "integrators/newton.h"

// Steps of the fast heavy top, by the general steppers and by their floors.

namespace liebench::benchmarks {

inline bool succeeded(const StepResult& result) {
  return result.outcome == Outcome::ok;
}
inline bool succeeded(bool done) {
  return done;
}

template <class Stepper>
Stepper started(Stepper stepper, double h) {
  const typename Stepper::System system{HeavyTopParameters{}};
  int count;
  if constexpr (requires { stepper.starting_points(); })
    count = stepper.starting_points();
  else
    count = Stepper::starting_points;
  stepper.start(h, fast_top_points(system, h, count));
  return stepper;
}

// Google Benchmark's loop over the steps of a stepper that has been started.
template <class Stepper>
void measure(benchmark::State& state, const Stepper& at_start) {
  Stepper stepper = at_start;
  for (auto _ : state) {
    // The motion of the first 2 s again and again: outside of it accuracy may be lost, and the step with it.
    if (stepper.time() > 2.0) stepper = at_start;
    if (!succeeded(stepper.step())) {
      state.SkipWithError("the step failed");
      break;
    }
    benchmark::DoNotOptimize(stepper.velocity());
  }
}

// Registers `name`/general and `name`/floor with h = 1e-4: the benchmark's reporter sets them side by side. Ends the
// program where the two do not do the same.
template <class Floor, class General, class Audited, class Options>
void add_pair(const std::string& name, const Options& options);

// Registers a floor alone, of a method whose general stepper is not there.
template <class Floor>
void add_floor(const std::string& name) {
  benchmark::RegisterBenchmark((name + "/floor").c_str(),
                               [](benchmark::State& state) { measure(state, started(Floor{}, 1e-4)); });
}

[[noreturn]] inline void refuse(const std::string& name, const char* what, double general, double floor) {
  std::fprintf(stderr, "%s: general stepper and floor are not the same method: %s %.17g and %.17g\n",
               name.c_str(), what, general, floor);
  std::exit(1);
}

// Both take 1000 steps of 1e-4 s. Their states differ by what round-off makes of itself: the constraint is known to eps |x|
// and makes noise of eps |x| / h in the velocity of every step, some 1e-12 m/s, and the position sums it up. Their
// iterations may differ where a correction is next to a limit of the stopping rule.
inline constexpr int compared_steps = 1000;
inline constexpr double position_tolerance = 1e-11, velocity_tolerance = 1e-9;
// Relative; of the matrices, which may be two dozen, to their number and 20 more.
inline constexpr double iteration_tolerance = 0.02, matrix_tolerance = 0.1;

template <class Floor, class General>
void compare(const std::string& name, General general) {
  Floor floor = started(Floor{}, 1e-4);
  general = started(general, 1e-4);
  for (int i = 0; i < compared_steps; ++i)
    if (!succeeded(general.step()) || !succeeded(floor.step())) refuse(name, "failed in step", i, i);
  const double position = floors::distance(floor.configuration(), general.configuration());
  if (!(position <= position_tolerance))
    refuse(name, "position, distance and tolerance", position, position_tolerance);
  const double velocity = floors::distance(floor.velocity(), general.velocity());
  if (!(velocity <= velocity_tolerance))
    refuse(name, "velocity, distance and tolerance", velocity, velocity_tolerance);
  const double iterations = double(general.audit().iterations), of_floor = double(floor.kept().iterations);
  if (std::abs(iterations - of_floor) > iteration_tolerance * iterations)
    refuse(name, "iterations", iterations, of_floor);
  const double matrices = double(general.audit().factorizations - general.audit().factorizations_start),
               own = double(floor.kept().factorizations);
  if (std::abs(matrices - own) > matrix_tolerance * (matrices + 20.0))
    refuse(name, "factorizations", matrices, own);
  if (std::getenv("LIEBENCH_FLOOR_DETAILS"))
    std::fprintf(stderr, "%s: %.1e %.1e, %g %g, %g %g\n", name.c_str(), position, velocity, iterations,
                 of_floor, matrices, own);
}

template <class Floor, class General, class Audited, class Options>
void add_pair(const std::string& name, const Options& options) {
  using System = typename General::System;
  compare<Floor>(name, Audited(System{HeavyTopParameters{}}, options));
  benchmark::RegisterBenchmark((name + "/general").c_str(), [options](benchmark::State& state) {
    measure(state, started(General(System{HeavyTopParameters{}}, options), 1e-4));
  });
  add_floor<Floor>(name);
}

void add_bliedf2nd();
void add_generalized_alpha();
void add_faltinsen_bdf();

}  // namespace liebench::benchmarks
