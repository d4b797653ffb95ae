#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "harness/scene_reader.h"
#include "harness/stability/cases/cases.h"

// Runs at the edge of what a run is: an outcome each time, and never a NaN in one that is called ok.

namespace liebench {

namespace degenerate_runs_case {

namespace {

std::shared_ptr<const AssembledScene> pendulum(const std::string& factor, bool constrained) {
  Json scene = parse_json(R"({"name": "pendulum",
    "bodies": [{"name": "rod", "mass": 1, "inertia": [0.01, 0.0833333, 0.0833333], "position": [0.5, 0, 0]}],
    "joints": [{"name": "hinge", "type": "revolute", "bodies": ["ground", "rod"], "point": [0, 0, 0], "axis": [0, 1, 0]}],
    "effects": [{"type": "uniform_gravity", "acceleration": [0, 0, -9.81]}]})",
                          "pendulum");
  // As a body with a fixed point, for methods without multipliers.
  if (!constrained) {
    scene.erase("joints");
    scene["bodies"][0]["formulation"] = "SO3";
    scene["bodies"][0]["fixed_point"] = {0, 0, 0};
  }
  if (!factor.empty())
    scene["effects"].push_back({{"type", "applied_force"},
                                {"body", "rod"},
                                {"torque", {0, 1, 0}},
                                {"factor", {{"expression", factor}}}});
  return assembled(read_scene(scene));
}

struct Plan {
  const char* variant;
  double step_size;
  std::uint64_t steps;
  const char* factor;  // of a torque; "" without
  bool possible;       // to take these steps at all
  std::uint64_t last;  // of those that are not, the last that is
  const char* reason;
  // Of a method that chooses its steps: in place of its own tolerance.
  std::optional<double> tolerance = {};
};

// A method that chooses its steps goes as near to the end of a force as 1e-12 of the interval, below which it makes no step any
// shorter; it comes there by steps of a fifth or a quarter. No more of them than a step limit, whatever is asked for.
constexpr std::uint64_t most_own_steps = 20'000;
constexpr double shortest_part = 1e-12;

Finding examine_own_steps(const Plan& plan, const SceneRunEnd& end, double energy_error, Finding finding) {
  const double length = plan.step_size * double(plan.steps), ends = plan.step_size * double(plan.last + 1);
  finding.measured["steps"] = double(end.reached);
  if (plan.possible) {
    if (finding.grade != Grade::survived) return finding;
    // To the last bit.
    if (end.time != length) finding.grade = Grade::failed;
    finding.amount = energy_error;
    finding.measured["energy"] = energy_error;
    // A tolerance of everything promises nothing but an end.
    if (!plan.tolerance && !(energy_error <= 0.1)) finding.grade = Grade::degraded;
    return finding;
  }
  const bool in_time = plan.last == 0 || std::abs(ends - end.time) <= 2.0 * shortest_part * std::abs(length);
  finding.grade = end.outcome != Outcome::ok && in_time ? Grade::survived : Grade::failed;
  return finding;
}

// All stages of a step lie before its end (HERK3: 2/3, CG3: 17/24, Adams: its beginning): one that ends where the force does is still
// possible.
bool asks_no_force_at_the_end(const Contestant& method) {
  if (method.is("half_explicit")) return method.options.choice("tableau") == "herk3";
  return method.is("gauss") || method.is("implicit_midpoint") || method.is("crouch_grossman") ||
         method.is("faltinsen_adams");
}

Finding examine(const Plan& plan, const Contestant& method, const std::string& form) {
  SceneRun run;
  run.scene = pendulum(plan.factor, !form.empty());
  run.integrator = std::string(method.method->name);
  run.options = method.options_for(form);
  run.step_size = plan.step_size;
  run.steps = plan.steps;
  run.every = std::max<std::uint64_t>(1, plan.steps);
  run.most_own_steps = most_own_steps;
  double first = 0.0, last = 0.0;
  run.watch = [&](const WatchedState& s) { (s.step == 0 ? first : last) = s.energy; };
  const SceneRunEnd end = run_scene(run);
  Finding finding = finding_of(end);
  finding.reason = plan.reason;
  finding.what = "energy, of 4.9 J";
  if (method.chooses_steps()) return examine_own_steps(plan, end, std::abs(last - first) / 4.905, finding);
  finding.measured["reached"] = double(end.reached);
  if (!plan.possible) {
    // To end with an outcome that says when is to survive.
    const std::uint64_t last = plan.last + (plan.last > 0 && asks_no_force_at_the_end(method) ? 1 : 0);
    finding.grade = end.outcome != Outcome::ok && end.reached == last ? Grade::survived : Grade::failed;
    return finding;
  }
  if (finding.grade != Grade::survived || plan.steps == 0) return finding;
  const double error = std::abs(last - first) / 4.905;
  finding.amount = error;
  finding.measured["energy"] = error;
  if (!(error <= 0.1)) finding.grade = Grade::degraded;
  return finding;
}

// Of tolerances that no study may ask for.
const Contestant& absurd(std::string_view integrator, double tolerance) {
  static const std::vector<Contestant> all = [] {
    std::vector<Contestant> list;
    for (const char* name : {"bliedf2nd_variable", "rkmk_variable"})
      for (const double each : {1e-300, 1e300}) list.push_back(contestant(name, {{"tolerance", each}}));
    return list;
  }();
  return *std::find_if(all.begin(), all.end(),
                       [&](const Contestant& c) { return c.is(integrator) && c.tolerance() == tolerance; });
}

std::vector<Trial> trials() {
  static const std::vector<std::string> all_forms{"", "index3", "stabilized_index2"};
  static const std::vector<Plan> plans{
      {"no step", 1e-3, 0, "", true, 0, "an interval of no length is its initial values"},
      {"one step", 1e-3, 1, "", true, 0, "of a k-step method one of its starting points"},
      {"four steps", 1e-3, 4, "", true, 0, "fewer than k = 5, 6 start from: the start covers them"},
      {"backwards", -1e-3, 500, "", true, 0, "the equations of a pendulum are the same backwards"},
      {"h = 1e-300 s", 1e-300, 50, "", true, 0, "nothing moves; 1 / h is still a number"},
      {"h = 1e300 s", 1e300, 50, "", false, 0,
       "a step that turns by pi and more, or overflows, has an outcome for it"},
      {"NaN half-way", 1e-3, 100, "t < 0.05 ? 1 : sqrt(-1)", false, 49, "no step can be taken there"},
      {"infinity half-way", 1e-3, 100, "t < 0.05 ? 1 : 1/0", false, 49, "no step can be taken there"},
      {"tolerance 1e-300", 1e-3, 500, "", false, 0, "no error of a step is as small", 1e-300},
      {"tolerance 1e300", 1e-3, 500, "", true, 0, "every step is accepted that can be taken", 1e300},
  };
  std::vector<Trial> all;
  for (const Plan& plan : plans) {
    const TrialMaker make = [&](const Contestant& method, const std::string& form) -> std::optional<Trial> {
      if (plan.tolerance && !method.chooses_steps()) return std::nullopt;
      Trial t;
      t.variant = plan.variant;
      t.parameters = {{"run", plan.variant}, {"step_size", plan.step_size}, {"steps", plan.steps}};
      t.work = 0.5;
      const Contestant* tried = &method;
      if (plan.tolerance) {
        // One row has it, that of the tolerance on the same side.
        if ((*plan.tolerance < 1e-6) != (*method.tolerance() < 1e-6)) return std::nullopt;
        tried = &absurd(method.method->name, *plan.tolerance);
      }
      t.contestant = tried;
      t.run = [&plan, tried, form] { return examine(plan, *tried, form); };
      return t;
    };
    add_trials(all, all_forms, make);
  }
  return all;
}

}  // namespace

}  // namespace degenerate_runs_case

StabilityCase degenerate_runs() {
  return {
      .name = "degenerate_runs",
      .title = "Degenerate runs",
      .question = "Has every run an outcome, however odd its request?",
      .criterion =
          "survived: ended well with finite numbers and its energy within 10 %; where no step can be taken, "
          "ended with an outcome that says so; of chosen steps at the end of the interval to the last bit, "
          "or of "
          "the force to 1e-12",
      .theory = "a failure is a record; a NaN is none",
      .trials = degenerate_runs_case::trials};
}

}  // namespace liebench
