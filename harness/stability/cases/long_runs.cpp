#include <fmt/format.h>
#include <sys/resource.h>

#include <array>
#include <cmath>

#include "harness/scene_reader.h"
#include "harness/stability/cases/cases.h"
#include "harness/stability/growth.h"
#include "harness/stability/linear_theory.h"
#include "harness/stability/tolerance.h"

// Ten million steps of a slow top on its joint and of a free body. A method that chooses its steps goes as far in time, and its energy
// drifts by what its tolerance permits, in proportion to the time.

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
};
constexpr Motion top{"slow top", true, 1e-3};
constexpr Motion body{"free body", false, 5e-3};

// The frequency w of the mode that loses as much energy as the motion, w^4 = <|v''|^2> / <|v|^2> in the norm of the kinetic energy, over
// the first 20 s by differences, rad/s: a method whose error per step goes with theta^4 loses that of a sum of modes.
double frequency(const Motion& motion) {
  const auto found = [](const Motion& m) {
    SceneRun run;
    run.scene = scene(m.constrained);
    const Contestant method = contestant("bliedf2nd", {{"k", 4}});
    run.integrator = "bliedf2nd";
    run.options = method.options_for(m.constrained ? "index3" : "");
    run.step_size = m.step_size;
    run.steps = std::uint64_t(20.0 / m.step_size);
    run.every = 1;
    const BodyDescription& body = run.scene->scene.bodies[0];
    const Eigen::Vector3d moments = body.inertia.diagonal();
    std::array<Eigen::Matrix<double, 6, 1>, 3> last{};
    double curvature = 0.0, size = 0.0;
    run.watch = [&](const WatchedState& s) {
      last = {last[1], last[2], {}};
      last[2] << std::sqrt(body.mass) * s.bodies[0].u, moments.cwiseSqrt().cwiseProduct(s.bodies[0].omega);
      if (s.step < 2) return;
      curvature += (last[0] - 2.0 * last[1] + last[2]).squaredNorm() / std::pow(m.step_size, 4);
      size += last[1].squaredNorm();
    };
    run_scene(run);
    return std::pow(curvature / size, 0.25);
  };
  static const double of_top = found(top), of_body = found(body);
  return motion.constrained ? of_top : of_body;
}

Finding examine(const Motion& motion, const Contestant& method, const std::string& form,
                std::uint64_t steps) {
  std::vector<double> energy, momentum, position, velocity, group;
  double first_energy = 0.0, first_momentum = 0.0, kinetic = 0.0, of_tolerance = 0.0;
  SceneRun run;
  run.scene = scene(motion.constrained);
  run.integrator = std::string(method.method->name);
  run.options = method.options_for(form);
  run.step_size = motion.step_size;
  run.steps = steps;
  run.every = steps / samples;
  run.most_own_steps = steps;
  run.watch = [&](const WatchedState& s) {
    of_tolerance = std::max(of_tolerance, s.energy_of_tolerance);
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
  const SceneRunEnd end = run_scene(run);
  Finding finding = finding_of(end);
  finding.what = "energy, part of the motion's";
  // Less than seven bytes a step, with all else that the process does meanwhile. Not a number for the record, which is the same every
  // time.
  if (steps >= 10'000'000 && peak_memory() - before > 64 * 1024) {
    finding.grade = Grade::failed;
    finding.what = "memory grows";
  }
  if (weakly_unstable(method, form)) {
    finding.at_worst = Grade::failed;
    finding.reason = "rho_inf = 1: the multipliers of the index-3 form are weakly unstable";
  }
  if (finding.grade == Grade::failed) return finding;
  const double n = double(end.reached), mean_step = end.time / n;
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
  // A part of the energy that the motion has.
  constexpr double visible = 1e-2;
  // More than the motion has can only be gained.
  constexpr double all = 1.5;
  if (!(*finding.amount <= visible)) finding.grade = *finding.amount <= all ? Grade::degraded : Grade::failed;
  if (motion.constrained) {
    const GrowthLaw position_law = growth_law(position, eps), velocity_law = growth_law(velocity, eps);
    finding.measured["position_constraint"] = position_law.largest;
    finding.measured["position_constraint_exponent"] = position_law.exponent;
    finding.measured["velocity_constraint"] = velocity_law.largest;
    finding.measured["velocity_constraint_exponent"] = velocity_law.exponent;
    // Phi is solved for in every step to some units of its round-off, B v in the stabilized form to some of eps |x| / h.
    // Half-explicit methods solve for B v alone, and let Phi drift by their own error.
    if (!method.is("half_explicit") && !(position_law.largest <= 1000.0 * eps)) finding.grade = Grade::failed;
    if (form == "stabilized_index2" && !(velocity_law.largest <= 1000.0 * eps / mean_step))
      finding.grade = Grade::failed;
  }
  // Every product of the group adds some units of round-off.
  if (group_law.largest > 8.0 * eps * n) finding.grade = Grade::failed;

  if (method.chooses_steps()) {
    finding.measured["steps"] = n;
    expect_by_tolerance(finding, permitted_energy(method, end.reached, of_tolerance) / kinetic, visible, all);
    return finding;
  }
  const double w = frequency(motion);
  const double damping = -2.0 * n * std::log(spectral_radius(method, {0.0, motion.step_size * w}));
  finding.measured["predicted_energy"] = std::abs(damping);
  finding.expected = std::abs(damping) > visible ? Grade::degraded : Grade::survived;
  if (!weakly_unstable(method, form))
    finding.reason = fmt::format(
        "a mode of {:.3g} rad/s keeps exp({:.2g}) of its energy over {:.0e} steps by the linear theory", w,
        -damping, n);
  return finding;
}

std::vector<Trial> trials() {
  std::vector<Trial> all;
  for (const bool quick : {true, false})
    for (const Motion* motion : {&top, &body}) {
      const std::uint64_t steps = quick ? 100'000 : 10'000'000;
      const TrialMaker make = [&](const Contestant& method, const std::string& form) -> std::optional<Trial> {
        Trial t;
        t.variant = method.chooses_steps()
                        ? fmt::format("{}, {} s", motion->name, motion->step_size * double(steps))
                        : fmt::format("{}, {:.0e} steps", motion->name, double(steps));
        t.parameters = {{"motion", motion->name}, {"steps", steps}, {"step_size", motion->step_size}};
        t.quick = quick;
        t.work = double(steps) / 1000.0;
        t.run = [=, &method] { return examine(*motion, method, form, steps); };
        return t;
      };
      add_trials(all, motion->constrained ? constrained_forms : unconstrained, make);
    }
  return all;
}

}  // namespace

}  // namespace long_runs_case

StabilityCase long_runs() {
  return {
      .name = "long_runs",
      .title = "Long runs",
      .question = "Does anything drift away over ten million steps?",
      .criterion =
          "survived: the energy is within 1 % of what the motion has, the elements within 8 units of "
          "round-off a step of the "
          "group, Phi and, in the stabilized form, B v within some of theirs; degraded: the energy is "
          "not, but no more than all of it",
      .theory =
          "the growth of a mode of the motion by the spectral radius of the method on the imaginary axis; "
          "of chosen steps the sum of local errors within the tolerance",
      .trials = long_runs_case::trials};
}

}  // namespace liebench
