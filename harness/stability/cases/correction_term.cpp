#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "harness/correction_stability.h"
#include "harness/scene_reader.h"
#include "harness/stability/cases/cases.h"
#include "harness/stability/linear_theory.h"

// The explicit correction term of BLieDF2nd where the constraint fixes the increments: a spinning body whose joint is on the axis of its
// spin, away from the centre of mass, disturbed by 1e-8 of its velocity.

namespace liebench {

namespace correction_term_case {

namespace {

constexpr double disturbance = 1e-8;
constexpr std::uint64_t steps = 600;

// About the joint the body is a needle: a disturbance of its spin makes the axis turn by next to nothing in a step, and nothing but the
// correction term moves it. What the constraint takes of a change of Omega across the axis is m l^2 / (J_1 + m l^2) of it.
constexpr double mass = 1e4, moment = 1.0, held = mass / (moment + mass);
SceneDescription body_at(double t, double spin) {
  static const SceneDescription still = read_scene(parse_json(R"({"name": "spinning body",
    "bodies": [{"name": "body", "mass": 10000, "inertia": [1, 1, 0.01], "position": [0, 0, 1]}],
    "joints": [{"name": "tip", "type": "spherical", "bodies": ["ground", "body"], "point": [0, 0, 0]}]})",
                                                              "spinning body"));
  SceneDescription scene = still;
  scene.bodies[0].angular_velocity = {0.0, 0.0, spin};
  scene.bodies[0].orientation = {std::cos(0.5 * spin * t), 0.0, 0.0, std::sin(0.5 * spin * t)};
  return scene;
}

Finding examine(const Contestant& method, const std::string& form, double angle, double bound) {
  SceneRun run;
  run.scene = assembled(body_at(0.0, angle));
  run.integrator = std::string(method.method->name);
  run.options = method.options_for(form, false);
  run.step_size = 1.0;
  run.steps = steps;
  run.exact = [=](double t) { return body_at(t, angle); };
  // Of the kind that fulfils B v = 0.
  run.disturb = [=](std::vector<StartingPoint>& points) {
    StartingPoint& last = points[std::size_t(method.steps() - 1)];
    const double d = disturbance * angle;
    last.v(3) += d;
    const double c = std::cos(angle * double(method.steps() - 1)),
                 s = std::sin(angle * double(method.steps() - 1));
    // x' = R (Omega x X): Omega = (d, 0, .) moves X = (0, 0, 1) by (0, -d, 0) in the body frame.
    last.v(0) += s * d;
    last.v(1) += -c * d;
  };
  double transverse = 0.0;
  run.watch = [&](const WatchedState& s) {
    transverse = std::hypot(s.bodies[0].omega(0), s.bodies[0].omega(1));
  };
  Finding finding = finding_of(run_scene(run));
  const double radius =
      correction_spectral_radius(method.steps(), method.correction() == "implicit", held * angle);
  const bool affected = form == "index3" && angle * held > bound;
  finding.expected = affected ? Grade::failed : Grade::survived;
  finding.measured["spectral_radius"] = radius;
  finding.what = "disturbance, times the first";
  finding.reason = form == "index3"
                       ? fmt::format("stable up to h |v| = {:.4g}; here {:.4g}", bound, angle)
                       : "in the stabilized form v is tied to B v = 0: the term does not feed itself";
  if (finding.grade == Grade::failed) return finding;
  finding.amount = transverse / (disturbance * angle);
  finding.measured["disturbance_factor"] = *finding.amount;
  if (!(*finding.amount <= 1e3)) finding.grade = Grade::failed;
  return finding;
}

// BLieDF2nd with variable steps has the same term. At a constant rotation all its estimates vanish, and what ends the growth of its
// steps is that they turn by 0.9 pi at most: below the bounds of k = 3 and 4, and for k = 2, whose term is h^2 / 12 [v, v'] with v' of one
// difference, e_{n+1} = -+ i h |v| / 12 (e_n - e_{n-1}), below 6.
Finding examine_own_steps(const Contestant& method, const std::string& form) {
  SceneRun run;
  constexpr double spin = 1.0;
  run.scene = assembled(body_at(0.0, spin));
  run.integrator = std::string(method.method->name);
  run.options = method.options_for(form);
  run.step_size = 1.0;
  run.steps = steps;
  run.exact = [](double t) { return body_at(t, spin); };
  run.disturb = [](std::vector<StartingPoint>& points) {
    points[0].v(3) += disturbance;
    points[0].v(1) -= disturbance;
  };
  double transverse = 0.0;
  run.watch = [&](const WatchedState& s) {
    transverse = std::hypot(s.bodies[0].omega(0), s.bodies[0].omega(1));
  };
  const SceneRunEnd end = run_scene(run);
  Finding finding = finding_of(end);
  finding.what = "disturbance, times the first";
  const double turn = spin * end.longest_step;
  const double radius = std::max(correction_spectral_radius(3, false, held * turn),
                                 correction_spectral_radius(4, false, held * turn));
  finding.measured["largest_turn"] = turn;
  finding.measured["spectral_radius"] = radius;
  finding.measured["steps"] = double(end.reached);
  finding.reason =
      fmt::format("no step turns by more than 0.9 pi: the longest by {:.3g} rad, where the radius is {:.3g}",
                  turn, radius);
  if (finding.grade == Grade::failed) return finding;
  finding.amount = transverse / disturbance;
  finding.measured["disturbance_factor"] = *finding.amount;
  // That the steps keep within the bound is part of the criterion.
  if (!(*finding.amount <= 1e3) || !(radius <= 1.0)) finding.grade = Grade::failed;
  return finding;
}

std::vector<Trial> trials() {
  std::vector<Trial> all;
  add_trials(all, constrained_forms,
             [](const Contestant& method, const std::string& form) -> std::optional<Trial> {
               if (!method.is("bliedf2nd_variable")) return std::nullopt;
               Trial t;
               t.variant = "1 rad/s, 600 s";
               t.parameters = {{"spin", 1.0}, {"length", double(steps)}};
               t.run = [=, &method] { return examine_own_steps(method, form); };
               return t;
             });
  for (const double part : {0.8, 1.25}) {
    const TrialMaker make = [&](const Contestant& method, const std::string& form) -> std::optional<Trial> {
      if (method.correction().empty() || !method.is("bliedf2nd")) return std::nullopt;
      const double bound = correction_stability_bound(method.steps(), method.correction() == "implicit");
      const double angle = part * bound;
      // Steps that turn by pi are no case for it.
      if (angle > 3.0) return std::nullopt;
      Trial t;
      t.modified_start = false;
      t.variant = fmt::format("h |v| = {:.4g}, {} of the bound", angle, part);
      t.parameters = {{"part", part}, {"angle", angle}};
      t.run = [=, &method] { return examine(method, form, angle, bound); };
      return t;
    };
    add_trials(all, constrained_forms, make);
  }
  return all;
}

}  // namespace

}  // namespace correction_term_case

StabilityCase correction_term() {
  return {
      .name = "correction_term",
      .title = "Correction term",
      .question = "Up to which h |v| is the correction term L_k stable?",
      .criterion = "survived: a disturbance of 1e-8 has grown by less than 1000 after 600 steps",
      .theory = "the recursion e_{n+1} = -h^2 dL_k of the velocity's errors (harness/correction_stability.h)",
      .trials = correction_term_case::trials};
}

}  // namespace liebench
