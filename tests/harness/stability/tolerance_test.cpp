#include "harness/stability/tolerance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "harness/scene_reader.h"

namespace liebench {
namespace {

std::shared_ptr<const AssembledScene> tumbling_body() {
  return assembled(read_scene(parse_json(R"({"name": "free body",
    "bodies": [{"name": "body", "formulation": "SO3", "fixed_point": [0, 0, 0], "mass": 1, "inertia": [1, 2, 2.5],
                "angular_velocity": [0.3, 1, 2]}]})",
                                         "free body")));
}
std::shared_ptr<const AssembledScene> pendulum() {
  return assembled(read_scene(parse_json(R"({"name": "pendulum",
    "bodies": [{"name": "rod", "mass": 1, "inertia": [0.01, 0.0833333, 0.0833333], "position": [0.5, 0, 0]}],
    "joints": [{"name": "hinge", "type": "revolute", "bodies": ["ground", "rod"], "point": [0, 0, 0], "axis": [0, 1, 0]}],
    "effects": [{"type": "uniform_gravity", "acceleration": [0, 0, -9.81]}]})",
                                         "pendulum")));
}

struct DriftSeen {
  double energy = 0.0, of_tolerance = 0.0;
  SceneRunEnd end;
};

DriftSeen drift(const Contestant& method, const std::string& form) {
  SceneRun run;
  run.scene = form.empty() ? tumbling_body() : pendulum();
  run.integrator = std::string(method.method->name);
  run.options = method.options_for(form);
  run.step_size = 10.0;
  run.steps = 1;
  run.watch_own_steps = true;
  DriftSeen result;
  double first = 0.0;
  run.watch = [&](const WatchedState& s) {
    if (s.step == 0) first = s.energy;
    result.energy = std::max(result.energy, std::abs(s.energy - first));
    result.of_tolerance = std::max(result.of_tolerance, s.energy_of_tolerance);
  };
  result.end = run_scene(run);
  return result;
}

// A method whose steps take no notice of their errors is planted by the largest tolerance: its drift is not within what a
// smaller one permits.
TEST(Tolerance, PermitsTheDriftOfAMethodThatKeepsItAndOfNoOther) {
  int planted = 0;
  for (const char* name : {"rkmk_variable", "bliedf2nd_variable"})
    for (const char* form : {"", "index3", "stabilized_index2"}) {
      if (std::string_view(name) == "rkmk_variable" && *form != '\0') continue;
      const Contestant kept = contestant(name, {{"tolerance", 1e-8}}),
                       ignored = contestant(name, {{"tolerance", 1.0}});
      const DriftSeen small = drift(kept, form), large = drift(ignored, form);
      ASSERT_EQ(small.end.outcome, Outcome::ok) << name << ' ' << form;
      EXPECT_LE(small.energy, permitted_energy(kept, small.end.reached, small.of_tolerance))
          << name << ' ' << form;
      if (large.end.outcome != Outcome::ok) continue;
      ++planted;
      EXPECT_GT(large.energy, permitted_energy(kept, large.end.reached, large.of_tolerance))
          << name << ' ' << form;
    }
  EXPECT_GE(planted, 2);
}

// |R(z)| = 1 at -3.3066 [Hairer & Wanner, Solving ODE II, IV.2].
TEST(Tolerance, TheLargestStableStepIsThatOfDormandAndPrince) {
  const Contestant method = contestant("rkmk_variable", {{"tolerance", 1e-4}});
  EXPECT_NEAR(stable_step(method, {-7.0, 0.0}), 3.31, 0.02);
  EXPECT_TRUE(std::isinf(stable_step(contestant("bliedf2nd_variable", {{"tolerance", 1e-4}}), {-7.0, 0.0})));
}

TEST(Tolerance, AStiffMotionCostsAnExplicitMethodItsStabilityAndABdfMethodNothing) {
  const Contestant method = contestant("rkmk_variable", {{"tolerance", 1e-4}});
  EXPECT_NEAR(steps_for_oscillation(method, {-1e6, 0.0}, 1.0, 1.0, 6), 1e6 / 3.31, 3e3);
  const Contestant bdf = contestant("bliedf2nd_variable", {{"tolerance", 1e-4}});
  EXPECT_LT(steps_for_oscillation(bdf, {-1e6, 0.0}, 1.0, 1.0, 6), 400.0);
  // A fifth power of the tolerance.
  const Contestant fine = contestant("bliedf2nd_variable", {{"tolerance", 1e-9}});
  EXPECT_NEAR(steps_for_oscillation(fine, {0.0, 10.0}, 1.0, 100.0, 6) /
                  steps_for_oscillation(bdf, {0.0, 10.0}, 1.0, 100.0, 6),
              10.0, 0.5);
}

}  // namespace
}  // namespace liebench
