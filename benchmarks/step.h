#pragma once

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "benchmarks/fast_top.h"
#include "benchmarks/floors/floor.h"
#include "harness/instances/heavy_top_steppers.h"

// Steps of the fast heavy top, by the general steppers and by their floors.

namespace liebench::benchmarks {

// The system whose steps an audit counts.
template <class S>
struct PlainSystem {
  using type = S;
};
template <class S>
struct PlainSystem<Audited<S>> {
  using type = typename S::template rebind<double>;
};

template <class Floor>
Floor started(Floor floor, double h) {
  const typename Floor::System system{HeavyTopParameters{}};
  floor.start(h, fast_top_points(system, h, Floor::starting_points));
  return floor;
}

// The general stepper of a method, of the program itself.
template <MechanicalSystem S>
std::unique_ptr<AnyStepper<S>> started(const MethodOptions& options, double h) {
  std::unique_ptr<AnyStepper<S>> stepper = any_stepper(options, S{HeavyTopParameters{}});
  using Plain = typename PlainSystem<S>::type;
  const auto points = fast_top_points(Plain{HeavyTopParameters{}}, h, stepper->starting_points());
  if constexpr (std::is_same_v<S, Plain>) {
    stepper->start(h, points);
  } else {
    std::vector<SolutionPoint<S>> counted;
    for (const auto& p : points)
      counted.push_back({p.t, Plain::Group::template cast<Counted>(p.q), p.v.template cast<Counted>(),
                         p.acceleration.template cast<Counted>(), p.lambda.template cast<Counted>()});
    stepper->start(h, counted);
  }
  return stepper;
}

// Google Benchmark's loop over the steps of a floor that has been started.
template <class Floor>
void measure(benchmark::State& state, const Floor& at_start) {
  Floor floor = at_start;
  for (auto _ : state) {
    // The motion of the first 2 s again and again: outside of it accuracy may be lost, and the step with it.
    if (floor.time() > 2.0) floor = at_start;
    if (!floor.step()) {
      state.SkipWithError("the step failed");
      break;
    }
    benchmark::DoNotOptimize(floor.velocity());
  }
}

template <MechanicalSystem S>
void measure(benchmark::State& state, const AnyStepper<S>& at_start) {
  const std::unique_ptr<AnyStepper<S>> stepper = at_start.clone();
  for (auto _ : state) {
    if (stepper->time() > 2.0) stepper->assign(at_start);
    if (stepper->step().outcome != Outcome::ok) {
      state.SkipWithError("the step failed");
      break;
    }
    benchmark::DoNotOptimize(stepper->velocity());
  }
}

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

template <class Floor, class Audited>
void compare(const std::string& name, const MethodOptions& options) {
  Floor floor = started(Floor{}, 1e-4);
  const auto general = started<Audited>(options, 1e-4);
  for (int i = 0; i < compared_steps; ++i)
    if (general->step().outcome != Outcome::ok || !floor.step()) refuse(name, "failed in step", i, i);
  const double position = floors::distance(floor.configuration(),
                                           Audited::Group::template cast<double>(general->configuration()));
  if (!(position <= position_tolerance))
    refuse(name, "position, distance and tolerance", position, position_tolerance);
  const double velocity =
      floors::distance(floor.velocity(), general->velocity().template cast<double>().eval());
  if (!(velocity <= velocity_tolerance))
    refuse(name, "velocity, distance and tolerance", velocity, velocity_tolerance);
  double iterations = 0.0, of_floor = 0.0, matrices = 0.0, own = 0.0;
  // An explicit method has neither.
  if constexpr (requires { floor.kept(); }) {
    const KernelAudit audit = general->audit();
    iterations = double(audit.iterations);
    of_floor = double(floor.kept().iterations);
    matrices = double(audit.factorizations - audit.factorizations_start);
    own = double(floor.kept().factorizations);
  }
  if (std::abs(iterations - of_floor) > iteration_tolerance * iterations)
    refuse(name, "iterations", iterations, of_floor);
  if (std::abs(matrices - own) > matrix_tolerance * (matrices + 20.0))
    refuse(name, "factorizations", matrices, own);
  if (std::getenv("LIEBENCH_FLOOR_DETAILS"))
    std::fprintf(stderr, "%s: %.1e %.1e, %g %g, %g %g\n", name.c_str(), position, velocity, iterations,
                 of_floor, matrices, own);
}

// Registers `name`/general and `name`/floor with h = 1e-4: the benchmark's reporter sets them side by side. Ends the
// program where the two do not do the same.
template <class Floor, MechanicalSystem S>
void add_pair(const std::string& name, const MethodOptions& options) {
  compare<Floor, Audited<typename S::template rebind<Counted>>>(name, options);
  benchmark::RegisterBenchmark((name + "/general").c_str(), [options](benchmark::State& state) {
    measure(state, *started<S>(options, 1e-4));
  });
  add_floor<Floor>(name);
}

void add_bliedf2nd();
void add_generalized_alpha();
void add_faltinsen_bdf();
void add_explicit_methods();
void add_half_explicit();
void add_momentum_methods();
void add_gauss();
void add_radau();
void add_symmetric_methods();
void add_centred_bdf();
void add_step_size_control();
void add_scenes();

}  // namespace liebench::benchmarks
