#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "harness/scene_reader.h"
#include "harness/stability/cases/cases.h"
#include "harness/stability/linear_theory.h"
#include "harness/stability/tolerance.h"

// A free symmetric body that turns by h Omega in a step, with a small wobble: w' = i lambda w, lambda = (J3 - J1) / J1 Omega_3, for
// w = Omega_1 + i Omega_2. A method that chooses its steps turns as far in all, at any spin in steps of less than pi: only the wobble, and
// that bound, keep them short.

namespace liebench {

namespace large_rotations_case {

namespace {

constexpr double moment_ratio = 1.1;  // J3 / J1
constexpr double wobble = 1e-4;       // rad/s
constexpr std::uint64_t steps = 400;

SceneDescription body_at(double t, double spin) {
  static const SceneDescription still = read_scene(parse_json(R"({"name": "symmetric body",
    "bodies": [{"name": "body", "formulation": "SO3", "fixed_point": [0, 0, 0], "mass": 1, "inertia": [1, 1, 1.1]}]})",
                                                              "symmetric body"));
  const double lambda = (moment_ratio - 1.0) * spin;
  SceneDescription scene = still;
  scene.bodies[0].angular_velocity = {wobble * std::cos(lambda * t), wobble * std::sin(lambda * t), spin};
  // Up to the wobble, by which the axis is off 1e-4 rad at most.
  scene.bodies[0].orientation = {std::cos(0.5 * spin * t), 0.0, 0.0, std::sin(0.5 * spin * t)};
  return scene;
}

Finding examine(const Contestant& method, double angle) {
  constexpr double h = 1.0;
  SceneRun run;
  run.scene = assembled(body_at(0.0, angle));
  run.integrator = std::string(method.method->name);
  run.options = method.options_for("");
  run.step_size = h;
  run.steps = steps;
  run.exact = [=](double t) { return body_at(t, angle); };
  double transverse = 0.0, spin = 0.0;
  run.watch = [&](const WatchedState& s) {
    transverse = std::hypot(s.bodies[0].omega(0), s.bodies[0].omega(1));
    spin = s.bodies[0].omega(2);
  };
  const SceneRunEnd end = run_scene(run);
  Finding finding = finding_of(end);
  finding.what = "wobble, times the first";
  const auto grade_of = [](double factor) {
    return factor > 2.0 ? Grade::failed : factor < 0.5 ? Grade::degraded : Grade::survived;
  };
  if (method.chooses_steps()) {
    const double change = permitted_error(method, end.reached, 3) * (1.0 + wobble) / wobble;
    expect_by_tolerance(finding, change, 0.5, 1.0);
    finding.reason += " of the wobble; a step may turn by less than pi";
    finding.measured["steps"] = double(end.reached);
    finding.measured["largest_turn"] = angle * end.longest_step;
    if (finding.grade == Grade::failed) return finding;
    finding.amount = transverse / wobble;
    finding.severity = std::abs(std::log(*finding.amount));
    finding.measured["wobble_factor"] = *finding.amount;
    finding.measured["spin_error"] = std::abs(spin - angle);
    finding.grade = angle * end.longest_step < std::numbers::pi ? grade_of(*finding.amount) : Grade::failed;
    return finding;
  }
  // Variant "exact" and the Adams method take logarithms of k - 1 steps together, that about the new point of k.
  const bool exact = method.is("faltinsen_bdf") && method.options.choice("variant") == "exact";
  const int spanned = method.is("centred_bdf")                ? method.steps()
                      : exact || method.is("faltinsen_adams") ? std::max(1, method.steps() - 1)
                                                              : 1;
  const double logarithm = angle * spanned;
  if (angle >= std::numbers::pi) {
    // No method can: to say so is to survive, with any other outcome it does not.
    finding.grade = finding.outcome == Outcome::rotation_too_large ? Grade::survived : Grade::failed;
    finding.reason = "no step turns by pi or more: rotation_too_large is the answer";
    return finding;
  }
  // The largest coefficient of its factors.
  if (method.is("crouch_grossman") && angle * 24.0 / 17.0 >= std::numbers::pi) {
    finding.expected = Grade::failed;
    finding.reason = "its factors turn by up to 24/17 of the step, by pi or more";
    return finding;
  }
  if (logarithm >= std::numbers::pi) {
    finding.expected = Grade::failed;
    finding.reason = fmt::format("its logarithms span {} steps, which turn by pi or more", spanned);
    return finding;
  }
  if (method.is("faltinsen_adams")) {
    const double growth = adams_increment_radius(method.steps(), angle);
    finding.measured["increment_spectral_radius"] = growth;
    if (wobble / angle * std::pow(growth, double(steps)) > 1.0) {
      finding.expected = Grade::failed;
      finding.reason =
          fmt::format("disturbances of the increments across the axis grow by {:.4g} a step", growth);
      return finding;
    }
  }
  if (method.is("faltinsen_bdf") && !exact && method.steps() >= 3) {
    const double growth = truncation_spectral_radius(method.steps(), angle);
    finding.measured["truncation_spectral_radius"] = growth;
    if (wobble / angle * std::pow(growth, double(steps)) > 1.0) {
      finding.expected = Grade::failed;
      finding.reason = fmt::format("the truncated series let the increments grow by {:.4g} a step", growth);
      return finding;
    }
  }
  const double radius = velocity_spectral_radius(method, {0.0, (moment_ratio - 1.0) * angle});
  const double predicted = std::pow(radius, double(steps));
  finding.expected = grade_of(predicted);
  finding.reason =
      fmt::format("the wobble's spectral radius is {:.6f}: {:.3g} in {} steps", radius, predicted, steps);
  if (finding.grade == Grade::failed) return finding;
  finding.amount = transverse / wobble;
  finding.measured["wobble_factor"] = transverse / wobble;
  finding.measured["predicted_factor"] = predicted;
  finding.measured["spin_error"] = std::abs(spin - angle);
  finding.severity = std::abs(std::log(*finding.amount));
  finding.grade = grade_of(*finding.amount);
  return finding;
}

std::vector<Trial> trials() {
  std::vector<Trial> all;
  for (const double angle : {0.5, 1.0, 2.0, 3.0, std::numbers::pi, 4.0}) {
    const TrialMaker make = [&](const Contestant& method, const std::string&) -> std::optional<Trial> {
      Trial t;
      t.variant = method.chooses_steps() ? fmt::format("Omega = {:.3g} rad/s, 400 s", angle)
                                         : fmt::format("h |Omega| = {:.3g}", angle);
      t.parameters = {{"angle", angle}};
      t.run = [=, &method] { return examine(method, angle); };
      return t;
    };
    add_trials(all, unconstrained, make);
  }
  return all;
}

}  // namespace

}  // namespace large_rotations_case

StabilityCase large_rotations() {
  return {
      .name = "large_rotations",
      .title = "Large rotations a step",
      .question = "How far may a body turn in a step?",
      .criterion =
          "survived: the wobble of a free symmetric body is within a factor of 2 after 400 steps; degraded: "
          "damped by more; "
          "failed: grown by more, or ended. From pi on: survived where the outcome is rotation_too_large; of "
          "chosen steps: where each turns by less than pi, and the wobble as before",
      .theory =
          "the method on w' = i lambda w, which does not see the rotation itself; logarithms of less than pi",
      .trials = large_rotations_case::trials};
}

}  // namespace liebench
