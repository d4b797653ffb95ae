#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>

#include "harness/scene_reader.h"
#include "harness/stability/cases/cases.h"
#include "harness/stability/growth.h"

// Ten million steps of a slow top on its joint and of a free body.

namespace liebench {

namespace long_runs_case {

namespace {

constexpr std::uint64_t samples = 500;
constexpr double eps = 0x1p-52;

std::shared_ptr<const AssembledScene> scene(bool constrained) {
  static const auto top = assembled(read_scene(parse_json(R"({"name": "slow top",
    "bodies": [{"name": "top", "mass": 15, "inertia": [0.234375, 0.46875, 0.234375], "position": [0, 1, 0],
                "velocity": [0.0461538, 0, 0], "angular_velocity": [0, 1.5, -0.0461538]}],
    "joints": [{"name": "tip", "type": "spherical", "bodies": ["ground", "top"], "point": [0, 0, 0]}],
    "effects": [{"type": "uniform_gravity", "acceleration": [0, 0, -9.81]}]})",
                                                          "slow top")));
  static const auto body = assembled(read_scene(parse_json(R"({"name": "free body",
    "bodies": [{"name": "body", "formulation": "SO3", "fixed_point": [0, 0, 0], "mass": 1, "inertia": [1, 2, 2.5],
                "angular_velocity": [0.3, 1, 2]}]})",
                                                           "free body")));
  return constrained ? top : body;
}

// Of the process, kB.
long peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

struct Motion {
  std::string_view name;
  bool constrained;
  double step_size;
  double frequency;  // the fastest that carries energy, rad/s
};
// The swing of the top has a period of 1.9 s; its third harmonic counts, too. The transverse components of the body's angular velocity
// turn with sqrt((J3 - J1)(J3 - J2) / (J1 J2)) Omega_3, the body itself with 2.3 rad/s.
constexpr Motion top{"slow top", true, 1e-3, 10.0};
constexpr Motion body{"free body", false, 5e-3, 2.5};

Finding examine(const Motion& motion, const Contestant& method, const std::string& form,
                std::uint64_t steps) {
  std::vector<double> energy, momentum, position, velocity, group;
  double first_energy = 0.0, first_momentum = 0.0, kinetic = 0.0;
  SceneRun run;
  run.scene = scene(motion.constrained);
  run.integrator = std::string(method.method->name);
  run.options = method.options_for(form);
  run.step_size = motion.step_size;
  run.steps = steps;
  run.every = steps / samples;
  run.watch = [&](const WatchedState& s) {
    if (s.step == 0) {
      first_energy = s.energy;
      first_momentum = s.angular_momentum;
      return;
    }
    energy.push_back(std::abs(s.energy - first_energy));
    momentum.push_back(std::abs(s.angular_momentum - first_momentum));
    position.push_back(s.position_constraint);
    velocity.push_back(s.velocity_constraint);
    group.push_back(s.group);
  };
  // Between highest and lowest place of the top; all of the free body.
  kinetic = motion.constrained ? 15.0 * 9.81 : 0.5 * (0.09 + 2.0 + 2.5 * 4.0);
  const long before = peak_memory();
  Finding finding = finding_of(run_scene(run));
  finding.what = "energy, part of the motion's";
  // Less than seven bytes a step; other trials run beside this one. Not a number for the record, which is the same every time.
  if (peak_memory() - before > 64 * 1024) {
    finding.grade = Grade::failed;
    finding.what = "memory grows";
  }
  if (weakly_unstable(method, form)) {
    finding.at_worst = Grade::failed;
    finding.reason = "rho_inf = 1: the multipliers of the index-3 form are weakly unstable";
  }
  if (finding.grade == Grade::failed) return finding;
  const double n = double(steps);
  const GrowthLaw energy_law = growth_law(energy, eps * kinetic);
  finding.measured["energy"] = energy_law.largest / kinetic;
  finding.measured["energy_exponent"] = energy_law.exponent;
  const GrowthLaw momentum_law = growth_law(momentum, eps);
  finding.measured["angular_momentum"] = momentum_law.largest;
  finding.measured["angular_momentum_exponent"] = momentum_law.exponent;
  const GrowthLaw group_law = growth_law(group, eps);
  finding.measured["group"] = group_law.largest;
  finding.measured["group_exponent"] = group_law.exponent;
  finding.amount = energy_law.largest / kinetic;
  if (motion.constrained) {
    const GrowthLaw position_law = growth_law(position, eps), velocity_law = growth_law(velocity, eps);
    finding.measured["position_constraint"] = position_law.largest;
    finding.measured["position_constraint_exponent"] = position_law.exponent;
    finding.measured["velocity_constraint"] = velocity_law.largest;
    finding.measured["velocity_constraint_exponent"] = velocity_law.exponent;
  }
  // A part of the energy that the motion has.
  constexpr double visible = 1e-2;
  if (!(*finding.amount <= visible)) finding.grade = Grade::degraded;
  // Every product of the group adds some units of round-off.
  if (group_law.largest > 8.0 * eps * n) finding.grade = Grade::failed;

  const double damping =
      -2.0 * n * std::log(spectral_radius(method, {0.0, motion.step_size * motion.frequency}));
  finding.measured["predicted_energy"] = std::abs(damping);
  finding.expected = std::abs(damping) > visible ? Grade::degraded : Grade::survived;
  if (!weakly_unstable(method, form))
    finding.reason = fmt::format(
        "a mode of {} rad/s keeps exp({:.2g}) of its energy over {:.0e} steps by the linear theory",
        motion.frequency, -damping, n);
  return finding;
}

std::vector<Trial> trials() {
  std::vector<Trial> all;
  for (const bool quick : {true, false})
    for (const Motion* motion : {&top, &body}) {
      const std::uint64_t steps = quick ? 100'000 : 10'000'000;
      for (
          Trial& trial : trials_of(
              motion->constrained ? constrained_forms : unconstrained,
              [&](const Contestant&method, const std::string&form) -> std::optional<Trial> {
                Trial t;
                t.variant = fmt::format("{}, {:.0e} steps", motion->name, double(steps));
                t.parameters = {{"motion", motion->name}, {"steps", steps}, {"step_size", motion->step_size}};
                t.quick = quick;
                t.work = double(steps) / 1000.0;
                t.run = [=, &method] { return examine(*motion, method, form, steps); };
                return t;
              }))
        all.push_back(std::move(trial));
    }
  return all;
}

}  // namespace

}  // namespace long_runs_case

StabilityCase long_runs() {
  return {.name = "long_runs",
          .title = "Long runs",
          .question = "Does anything drift away over ten million steps?",
          .criterion =
              "survived: the energy is within 1 % of what the motion has, the elements within 8 units of "
              "round-off a step of the "
              "group; degraded: the energy is not",
          .theory =
              "the growth of a mode of the motion by the spectral radius of the method on the imaginary axis",
          .trials = long_runs_case::trials};
}

}  // namespace liebench
