#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

#include "harness/scene_reader.h"
#include "harness/stability/cases/cases.h"
#include "harness/stability/tolerance.h"
#include "integrators/bdf_coefficients.h"
#include "integrators/radau_coefficients.h"

// The multipliers of the paper's top as h -> 0, in the index-3 form; the energy as a tolerance goes to round-off and below.

namespace liebench {

namespace small_steps_case {

namespace {

constexpr double eps = 0x1p-52;
constexpr double mass = 15.0;

std::shared_ptr<const AssembledScene> scene(bool constrained = true) {
  static const auto turning = assembled(read_scene(parse_json(R"({"name": "heavy top about its tip",
    "bodies": [{"name": "top", "formulation": "SO3", "fixed_point": [0, 0, 0], "mass": 15, "inertia": [0.234375, 0.46875, 0.234375],
                "position": [0, 1, 0], "angular_velocity": [0, 150, -4.61538]}],
    "effects": [{"type": "uniform_gravity", "acceleration": [0, 0, -9.81]}]})",
                                                              "heavy top about its tip")));
  if (!constrained) return turning;
  static const auto top = assembled(read_scene(parse_json(R"({"name": "heavy top",
    "bodies": [{"name": "top", "mass": 15, "inertia": [0.234375, 0.46875, 0.234375], "position": [0, 1, 0],
                "velocity": [4.61538, 0, 0], "angular_velocity": [0, 150, -4.61538]}],
    "joints": [{"name": "tip", "type": "spherical", "bodies": ["ground", "top"], "point": [0, 0, 0]}],
    "effects": [{"type": "uniform_gravity", "acceleration": [0, 0, -9.81]}]})",
                                                          "heavy top")));
  return top;
}

// What one unit of noise in Phi makes of v' h^2: the sums of the sizes of the coefficients of both differences.
double noise_gain(const Contestant& method, double h) {
  // The multipliers of half-explicit methods take the velocities alone: B v is known to eps |v|, and its change in a stage of
  // h / 20 and more gives them.
  if (method.is("half_explicit")) return 20.0 * 150.0 * h;
  // Phi at three points, over h^2.
  if (method.is("rattlie") || method.is("shakelie")) return 8.0;
  // v'_{n+1} = sum_j (d^2)_3j (Theta_j - Theta_n) / h^2 with the inverse d of a_ij: Phi at three stages and at t_n.
  if (method.is("radau")) {
    const auto d = RadauCoefficients<double>().inverse;
    double stages = 0.0, start = 0.0;
    for (std::size_t j = 0; j < d.size(); ++j) {
      const double twice = d[2][0] * d[0][j] + d[2][1] * d[1][j] + d[2][2] * d[2][j];
      stages += std::abs(twice);
      start += twice;
    }
    return stages + std::abs(start);
  }
  if (const auto rho = method.rho_inf()) {
    // a_{n+1} from the recursion d = beta h (a_{n+1} - a_n), v' by the filter with poles -rho_inf.
    const double beta = 1.0 / ((*rho + 1.0) * (*rho + 1.0));
    return 4.0 / beta / std::max(1.0 - *rho, 0.05);
  }
  const auto c = bdf_coefficients<double>(method.steps());
  double alpha = 0.0, gamma = 0.0;
  for (int i = 0; i <= method.steps(); ++i) alpha += std::abs(c.alpha[std::size_t(i)]);
  for (int i = 0; i < method.steps(); ++i) gamma += std::abs(c.gamma[std::size_t(i)]);
  return alpha * gamma * 2.0;
}

// The largest |lambda - lambda(q, v)| over the last half of the run.
std::pair<Finding, double> noise(const Contestant& method, const std::string& form, double h,
                                 std::uint64_t steps) {
  SceneRun run;
  run.scene = scene();
  run.integrator = std::string(method.method->name);
  run.options = method.options_for(form);
  run.step_size = h;
  run.steps = steps;
  run.every = 1;
  double largest = 0.0;
  run.watch = [&](const WatchedState& s) {
    if (2 * s.step >= steps)
      largest = std::max(largest, (s.multipliers - s.consistent_multipliers).cwiseAbs().maxCoeff());
  };
  Finding finding = finding_of(run_scene(run));
  return {finding, largest};
}

Finding examine(const Contestant& method, const std::string& form, double h) {
  constexpr std::uint64_t steps = 1000;
  auto [finding, largest] = noise(method, form, h, steps);
  finding.expected = Grade::survived;
  const double floor = noise_gain(method, h) * mass * eps / (h * h);
  // What the method itself leaves, from a step size where it is all.
  constexpr double coarse = 1e-4;
  double truncation = 0.0;
  if (h < coarse)
    truncation =
        noise(method, form, coarse, steps).second * std::pow(h / coarse, method.order_of_multipliers(form));
  finding.measured["lambda_error"] = largest;
  finding.measured["floor"] = floor;
  finding.measured["truncation"] = truncation;
  finding.what = "|lambda error| / predicted";
  finding.amount = largest / (floor + truncation);
  finding.reason =
      "Phi is known to eps |x|, and lambda to m eps |x| / h^2 times the coefficients of the method";
  if (weakly_unstable(method, form)) {
    finding.at_worst = Grade::failed;
    finding.reason = "rho_inf = 1: the multipliers of the index-3 form are weakly unstable";
  }
  if (finding.grade == Grade::survived && !(*finding.amount <= 4.0)) finding.grade = Grade::failed;
  return finding;
}

// In double, and with a constraint, the velocity of a step is known to some eps |q| / h (integrators/bliedf2nd_variable.h): below
// this tolerance no step need be accepted.
constexpr double least_constrained_tolerance = 1e-11;

Finding examine_tolerance(const Contestant& method, const std::string& form) {
  SceneRun run;
  run.scene = scene(!form.empty());
  run.integrator = std::string(method.method->name);
  run.options = method.options_for(form);
  run.step_size = 0.1;  // s: 15 rad
  run.steps = 1;
  run.watch_own_steps = true;
  run.most_own_steps = 20'000;
  double first = 0.0, largest = 0.0, of_tolerance = 0.0;
  run.watch = [&](const WatchedState& s) {
    if (s.step == 0) first = s.energy;
    largest = std::max(largest, std::abs(s.energy - first));
    of_tolerance = std::max(of_tolerance, s.energy_of_tolerance);
  };
  const SceneRunEnd end = run_scene(run);
  Finding finding = finding_of(end);
  finding.what = "energy error / permitted";
  finding.reason = "steps within the tolerance and some units of round-off";
  finding.measured["steps"] = double(end.reached);
  finding.measured["shortest_step"] = end.shortest_step;
  const double tolerance = method.tolerance().value();
  if (!form.empty() && tolerance < least_constrained_tolerance) {
    finding.at_worst = Grade::degraded;
    finding.reason += fmt::format("; below {} step_limit is an answer, too", least_constrained_tolerance);
    if (end.outcome == Outcome::step_limit) finding.grade = Grade::degraded;
  }
  if (finding.outcome != Outcome::ok) return finding;
  // A step rounds some eight times, as in long_runs.
  const double permitted =
      permitted_energy(method, end.reached, of_tolerance) * (1.0 + 8.0 * eps / tolerance);
  finding.amount = largest / permitted;
  finding.measured["energy"] = largest;
  finding.measured["permitted"] = permitted;
  if (!(*finding.amount <= 1.0)) finding.grade = Grade::failed;
  return finding;
}

// For the row of the smaller tolerance.
void add_tolerances(std::vector<Trial>& all) {
  static const std::vector<Contestant> tried = [] {
    std::vector<Contestant> list;
    for (const char* name : {"bliedf2nd_variable", "rkmk_variable"})
      for (const double tolerance : {1e-10, 1e-12, 1e-14, 1e-16})
        list.push_back(contestant(name, {{"tolerance", tolerance}}));
    return list;
  }();
  for (const Contestant& each : tried) {
    const TrialMaker make = [&](const Contestant& method, const std::string& form) -> std::optional<Trial> {
      if (method.method != each.method || *method.tolerance() > 1e-6) return std::nullopt;
      Trial t;
      t.contestant = &each;
      t.variant = fmt::format("tolerance {:.0e}", *each.tolerance());
      t.parameters = {{"tolerance", *each.tolerance()}};
      t.work = 30.0;
      t.run = [&each, form] { return examine_tolerance(each, form); };
      return t;
    };
    add_trials(all, {"", "index3", "stabilized_index2"}, make);
  }
}

std::vector<Trial> trials() {
  std::vector<Trial> all;
  add_tolerances(all);
  for (const double h : {1e-5, 1e-6, 1e-7}) {
    const TrialMaker make = [&](const Contestant& method, const std::string& form) -> std::optional<Trial> {
      // A tolerance gives steps and multipliers together: add_tolerances().
      if (method.chooses_steps()) return std::nullopt;
      Trial t;
      t.variant = fmt::format("h = {:.0e} s", h);
      t.parameters = {{"step_size", h}};
      t.work = 3.0;
      t.run = [=, &method] { return examine(method, form, h); };
      return t;
    };
    add_trials(all, constrained_forms, make);
  }
  return all;
}

}  // namespace

}  // namespace small_steps_case

StabilityCase small_steps() {
  return {.name = "small_steps",
          .title = "Small steps",
          .question = "Do the multipliers keep their digits as h goes to 1e-7 s?",
          .criterion =
              "survived: the error of lambda is within 4 times round-off's floor m eps |x| c / h^2 and the "
              "method's own error; of chosen steps: that of the energy within the tolerance and round-off; "
              "degraded: "
              "step_limit below what a constraint leaves of the velocity",
          .theory = "the condition of the scaled system does not depend on h; Phi is known to eps |x|",
          .trials = small_steps_case::trials};
}

}  // namespace liebench
