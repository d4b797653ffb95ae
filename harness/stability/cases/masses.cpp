#include <fmt/format.h>

#include <cmath>

#include "harness/scene_reader.h"
#include "harness/stability/cases/cases.h"
#include "harness/stability/linear_theory.h"
#include "harness/stability/tolerance.h"
#include "problems/scene_examples.h"

// Masses and moments of inertia of very different sizes, and a very fast disc.

namespace liebench {

namespace masses_case {

namespace {

// A hundred times those of the others.
constexpr std::uint64_t most_own_steps = 50'000;

struct Plan {
  SceneDescription scene;
  double step_size;
  std::uint64_t steps;
  double energy;     // that the motion exchanges, J
  double frequency;  // the fastest of the motion, rad/s
  std::string reason;
  double tension_ratio = 0.0;  // of a chain: the last mass by the others
  double precession = 0.0;     // of a spinning disc, rad/s
  double condition = 1.0;      // the largest by the smallest mass or moment
};

// log10 of the most that a transverse vibration of the light rods grows by, while the chain falls from the horizontal as a pendulum of
// 2.5 m: w^2 = 3 T / (m L), T = 3 M g sin(phi).
double vibration_growth(const Contestant& method, double ratio, double h, std::uint64_t steps) {
  constexpr double gravity = 9.81, length = 2.5;
  double phi = 0.0, rate = 0.0, sum = 0.0, most = 0.0;
  for (std::uint64_t n = 0; n < steps; ++n) {
    rate += h * gravity / length * std::cos(phi);
    phi += h * rate;
    sum += std::log10(spectral_radius(method, {0.0, h * std::sqrt(9.0 * ratio * gravity * std::sin(phi))}));
    most = std::max(most, sum);
  }
  return most;
}

// With steps by a tolerance. The vibrations of the light rods are followed, or damped, or they are too many to be followed.
void expect_of_own_steps(const Plan& plan, const SceneRunEnd& end, double permitted, Finding& finding) {
  expect_by_tolerance(finding, permitted, 1e-2, 1.0);
  finding.measured["steps"] = double(end.reached);
  if (!plan.reason.empty()) finding.reason += "; " + plan.reason;
  if (plan.tension_ratio > 0.0) {
    // As in vibration_growth(), at the end.
    const double frequency = std::sqrt(9.0 * plan.tension_ratio * 9.81);
    const double radians = frequency * plan.step_size * double(plan.steps);
    finding.reason +=
        fmt::format("; its light rods vibrate by {:.2g} rad, k = 3, 4 are not stable in them", radians);
    // Of ten steps a radian.
    if (10.0 * radians > double(most_own_steps)) finding.at_worst = Grade::failed;
  }
  if (plan.condition > 1e8) {
    finding.at_worst = Grade::failed;
    finding.reason += fmt::format(
        "; masses of a ratio of {:.0e} leave residuals that the plain iteration takes for unsolved",
        plan.condition);
  }
}

Finding examine(const Plan& plan, const Contestant& method, const std::string& form) {
  SceneRun run;
  run.scene = assembled(plan.scene);
  run.integrator = std::string(method.method->name);
  run.options = method.options_for(form);
  run.step_size = plan.step_size;
  run.steps = plan.steps;
  run.every = std::max<std::uint64_t>(1, plan.steps / 100);
  run.most_own_steps = most_own_steps;
  double first = 0.0, largest = 0.0, constraint = 0.0, turned = 0.0, of_tolerance = 0.0;
  run.watch = [&](const WatchedState& s) {
    of_tolerance = std::max(of_tolerance, s.energy_of_tolerance);
    turned = std::atan2(s.bodies[0].x(1), s.bodies[0].x(0));
    if (s.step == 0) first = s.energy;
    largest = std::max(largest, std::abs(s.energy - first));
    constraint = std::max(constraint, s.position_constraint);
  };
  const SceneRunEnd end = run_scene(run);
  Finding finding = finding_of(end);
  finding.what = "energy, part of what the motion exchanges";
  if (method.chooses_steps()) {
    // The disc precesses by less than a tolerance is about: its axis is to be where it should be as far as that goes.
    const double permitted = plan.precession != 0.0
                                 ? permitted_error(method, end.reached, 6)
                                 : permitted_energy(method, end.reached, of_tolerance) / plan.energy;
    expect_of_own_steps(plan, end, permitted, finding);
    if (finding.grade == Grade::failed) return finding;
    finding.measured["position_constraint"] = constraint;
    if (plan.precession != 0.0) {
      finding.at_worst = Grade::survived;
      finding.what = "error of the precession, times the permitted";
      finding.amount = std::abs(turned - plan.precession * end.time) / permitted;
      if (!(*finding.amount <= 1.0)) finding.grade = Grade::failed;
      return finding;
    }
    finding.amount = largest / plan.energy;
    finding.measured["energy"] = *finding.amount;
    if (!(*finding.amount <= 1e-2)) finding.grade = *finding.amount <= 1.0 ? Grade::degraded : Grade::failed;
    return finding;
  }
  const double damping =
      -2.0 * double(plan.steps) * std::log(spectral_radius(method, {0.0, plan.step_size * plan.frequency}));
  if (std::abs(damping) > 1e-2) finding.expected = Grade::degraded;
  finding.reason = plan.reason;
  if (plan.tension_ratio > 0.0) {
    const double growth = vibration_growth(method, plan.tension_ratio, plan.step_size, plan.steps);
    finding.measured["vibration_growth"] = growth;
    finding.reason =
        fmt::format("vibrations of the light rods under tension grow by 10^{:.2g} at most", growth);
    // They begin with a thousandth or less of the motion.
    // How far they go beyond what linear theory is about, it does not say.
    if (growth > 30.0) finding.expected = Grade::degraded;
    if (growth > 1.0) finding.at_worst = Grade::failed;
    if (method.rho_inf() >= 0.9 && form == "index3" && plan.tension_ratio >= 1e6) {
      finding.at_worst = Grade::degraded;
      finding.reason =
          "the tension grows by a tenth a step at first, as much as rho_inf damps: frozen coefficients say "
          "nothing";
    }
  }
  if (!method.can_be_safeguarded() && !method.chooses_steps() && !method.is("half_explicit") &&
      plan.condition > 1e8) {
    finding.at_worst = Grade::failed;
    finding.reason += fmt::format(
        "; masses of a ratio of {:.0e} leave residuals that the plain iteration takes for unsolved",
        plan.condition);
  }
  if (method.order() == 1) {
    finding.at_worst = Grade::degraded;
    finding.reason += "; order 1 damps every motion";
  }
  if (weakly_unstable(method, form)) {
    finding.at_worst = Grade::failed;
    finding.reason = "rho_inf = 1: the multipliers of the index-3 form are weakly unstable";
  }
  if (finding.grade == Grade::failed) return finding;
  finding.measured["position_constraint"] = constraint;
  if (plan.precession != 0.0) {
    finding.what = "error of the precession, part of it";
    finding.amount = std::abs(turned / (plan.precession * plan.step_size * double(plan.steps)) - 1.0);
    finding.measured["precession_error"] = *finding.amount;
  } else {
    finding.amount = largest / plan.energy;
    finding.measured["energy"] = *finding.amount;
  }
  if (!(*finding.amount <= 1e-2)) finding.grade = *finding.amount <= 1.0 ? Grade::degraded : Grade::failed;
  return finding;
}

// Three rods of a metre, the last `ratio` times as heavy as the others.
Plan heavy_end(double ratio) {
  Plan plan{chain(3), 1e-3, 500, 9.81 * ratio, 1.0, "", ratio};
  BodyDescription& last = plan.scene.bodies.back();
  plan.condition = ratio;
  last.mass = ratio;
  last.inertia *= ratio;
  auto& weights = std::get<std::vector<Placed<UniformGravity<double>>>>(plan.scene.effects);
  weights.back().effect = UniformGravity<double>{ratio, {0.0, 0.0, -9.81}};
  return plan;
}

Plan thin_rod() {
  Plan plan{chain(1), 1e-3, 2000, 4.905, 6.0, "nothing divides by the axial moment but its own equation"};
  plan.scene.bodies[0].inertia = Eigen::Vector3d(1e-12, 1.0 / 12.0, 1.0 / 12.0).asDiagonal();
  plan.scene.bodies[0].angular_velocity = {10.0, 0.0, 0.0};
  plan.condition = 1e12;
  return plan;
}

// Its axis level and 0.1 m from the tip to its centre, let go from rest: it nods by 0.3 % of the angle that it precesses by in 1 ms,
// m g l t / (J_3 Omega).
Plan fast_disc() {
  const Json scene = parse_json(R"({"name": "disc",
    "bodies": [{"name": "disc", "mass": 1, "inertia": [0.0025, 0.0025, 0.005], "position": [0.1, 0, 0],
                "rotation": {"axis": [0, 1, 0], "angle": 1.5707963267948966}, "angular_velocity": [0, 0, 1e6]}],
    "joints": [{"name": "tip", "type": "spherical", "bodies": ["ground", "disc"], "point": [0, 0, 0]}],
    "effects": [{"type": "uniform_gravity", "acceleration": [0, 0, -9.81]}]})",
                                "");
  Plan plan{read_scene(scene), 1e-7, 10'000, 1.0, 0.0, "h |Omega| = 0.1, and h w = 0.04 for the nutation"};
  plan.precession = 9.81 * 0.1 / (0.005 * 1e6);
  return plan;
}

std::vector<Trial> trials() {
  std::vector<Trial> all;
  const auto add = [&](const std::string& variant, const Plan& made) {
    const auto plan = std::make_shared<const Plan>(made);
    {
      const TrialMaker make = [&](const Contestant& method, const std::string& form) -> std::optional<Trial> {
        Trial t;
        t.variant = variant;
        t.parameters = {{"scene", variant}, {"step_size", plan->step_size}, {"steps", plan->steps}};
        t.work = 3.0 * double(plan->steps) / 1000.0;
        t.run = [=, &method] { return examine(*plan, method, form); };
        return t;
      };
      add_trials(all, constrained_forms, make);
    }
  };
  for (const double ratio : {1.0, 1e3, 1e6, 1e9})
    add(fmt::format("chain, last mass x {:.0e}", ratio), heavy_end(ratio));
  add("rod, axial moment 1e-12", thin_rod());
  add("disc at 1e6 rad/s", fast_disc());
  return all;
}

}  // namespace

}  // namespace masses_case

StabilityCase masses() {
  return {.name = "masses",
          .title = "Masses, inertias",
          .question = "Do extreme ratios of masses and moments, or extreme spins, hurt?",
          .criterion =
              "survived: the energy is within 1 % of what the motion exchanges, the precession of the disc "
              "within 1 %; degraded: within all of it",
          .theory =
              "vibrations of light rods under tension grow by the spectral radius on the imaginary axis; "
              "elsewhere nothing but rounding is in the way",
          .trials = masses_case::trials};
}

}  // namespace liebench
