#include "harness/stability/scene_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "harness/scene_reader.h"
#include "harness/stability/contestant.h"
#include "integrators/bdf_coefficients.h"

namespace liebench {
namespace {

std::shared_ptr<const AssembledScene> disc(double slip_velocity) {
  Json scene = parse_json(R"({"name": "disc",
    "bodies": [{"name": "disc", "mass": 2, "inertia": [0.6, 0.6, 1], "angular_velocity": [0, 0, 1]}],
    "joints": [{"name": "hinge", "type": "revolute", "bodies": ["ground", "disc"], "point": [0, 0, 0], "axis": [0, 0, 1]}]})",
                          "disc");
  if (slip_velocity > 0.0)
    scene["effects"] = {
        {{"type", "joint_friction"}, {"joint", "hinge"}, {"torque", 2.0}, {"slip_velocity", slip_velocity}}};
  return assembled(read_scene(scene));
}

std::shared_ptr<const AssembledScene> double_pendulum() {
  return assembled(read_scene(parse_json(R"({"name": "double pendulum",
    "bodies": [{"name": "a", "mass": 1, "inertia": [0.01, 0.0833333, 0.0833333], "position": [0.5, 0, 0]},
               {"name": "b", "mass": 1, "inertia": [0.01, 0.0833333, 0.0833333], "position": [1.5, 0, 0]}],
    "joints": [{"type": "spherical", "bodies": ["ground", "a"], "point": [0, 0, 0]},
               {"type": "spherical", "bodies": ["a", "b"], "point": [1, 0, 0]}],
    "effects": [{"type": "uniform_gravity", "acceleration": [0, 0.3, -9.81]}]})",
                                         "double pendulum")));
}

SceneRun run_of(const std::shared_ptr<const AssembledScene>& scene, Contestant method, bool safeguard) {
  method.safeguard = safeguard;
  SceneRun run;
  run.scene = scene;
  run.integrator = std::string(method.method->name);
  run.options = method.options_for("index3");
  run.step_size = 1e-3;
  run.steps = 1000;
  return run;
}

TEST(Safeguard, TakesAStepThroughFrictionThatPlainNewtonDoesNot) {
  for (const Contestant& method : contestants(false)) {
    if (!method.can_be_safeguarded() || !fits(method.method->fits, true)) continue;
    SceneRun run = run_of(disc(1e-8), method, false);
    EXPECT_EQ(run_scene(run).outcome, Outcome::newton_diverged) << method.name;
    run = run_of(disc(1e-8), method, true);
    double rate = 1.0;
    run.watch = [&](const WatchedState& s) { rate = s.bodies[0].omega(2); };
    EXPECT_EQ(run_scene(run).outcome, Outcome::ok) << method.name;
    // Two steps of the torque and the slip velocity.
    EXPECT_LE(std::abs(rate), 4e-3 + 1e-8) << method.name;
  }
}

// J (sum alpha_i v_{n+1-i}) / h = -T tanh(v_{n+1} / v_s) in every step, where Newton's iteration failed, too. v is known to some eps / h,
// which is 1e-5 of the slip velocity here.
TEST(Safeguard, SolvesTheEquationOfTheStep) {
  constexpr double slip = 1e-8, torque = 2.0, h = 1e-3;
  for (const int k : {1, 2, 4, 6}) {
    SceneRun run = run_of(disc(slip), contestant("bliedf2nd", {{"k", k}}), true);
    std::vector<double> rates;
    run.every = 1;
    run.watch = [&](const WatchedState& s) { rates.push_back(s.bodies[0].omega(2)); };
    ASSERT_EQ(run_scene(run).outcome, Outcome::ok) << k;
    const auto alpha = bdf_coefficients<double>(k).alpha;
    for (std::size_t n = 2 * std::size_t(k); n < rates.size(); ++n) {
      double change = 0.0;
      for (std::size_t i = 0; i <= std::size_t(k); ++i) change += alpha[i] * rates[n - i];
      EXPECT_NEAR(change / (h * torque), -std::tanh(rates[n] / slip), 1e-3) << "k = " << k << ", step " << n;
    }
  }
}

// Driven faster and faster, a hinge turns by half a turn in a step: a turn less would fulfil its constraint, too.
TEST(Safeguard, DoesNotTakeATurnLess) {
  const auto hinge = assembled(read_scene(parse_json(R"({"name": "driven",
    "bodies": [{"name": "disc", "mass": 2, "inertia": [0.6, 0.6, 1], "angular_velocity": [0, 0, 10]}],
    "joints": [{"type": "revolute", "bodies": ["ground", "disc"], "point": [0, 0, 0], "axis": [0, 0, 1],
                "motion": {"polynomial": [0, 10, 10]}}]})",
                                                     "driven")));
  for (const char* form : {"index3", "stabilized_index2"})
    for (const Contestant& method : contestants(true)) {
      if (!method.can_be_safeguarded() || !fits(method.method->fits, true)) continue;
      SceneRun run = run_of(hinge, method, true);
      run.options = method.options_for(form);
      run.step_size = 0.1;
      run.steps = 30;
      const SceneRunEnd end = run_scene(run);
      EXPECT_NE(end.outcome, Outcome::ok) << method.name << ", " << form;
    }
}

TEST(Safeguard, ChangesNoBitOfARunThatDoesNotFail) {
  for (const Contestant& method : contestants(false)) {
    std::vector<double> states[2];
    for (const bool safeguard : {false, true}) {
      SceneRun run = run_of(double_pendulum(), method, safeguard);
      run.steps = 200;
      run.every = 10;
      run.watch = [&](const WatchedState& s) {
        for (const auto& body : s.bodies)
          for (int i = 0; i < 3; ++i) states[safeguard].push_back(body.x(i));
        for (Eigen::Index i = 0; i < s.multipliers.size(); ++i) states[safeguard].push_back(s.multipliers(i));
      };
      ASSERT_EQ(run_scene(run).outcome, Outcome::ok) << method.name;
    }
    EXPECT_EQ(states[0], states[1]) << method.name;
  }
}

TEST(SceneRun, BackwardsLeadsToWhereItCameFrom) {
  const Contestant method = contestant("bliedf2nd", {{"k", 4}});
  SceneRun run = run_of(double_pendulum(), method, false);
  run.steps = 300;
  WatchedState end;
  run.watch = [&](const WatchedState& s) { end = s; };
  ASSERT_EQ(run_scene(run).outcome, Outcome::ok);
  AssembledScene there = *run.scene;
  for (std::size_t i = 0; i < 2; ++i) {
    BodyDescription& body = there.scene.bodies[i];
    body.position = end.bodies[i].x;
    body.velocity = end.bodies[i].u;
    body.orientation = SO3<double>::quaternion(end.bodies[i].R);
    body.angular_velocity = end.bodies[i].omega;
  }
  SceneRun back = run;
  back.scene = std::make_shared<AssembledScene>(there);
  back.step_size = -run.step_size;
  WatchedState again;
  back.watch = [&](const WatchedState& s) { again = s; };
  ASSERT_EQ(run_scene(back).outcome, Outcome::ok);
  // Twice the error of order 4 at h = 1e-3 s.
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_LE((again.bodies[i].x - run.scene->scene.bodies[i].position).norm(), 1e-7);
}

TEST(SceneRun, WatchesEverySoManyStepsFromTheFirstToTheLast) {
  SceneRun run = run_of(disc(0.0), contestant("bliedf2nd", {{"k", 5}}), false);
  run.steps = 23;
  run.every = 10;
  std::vector<std::uint64_t> seen;
  run.watch = [&](const WatchedState& s) {
    seen.push_back(s.step);
    EXPECT_DOUBLE_EQ(s.t, 1e-3 * double(s.step));
    // 1 rad/s from the start.
    EXPECT_NEAR(std::atan2(s.bodies[0].R(1, 0), s.bodies[0].R(0, 0)), s.t, 1e-14);
  };
  EXPECT_EQ(run_scene(run).reached, 23u);
  EXPECT_EQ(seen, (std::vector<std::uint64_t>{0, 10, 20, 23}));
}

TEST(SceneRun, AFailureSaysTheStepAndTheTime) {
  Json scene = parse_json(R"json({"name": "rod",
    "bodies": [{"name": "rod", "mass": 1, "inertia": [0.1, 0.1, 0.1]}],
    "effects": [{"type": "applied_force", "body": "rod", "torque": [0, 0, 1], "factor": {"expression": "t < 0.0495 ? 1 : sqrt(-1)"}}]})json",
                          "rod");
  SceneRun run =
      run_of(assembled(read_scene(scene)), contestant("generalized_alpha", {{"rho_inf", 0.5}}), true);
  run.options = contestant("generalized_alpha", {{"rho_inf", 0.5}}).options_for("");
  const SceneRunEnd end = run_scene(run);
  EXPECT_EQ(end.outcome, Outcome::non_finite);
  ASSERT_TRUE(end.failure.has_value());
  // The first step that ends beyond 0.0495 s.
  EXPECT_EQ(end.failure->step, 50u);
  EXPECT_DOUBLE_EQ(end.failure->time, 0.05);
  EXPECT_EQ(end.reached, 49u);
}

SceneRun own_steps(const std::shared_ptr<const AssembledScene>& scene, const char* integrator,
                   double tolerance, const std::string& form) {
  const Contestant method = contestant(integrator, {{"tolerance", tolerance}});
  SceneRun run;
  run.scene = scene;
  run.integrator = integrator;
  run.options = method.options_for(form);
  run.step_size = 0.1;
  run.steps = 7;
  return run;
}

TEST(ChosenSteps, EndAtTheEndOfTheIntervalToTheLastBit) {
  for (const double direction : {1.0, -1.0}) {
    SceneRun run = own_steps(double_pendulum(), "bliedf2nd_variable", 1e-6, "index3");
    run.step_size *= direction;
    double t = 0.0;
    run.watch = [&](const WatchedState& s) { t = s.t; };
    const SceneRunEnd end = run_scene(run);
    EXPECT_EQ(end.outcome, Outcome::ok);
    EXPECT_EQ(end.time, run.step_size * 7.0);
    EXPECT_EQ(t, end.time);
    EXPECT_GT(end.reached, 10u);
    EXPECT_GT(end.longest_step, end.shortest_step);
    EXPECT_LE(end.longest_step, 0.7);
  }
}

TEST(ChosenSteps, AreWatchedAtTheFirstBehindEachTimeOrAll) {
  SceneRun run = own_steps(double_pendulum(), "bliedf2nd_variable", 1e-6, "stabilized_index2");
  std::vector<double> times, all;
  run.watch_own_steps = true;
  run.watch = [&](const WatchedState& s) { all.push_back(s.t); };
  const SceneRunEnd end = run_scene(run);
  EXPECT_EQ(all.size(), end.reached + 1);
  run.watch_own_steps = false;
  run.every = 2;
  run.watch = [&](const WatchedState& s) {
    times.push_back(s.t);
    EXPECT_GT(s.energy_of_tolerance, 0.0);
  };
  run_scene(run);
  std::vector<double> expected{0.0};
  for (const double wanted : {0.2, 0.4, 0.6})
    expected.push_back(*std::lower_bound(all.begin(), all.end(), wanted));
  expected.push_back(all.back());
  EXPECT_EQ(times, expected);
}

TEST(ChosenSteps, AreNoMoreThanAllowed) {
  SceneRun run = own_steps(double_pendulum(), "bliedf2nd_variable", 1e-8, "index3");
  run.most_own_steps = 5;
  const SceneRunEnd end = run_scene(run);
  EXPECT_EQ(end.outcome, Outcome::step_limit);
  EXPECT_EQ(end.reached, 5u);
  ASSERT_TRUE(end.failure.has_value());
  EXPECT_EQ(end.failure->step, 6u);
  EXPECT_EQ(end.failure->time, end.time);
}

}  // namespace
}  // namespace liebench
