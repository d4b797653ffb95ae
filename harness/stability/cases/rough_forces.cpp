#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/scene_reader.h"
#include "harness/stability/cases/cases.h"
#include "harness/stability/linear_theory.h"
#include "harness/stability/tolerance.h"

// Forces that change within a step: dry friction, impacts, a torque that jumps.

namespace liebench {

namespace rough_forces_case {

namespace {

constexpr double h = 1e-3;
// Five times those of the others.
constexpr std::uint64_t most_own_steps = 5'000;

enum class Rough { friction, contact, jump };

// Energies, J, of all states.
struct Course {
  double first = 0.0, least = 0.0, most = 0.0, last = 0.0;
  double of_tolerance = 0.0;
  SceneRunEnd end;
  Eigen::Vector3d omega = Eigen::Vector3d::Zero();
};

Finding follow(const SceneDescription& scene, const Contestant& method, const std::string& form, double step,
               double t_end, Course& course) {
  SceneRun run;
  run.scene = assembled(scene);
  run.integrator = std::string(method.method->name);
  run.options = method.options_for(form);
  run.step_size = step;
  run.steps = std::uint64_t(std::llround(t_end / step));
  run.every = 1;
  run.watch_own_steps = true;
  run.most_own_steps = most_own_steps;
  run.watch = [&](const WatchedState& s) {
    course.of_tolerance = std::max(course.of_tolerance, s.energy_of_tolerance);
    if (s.step == 0) course.first = course.least = course.most = s.energy;
    course.least = std::min(course.least, s.energy);
    course.most = std::max(course.most, s.energy);
    course.last = s.energy;
    course.omega = s.bodies[0].omega;
  };
  course.end = run_scene(run);
  Finding finding = finding_of(course.end);
  if (method.chooses_steps()) {
    finding.measured["steps"] = double(course.end.reached);
    finding.measured["shortest_step"] = course.end.shortest_step;
  }
  return finding;
}

// A jump of the force is in the past of k + 1 steps of a method of order k, and each may leave its tolerance's worth of
// velocity; where in its step a jump falls, the estimate does not know, by a factor of 2.
double permitted_by_jump(const Contestant& method, double rate) {
  const auto steps = std::uint64_t(method.order()) + 1;
  return 2.0 * permitted_error(method, steps, 6) * (1.0 + rate);
}

// A disc of 1 kg m^2 with 1 rad/s and a friction of 2 N m: at rest after half a second.
Finding friction(const Contestant& method, const std::string& form, double slip) {
  Json scene = parse_json(R"({"name": "disc",
    "bodies": [{"name": "disc", "mass": 2, "inertia": [0.6, 0.6, 1], "angular_velocity": [0, 0, 1]}],
    "joints": [{"name": "hinge", "type": "revolute", "bodies": ["ground", "disc"], "point": [0, 0, 0], "axis": [0, 0, 1]}]})",
                          "disc");
  scene["effects"] = {
      {{"type", "joint_friction"}, {"joint", "hinge"}, {"torque", 2.0}, {"slip_velocity", slip}}};
  Course course;
  Finding finding = follow(read_scene(scene), method, form, h, 1.0, course);
  finding.what = "rad/s left where it should rest";
  finding.reason =
      "the law is monotone: A-stable methods pass through it; tanh is flat outside its slip velocity";
  if (method.chooses_steps()) {
    finding.reason = "the law is monotone, and a step that Newton's iteration does not solve is made shorter";
    // Down to J v_s / T = v_s / 2 s, where half a second of rest takes 1 / v_s of them.
    if (1.0 / slip > double(most_own_steps)) {
      finding.at_worst = Grade::failed;
      finding.reason +=
          fmt::format(": it may take steps of {:.1g} s, of which there are too many", 0.5 * slip);
    }
  } else if (!method.can_be_safeguarded() && !explicit_in_forces(method) && slip < 0.1 * h) {
    finding.at_worst = Grade::failed;
    finding.reason += ", and an iteration without the safeguard jumps from one side of it to the other";
  }
  if (finding.grade == Grade::failed) return finding;
  const double left = std::abs(course.omega(2));
  finding.amount = left;
  finding.measured["rate"] = left;
  finding.measured["energy_gain"] = course.most / course.first - 1.0;
  // A step of the torque and the slip velocity are what it cannot resolve; or what a tolerance permits of the setting in.
  const double unresolved = method.chooses_steps() ? permitted_by_jump(method, slip) : 2.0 * h;
  if (!(left <= unresolved + slip)) finding.grade = left <= 1.0 ? Grade::degraded : Grade::failed;
  return finding;
}

// Of an impact in steps of h.
void expect_of_fixed_steps(const Contestant& method, double stiffness, double duration, Finding& finding) {
  finding.reason = fmt::format("the impact takes {:.2g} steps", duration / h);
  // What few steps resolve is a jump of the velocity for the method, and how high it comes back depends on where the jump falls.
  if (duration < 20.0 * h) finding.at_worst = Grade::degraded;
  if (explicit_in_forces(method)) {
    // It sees the ground when it is in it by up to v h, and takes the force there for all of the step.
    const double kick = stiffness * std::pow(3.13 * h, 1.5) * h / 3.13;
    finding.reason +=
        fmt::format("; an explicit step turns the force of v h into {:.2g} times the velocity", kick);
    if (kick > 1.0) finding.at_worst = Grade::failed;
    // While it lasts, the contact is a spring of half a period.
    const double growth = std::pow(spectral_radius(method, {0.0, 3.14 * h / duration}), duration / h);
    finding.measured["growth_in_contact"] = std::min(growth, 1e300);
    if (growth > 1.5) {
      finding.at_worst = Grade::failed;
      finding.reason += fmt::format("; as a spring the contact lets it grow by {:.3g}", growth);
    }
  } else if (!method.can_be_safeguarded() && duration < 20.0 * h) {
    finding.at_worst = Grade::failed;
    finding.reason += "; its iteration has no safeguard";
  }
}

// A ball dropped from half a metre on a stiff ground, without loss: it may come back with less, never with more.
Finding contact(const Contestant& method, const std::string&, double stiffness) {
  Json scene = parse_json(R"({"name": "ball",
    "bodies": [{"name": "ball", "mass": 1, "shape": {"type": "sphere", "radius": 0.1}, "position": [0, 0, 0.6]}],
    "effects": [{"type": "uniform_gravity", "acceleration": [0, 0, -9.81]}]})",
                          "ball");
  scene["effects"].push_back({{"type", "contact"},
                              {"body", "ball"},
                              {"radius", 0.1},
                              {"plane", {{"normal", {0, 0, 1}}}},
                              {"stiffness", stiffness},
                              {"exponent", 1.5}});
  Course course;
  Finding finding = follow(read_scene(scene), method, "", h, 1.0, course);
  finding.what = "energy, times the first, after bouncing";
  // 2.94 delta / v with the penetration delta = (5 m v^2 / (4 k))^(2/5) [Hertz], v = 3.13 m/s after half a metre.
  const double duration = 2.94 * std::pow(1.25 * 3.13 * 3.13 / stiffness, 0.4) / 3.13;
  finding.measured["contact_steps"] = duration / h;
  // From the ground up: 0.5 m of 9.81 N.
  constexpr double ground = 0.1 * 9.81;
  if (method.chooses_steps()) {
    expect_by_tolerance(
        finding, permitted_energy(method, course.end.reached, course.of_tolerance) / (course.first - ground),
        0.1, 99.0);
    finding.reason = fmt::format("the impact takes {:.2g} s, and is resolved; ", duration) + finding.reason;
  } else {
    expect_of_fixed_steps(method, stiffness, duration, finding);
  }
  if (finding.grade == Grade::failed) return finding;
  const double gain = (course.most - ground) / (course.first - ground);
  finding.amount = gain;
  finding.measured["largest_energy"] = gain;
  finding.measured["last_energy"] = (course.last - ground) / (course.first - ground);
  if (!(gain <= 1.1)) finding.grade = gain <= 100.0 ? Grade::degraded : Grade::failed;
  return finding;
}

// A torque of 1 N m that sets in at t = 0.30005 s, inside a step: the rate is that of the time since then.
Finding jump(const Contestant& method, const std::string& form, double) {
  Json scene = parse_json(R"({"name": "disc",
    "bodies": [{"name": "disc", "mass": 2, "inertia": [0.6, 0.6, 1]}],
    "joints": [{"name": "hinge", "type": "revolute", "bodies": ["ground", "disc"], "point": [0, 0, 0], "axis": [0, 0, 1]}],
    "effects": [{"type": "applied_force", "body": "disc", "torque": [0, 0, 1], "factor": {"expression": "t < 0.30005 ? 0 : 1"}}]})",
                          "disc");
  Course course;
  Finding finding = follow(read_scene(scene), method, form, h, 0.5, course);
  finding.what = "error of the rate, steps of the torque";
  finding.reason = "the jump is known to a step: order 1";
  if (finding.grade == Grade::failed) return finding;
  double error = std::abs(course.omega(2) - (0.5 - 0.30005)) / h;
  if (method.chooses_steps()) {
    const double rate = 0.5 - 0.30005;
    // Two of these units survive, as two steps do.
    error *= h / (0.5 * permitted_by_jump(method, rate));
    finding.what = "error of the rate, halves of the permitted";
    finding.reason = fmt::format("steps across the jump are rejected until it is worth {:.2g} rad/s",
                                 permitted_by_jump(method, rate));
  }
  finding.amount = error;
  finding.measured["error_in_steps"] = error;
  if (!(error <= 2.0)) finding.grade = error <= 20.0 ? Grade::degraded : Grade::failed;
  return finding;
}

std::vector<Trial> trials() {
  std::vector<Trial> all;
  const auto add = [&](const std::string& variant, const std::vector<std::string>& forms, double value,
                       Finding (*examine)(const Contestant&, const std::string&, double)) {
    const TrialMaker make = [&](const Contestant& method, const std::string& form) -> std::optional<Trial> {
      Trial t;
      t.variant = variant;
      t.parameters = {{"force", variant}, {"step_size", h}};
      t.work = 4.0;
      t.run = [=, &method] { return examine(method, form, value); };
      return t;
    };
    add_trials(all, forms, make);
  };
  for (const double slip : {1e-1, 1e-3, 1e-5, 1e-8})
    add(fmt::format("friction, slip velocity {} rad/s", slip), constrained_forms, slip, friction);
  for (const double stiffness : {1e4, 1e6, 1e8, 1e10})
    add(fmt::format("impact, {:.0e} N/m^1.5", stiffness), unconstrained, stiffness, contact);
  add("torque that jumps", constrained_forms, 0.0, jump);
  return all;
}

}  // namespace

}  // namespace rough_forces_case

StabilityCase rough_forces() {
  return {.name = "rough_forces",
          .title = "Rough forces",
          .question = "What do friction, impacts and jumps do to a step?",
          .criterion =
              "survived: at rest within a step's torque and the slip velocity; no more than a tenth of "
              "energy gained at an "
              "impact; a jump resolved to two "
              "steps; degraded: within 1 rad/s, a hundred times the energy, 20 steps; of chosen steps what "
              "the tolerance permits takes "
              "the place of steps",
          .theory = "order is lost where a force is rough; boundedness is not",
          .trials = rough_forces_case::trials};
}

}  // namespace liebench
