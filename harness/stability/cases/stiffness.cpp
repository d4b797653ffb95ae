#include <fmt/format.h>

#include <cmath>
#include <complex>

#include "harness/scene_reader.h"
#include "harness/stability/cases/cases.h"
#include "harness/stability/linear_theory.h"
#include "harness/stability/tolerance.h"

// A torsional spring from soft to stiff at one step size: a disc on a hinge, from the exact motion. A method that chooses its steps is
// asked what they cost: as many as its tolerance takes to follow what is left of the oscillation, and an explicit one
// those of its bound of stability after that.

namespace liebench {

namespace stiffness_case {

namespace {

constexpr double moment = 1.0;      // kg m^2
constexpr double h = 1e-3;          // s
constexpr double amplitude = 1e-3;  // rad
constexpr std::uint64_t steps = 1000;

// A hinge with a torsional spring, or no joint and a bushing: the same oscillation.
SceneDescription disc(bool constrained, double stiffness, double damping) {
  Json scene = parse_json(
      R"({"name": "disc", "bodies": [{"name": "disc", "mass": 2, "inertia": [0.6, 0.6, 1]}]})", "disc");
  if (constrained) {
    scene["joints"] = parse_json(
        R"([{"name": "hinge", "type": "revolute", "bodies": ["ground", "disc"], "point": [0, 0, 0], "axis": [0, 0, 1]}])",
        "");
    scene["effects"] = {
        {{"type", "torsional_spring"}, {"joint", "hinge"}, {"stiffness", stiffness}, {"damping", damping}}};
  } else {
    const std::vector<double> none(3, 0.0), k{stiffness, stiffness, stiffness}, d{damping, damping, damping};
    scene["effects"] = {{{"type", "bushing"},
                         {"bodies", {"ground", "disc"}},
                         {"point", {0, 0, 0}},
                         {"stiffness", none},
                         {"rotational_stiffness", k},
                         {"rotational_damping", d}}};
  }
  return read_scene(scene);
}

// phi'' = -(K phi + D phi') / J: exp(mu t) and its conjugate, or two real ones.
std::complex<double> root(double stiffness, double damping) {
  const double a = damping / (2.0 * moment), b = stiffness / moment - a * a;
  return b >= 0.0 ? std::complex<double>(-a, std::sqrt(b)) : std::complex<double>(-a - std::sqrt(-b), 0.0);
}

struct Angle {
  double phi, rate;
};
Angle angle_at(double t, double stiffness, double damping) {
  const double a = damping / (2.0 * moment), b = stiffness / moment - a * a;
  if (b > 0.0) {
    const double w = std::sqrt(b), decay = amplitude * std::exp(-a * t);
    // phi(0) = amplitude, phi'(0) = -a amplitude
    return {decay * std::cos(w * t), decay * (-a * std::cos(w * t) - w * std::sin(w * t))};
  }
  const double s = -a + std::sqrt(-b);
  return {amplitude * std::exp(s * t), amplitude * s * std::exp(s * t)};
}

Finding examine(const Contestant& method, const std::string& form, double stiffness, double damping) {
  SceneRun run;
  const SceneDescription at_rest = disc(!form.empty(), stiffness, damping);
  const auto at = [=](double t) {
    SceneDescription scene = at_rest;
    const Angle angle = angle_at(t, stiffness, damping);
    scene.bodies[0].orientation = {std::cos(0.5 * angle.phi), 0.0, 0.0, std::sin(0.5 * angle.phi)};
    scene.bodies[0].angular_velocity = {0.0, 0.0, angle.rate};
    return scene;
  };
  AssembledScene moved = *assembled(at_rest);
  moved.scene = at(0.0);
  run.scene = std::make_shared<AssembledScene>(moved);
  run.integrator = std::string(method.method->name);
  run.options = method.options_for(form);
  run.step_size = h;
  run.steps = steps;
  run.exact = at;
  double energy = 0.0;
  run.watch = [&](const WatchedState& s) { energy = s.energy; };
  Finding finding = finding_of(run_scene(run));
  const double first = 0.5 * stiffness * amplitude * amplitude;
  const std::complex<double> z = h * root(stiffness, damping);
  const double radius = spectral_radius(method, z);
  finding.what = "amplitude, times the first";
  // Of the amplitude.
  constexpr double grown = 2.0, kept = 0.5;
  // What has died out in the exact motion, too, cannot be damped too much.
  constexpr double died_out = 1e-12;
  const double growth = std::pow(radius, double(steps)), exact = std::exp(z.real() * double(steps));
  finding.measured["spectral_radius"] = radius;
  finding.measured["h_omega"] = std::abs(z);
  finding.expected = growth > grown                              ? Grade::failed
                     : exact > died_out && growth < kept * exact ? Grade::degraded
                                                                 : Grade::survived;
  finding.reason =
      fmt::format("z = h mu = {:.3g}{:+.3g}i has the spectral radius {:.4g}", z.real(), z.imag(), radius);
  // v_1 = h ((1 - gamma) a_0 + gamma a_1), and with D' = 0 what is left of it is about h a_0 / 4 for rho_inf = 0, h a_0 (1 - gamma) at most.
  const double first_turn = h * h * std::norm(root(stiffness, damping)) * amplitude;
  if ((method.rho_inf() || method.is("newmark")) && first_turn > 1.0) {
    finding.at_worst = Grade::failed;
    finding.reason += fmt::format(
        "; but a_0 is a state of the method, and h a_0 of velocity turns by h^2 a_0 = {:.2g} rad a step",
        first_turn);
  }
  // Without a safeguard the iteration may turn too far on its way to the solution.
  if ((method.is("radau") || method.is("gauss")) && first_turn > 1.0) {
    finding.at_worst = Grade::failed;
    finding.reason +=
        fmt::format("; but h^2 v'_0 is a turn of {:.2g} rad, where the iteration begins", first_turn);
  }
  if (finding.grade == Grade::failed) return finding;
  const double factor = std::sqrt(energy / first);
  finding.measured["amplitude"] = factor;
  finding.amount = factor;
  finding.severity = std::abs(std::log(factor));
  finding.grade = !(factor <= grown)                          ? Grade::failed
                  : exact > died_out && factor < kept * exact ? Grade::degraded
                                                              : Grade::survived;
  return finding;
}

// From a whole radian: below it an absolute tolerance of theta says less and less of the motion.
Finding examine_own_steps(const Contestant& method, const std::string& form, double stiffness,
                          double damping) {
  constexpr double start = 1.0;  // rad
  const std::complex<double> mu = root(stiffness, damping);
  // Errors that nothing damps add up: some sixteen periods of an undamped spring.
  const double length = damping == 0.0 ? std::min(1.0, 100.0 / std::abs(mu)) : 1.0;
  AssembledScene moved = *assembled(disc(!form.empty(), stiffness, damping));
  BodyDescription& body = moved.scene.bodies[0];
  body.orientation = {std::cos(0.5 * start), 0.0, 0.0, std::sin(0.5 * start)};
  body.angular_velocity = {0.0, 0.0, start * (damping == 0.0 ? 0.0 : mu.real())};
  SceneRun run;
  run.scene = std::make_shared<AssembledScene>(moved);
  run.integrator = std::string(method.method->name);
  run.options = method.options_for(form);
  run.step_size = length;
  run.steps = 1;
  constexpr double factor = 3.0;
  const double predicted = steps_for_oscillation(method, mu, start, length, 6);
  run.most_own_steps = std::uint64_t(10.0 * factor * predicted);
  double energy = 0.0;
  run.watch = [&](const WatchedState& s) { energy = s.energy; };
  const SceneRunEnd end = run_scene(run);
  Finding finding = finding_of(end);
  finding.what = "steps, times the predicted";
  finding.measured["h_omega"] = std::abs(mu) * length / double(std::max<std::uint64_t>(1, end.reached));
  finding.measured["steps"] = double(end.reached);
  finding.measured["predicted_steps"] = predicted;
  const double stable = stable_step(method, mu);
  finding.reason =
      fmt::format("the tolerance{} {:.2g} steps",
                  std::isfinite(stable) ? fmt::format(" and stability up to |z| = {:.2g} ask for", stable)
                                        : std::string(" asks for"),
                  predicted);
  if (finding.grade == Grade::failed) return finding;
  finding.amount = double(end.reached) / predicted;
  const double left = std::sqrt(energy / (0.5 * stiffness * start * start));
  const double exact = std::exp(mu.real() * length), radians = std::abs(mu) * length;
  // Errors last for as many steps as a damped motion keeps of them.
  const double ratio = -mu.real() / std::abs(mu);
  const double lasting = std::min(1.0, 1.0 / (ratio * radians)) * double(end.reached) + 1.0;
  const double rate = std::abs(mu) * start;
  const double permitted = permitted_error(method, std::uint64_t(std::ceil(lasting)), 6) *
                           std::hypot(1.0 / start, (1.0 + rate * exact) / rate);
  finding.measured["amplitude"] = left;
  finding.measured["permitted"] = permitted;
  finding.grade = !(left <= 2.0 * exact + permitted)          ? Grade::failed
                  : left < 0.5 * exact - permitted            ? Grade::degraded
                  : double(end.reached) <= factor * predicted ? Grade::survived
                                                              : Grade::degraded;
  return finding;
}

struct Damping {
  double ratio;
  std::string_view words;
};

std::vector<Trial> trials() {
  std::vector<Trial> all;
  std::vector<std::string> forms = unconstrained;
  forms.insert(forms.end(), constrained_forms.begin(), constrained_forms.end());
  // Damping ratios: none, a hundredth, critical.
  const std::vector<Damping> dampings{
      {0.0, "undamped"}, {0.01, "lightly damped"}, {1.0, "critically damped"}};
  for (const double stiffness : {1e2, 1e4, 1e6, 1e8, 1e10, 1e12})
    for (const Damping& damped : dampings) {
      const TrialMaker make = [&](const Contestant& method, const std::string& form) -> std::optional<Trial> {
        const double damping = 2.0 * damped.ratio * std::sqrt(stiffness * moment);
        Trial t;
        t.variant = fmt::format("{:.0e} N m/rad, {}", stiffness, damped.words);
        t.parameters = {{"stiffness", stiffness}, {"damping_ratio", damped.ratio}};
        t.quick = damped.ratio != 0.01;
        t.run = [=, &method] {
          return method.chooses_steps() ? examine_own_steps(method, form, stiffness, damping)
                                        : examine(method, form, stiffness, damping);
        };
        return t;
      };
      add_trials(all, forms, make);
    }
  return all;
}

}  // namespace

}  // namespace stiffness_case

StabilityCase stiffness() {
  return {.name = "stiffness",
          .title = "Stiff spring",
          .question = "From which stiffness on does a spring ruin the motion at h = 1 ms?",
          .criterion =
              "survived: the amplitude is within a factor of 2 of the exact one after 1000 steps; degraded: "
              "damped by more; failed: "
              "grown by more, or ended; of chosen steps the same up to what the tolerance permits, and no "
              "more than three "
              "times as many steps as predicted",
          .theory =
              "the spectral radius of the method at z = h mu: A(alpha)-stability, 90, 90, 86, 73, 52, 18 "
              "degrees for k = 1, ..., 6",
          .trials = stiffness_case::trials};
}

}  // namespace liebench
