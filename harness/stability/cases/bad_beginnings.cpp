#include <fmt/format.h>

#include <cmath>

#include "harness/scene_reader.h"
#include "harness/stability/cases/cases.h"
#include "harness/stability/tolerance.h"

// Starts that are not what a method should get: off the constraint, off its hidden counterpart, with wrong accelerations and
// predictions, with quaternions of either sign.

namespace liebench {

namespace bad_beginnings_case {

namespace {

constexpr double h = 1e-3;
constexpr std::uint64_t steps = 1000;

SceneDescription slow_top(const char* formulation) {
  Json scene = parse_json(R"({"name": "slow top",
    "bodies": [{"name": "top", "mass": 15, "inertia": [0.234375, 0.46875, 0.234375], "position": [0, 1, 0],
                "velocity": [0.0461538, 0, 0], "angular_velocity": [0, 1.5, -0.0461538]}],
    "joints": [{"name": "tip", "type": "spherical", "bodies": ["ground", "top"], "point": [0, 0, 0]}],
    "effects": [{"type": "uniform_gravity", "acceleration": [0, 0, -9.81]}]})",
                          "slow top");
  scene["bodies"][0]["formulation"] = formulation;
  return read_scene(scene);
}

enum class Fault { position, unprojected_position, velocity, acceleration, prediction, branches };

struct Plan {
  Fault fault;
  double size;
};

SceneRun plain_run(const Contestant& method, const std::string& form, const char* formulation) {
  SceneRun run;
  run.scene = assembled(slow_top(formulation));
  run.integrator = std::string(method.method->name);
  run.options = method.options_for(form);
  run.step_size = h;
  run.steps = steps;
  return run;
}

Finding examine(const Plan& plan, const Contestant& method, const std::string& form) {
  SceneRun run = plain_run(method, form, plan.fault == Fault::branches ? "R3xS3" : "R3xSO3");
  WatchedState disturbed, undisturbed;
  run.watch = [&](const WatchedState& s) { undisturbed = s; };
  const SceneRunEnd clean_end = run_scene(run);
  Finding clean = finding_of(clean_end);
  run.watch = [&](const WatchedState& s) { disturbed = s; };
  const double size = plan.size;
  switch (plan.fault) {
    case Fault::position: {
      // As a user may write it; nobody has assembled the scene.
      AssembledScene off = *run.scene;
      off.scene.bodies[0].position += Eigen::Vector3d(0.6, 0.0, 0.8) * size;
      run.scene = std::make_shared<AssembledScene>(off);
      break;
    }
    case Fault::unprojected_position:
      run.disturb = [=](std::vector<StartingPoint>& points) {
        for (StartingPoint& p : points) p.q.head<3>() += Eigen::Vector3d(0.6, 0.0, 0.8) * size;
      };
      break;
    case Fault::velocity:
      run.disturb = [=](std::vector<StartingPoint>& points) {
        for (StartingPoint& p : points) p.v.head<3>() += Eigen::Vector3d(0.6, 0.0, 0.8) * size;
      };
      break;
    case Fault::acceleration:
      run.disturb = [=](std::vector<StartingPoint>& points) {
        for (StartingPoint& p : points) p.acceleration *= 1.0 + size;
      };
      break;
    case Fault::prediction:
      run.disturb = [=](std::vector<StartingPoint>& points) {
        for (StartingPoint& p : points) p.multipliers *= 1.0 + size;
      };
      break;
    case Fault::branches:
      run.disturb = [](std::vector<StartingPoint>& points) {
        for (std::size_t i = 1; i < points.size(); i += 2) points[i].q.segment<4>(3) *= -1.0;
      };
      break;
  }
  const SceneRunEnd end = run_scene(run);
  Finding finding = finding_of(end);
  finding.what = "distance of the end from that of the clean start, m";
  finding.expected = Grade::survived;
  finding.reason = "the start is projected, or the first step closes the constraint";
  if (method.chooses_steps()) {
    // Over the step before t_0 of the method's history, which stays as long, an error of d counts d h_1 / h_0: a short first
    // step is accepted. The first ones are of order 1: v_1 - v_0 is along M^{-1} B^T at q_1, v_2 - v_1 along that at q_2, so that
    // of d / h_1 across the constraint d |v| / L stays.
    finding.reason =
        "the first steps, of order 1, take d / h_1 of velocity in, and out again but for d |v| / L";
    finding.measured["steps"] = double(end.reached);
  } else if (plan.fault == Fault::unprojected_position) {
    // A jump of d in one step is a velocity of d / h across the constraint, whose direction turns by d / L meanwhile.
    const double impulse = size * size / h;
    finding.reason = fmt::format("the jump back acts as an impulse of d^2 / (h L) = {:.2g} m/s", impulse);
    if (impulse > 1.0) finding.at_worst = Grade::failed;
  }
  if (plan.fault == Fault::acceleration && method.rho_inf()) {
    finding.expected = Grade::degraded;
    finding.reason = "a_0 is a state of the method: h a_0 too much of velocity, for ever";
  }
  if (plan.fault == Fault::prediction && method.is("half_explicit")) {
    finding.at_worst = Grade::degraded;
    finding.reason = "lambda_0 is an input of the first stage of the first step";
  }
  if (weakly_unstable(method, form)) {
    finding.at_worst = Grade::failed;
    finding.reason = "rho_inf = 1: the multipliers of the index-3 form are weakly unstable";
  }
  if (clean.grade == Grade::failed) return clean;
  if (finding.grade == Grade::failed) return finding;
  const double distance = (disturbed.bodies[0].x - undisturbed.bodies[0].x).norm();
  const double multipliers = (disturbed.multipliers - disturbed.consistent_multipliers).norm() /
                             std::max(1.0, disturbed.consistent_multipliers.norm());
  finding.amount = distance;
  finding.measured["distance"] = distance;
  finding.measured["position_constraint"] = disturbed.position_constraint;
  finding.measured["lambda_error"] = multipliers;
  // A disturbance of size d moves the end by some d, in the units of what it disturbs.
  const bool in_state = plan.fault == Fault::position || plan.fault == Fault::unprojected_position ||
                        plan.fault == Fault::velocity;
  double allowed = in_state ? std::min(10.0 * size, 0.25) : 1e-6;
  // Of both runs, which do not take the same steps.
  if (method.chooses_steps()) allowed += permitted_error(method, clean_end.reached + end.reached, 6);
  finding.measured["allowed"] = allowed;
  if (!(distance <= allowed)) finding.grade = distance <= 0.5 ? Grade::degraded : Grade::failed;
  return finding;
}

std::vector<Trial> trials() {
  std::vector<Trial> all;
  const auto add = [&](const std::string& variant, const Plan& plan) {
    const TrialMaker make = [&](const Contestant& method, const std::string& form) -> std::optional<Trial> {
      // One point has no other branch.
      if (plan.fault == Fault::branches && (method.rho_inf() || method.chooses_steps())) return std::nullopt;
      Trial t;
      t.variant = variant;
      t.parameters = {{"fault", variant}, {"size", plan.size}};
      t.work = 4.0;
      t.run = [=, &method] { return examine(plan, method, form); };
      return t;
    };
    add_trials(all, constrained_forms, make);
  };
  for (const double size : {1e-6, 1e-3, 1e-1})
    add(fmt::format("position off by {} m", size), {Fault::position, size});
  for (const double size : {1e-6, 1e-3, 1e-1})
    add(fmt::format("starting points off by {} m", size), {Fault::unprojected_position, size});
  for (const double size : {1e-6, 1e-3, 1e-1})
    add(fmt::format("velocity off by {} m/s", size), {Fault::velocity, size});
  add("accelerations twice as large", {Fault::acceleration, 1.0});
  add("multipliers 1000 times as large", {Fault::prediction, 999.0});
  add("quaternions of either sign", {Fault::branches, 0.0});
  return all;
}

}  // namespace

}  // namespace bad_beginnings_case

StabilityCase bad_beginnings() {
  return {.name = "bad_beginnings",
          .title = "Bad beginnings",
          .question = "What becomes of a start that is not consistent?",
          .criterion =
              "survived: after 1000 steps the top is within 10 times the fault, and 0.25 m, of where a clean "
              "start leads "
              "it (1e-6 m for accelerations, "
              "predictions and branches; of chosen steps what the tolerance permits both runs in addition); "
              "degraded: within 0.5 m",
          .theory = "Phi = 0 from the first step on; what is off the constraint acts as an impulse",
          .trials = bad_beginnings_case::trials};
}

}  // namespace liebench
