#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>

#include "harness/references/scene_reference.h"
#include "harness/scene_reader.h"
#include "harness/stability/cases/cases.h"

// Motions on which neighbours part exponentially: until when a trajectory stays with the reference. A method that chooses its steps is
// compared with it where they end.

namespace liebench {

namespace unstable_motion_case {

namespace {

// Between two looks, s.
constexpr double spacing = 0.02;
constexpr double left = 0.1;  // m, and of the norm of R - R_ref: the trajectory has left

struct Motion {
  const char* name;
  bool constrained;
  double t_end;
  const char* scene;
};

const std::vector<Motion>& motions() {
  static const std::vector<Motion> list{
      {"middle axis", false, 10.0, R"({"name": "middle axis",
        "bodies": [{"name": "body", "formulation": "SO3", "fixed_point": [0, 0, 0], "mass": 1, "inertia": [1, 2, 3],
                    "angular_velocity": [0.01, 5, 0.01]}]})"},
      {"inverted double pendulum", true, 4.0, R"({"name": "inverted double pendulum", "chaotic": true,
        "bodies": [{"name": "lower", "mass": 1, "inertia": [0.0833333, 0.0833333, 0.01], "position": [0, 0, 0.5]},
                   {"name": "upper", "mass": 1, "inertia": [0.0833333, 0.0833333, 0.01], "position": [0, 0, 1.5],
                    "angular_velocity": [0.01, 0.02, 0]}],
        "joints": [{"name": "foot", "type": "spherical", "bodies": ["ground", "lower"], "point": [0, 0, 0]},
                   {"name": "elbow", "type": "spherical", "bodies": ["lower", "upper"], "point": [0, 0, 1]}],
        "effects": [{"type": "uniform_gravity", "acceleration": [0, 0, -9.81]}]})"},
      {"chain of three", true, 4.0, R"({"name": "chain of three", "chaotic": true,
        "bodies": [{"name": "a", "mass": 1, "inertia": [0.0016666, 0.0841666, 0.0841666], "position": [0.5, 0, 0]},
                   {"name": "b", "mass": 1, "inertia": [0.0016666, 0.0841666, 0.0841666], "position": [1.5, 0, 0]},
                   {"name": "c", "mass": 1, "inertia": [0.0016666, 0.0841666, 0.0841666], "position": [2.5, 0, 0],
                    "velocity": [0, 0.05, 0], "angular_velocity": [0, 0, 0.1]}],
        "joints": [{"name": "1", "type": "spherical", "bodies": ["ground", "a"], "point": [0, 0, 0]},
                   {"name": "2", "type": "spherical", "bodies": ["a", "b"], "point": [1, 0, 0]},
                   {"name": "3", "type": "spherical", "bodies": ["b", "c"], "point": [2, 0, 0]}],
        "effects": [{"type": "uniform_gravity", "acceleration": [0, 0, -9.81]}]})"}};
  return list;
}

double distance(const RigidState<double>& a, const RigidState<double>& b) {
  return std::max((a.x - b.x).norm(), (a.R - b.R).norm());
}
double distance(const std::vector<RigidState<double>>& a, const std::vector<RigidState<double>>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, distance(a[i], b[i]));
  return largest;
}

// What all trials of a motion are compared with: the reference at every look, and how a small disturbance of the start has
// grown there, D(t) = d(t) / d(0) for d(0) = 1e-9.
struct Known {
  std::shared_ptr<const AssembledScene> scene;
  SceneReference reference;
  std::vector<std::vector<RigidState<double>>> states;
  std::vector<double> spread;
  double lyapunov = 0.0;  // 1/s, over the whole interval

  explicit Known(const Motion& motion)
      : scene(assembled(read_scene(parse_json(motion.scene, motion.name)))), reference(*scene, motion.t_end) {
    const auto count = std::size_t(std::llround(motion.t_end / spacing));
    for (std::size_t i = 0; i <= count; ++i) states.push_back(at(double(i) * spacing));
    constexpr double disturbance = 1e-9;
    std::vector<std::vector<RigidState<double>>> plain, moved;
    follow(*scene, motion, plain);
    AssembledScene other = *scene;
    for (BodyDescription& body : other.scene.bodies)
      body.angular_velocity += disturbance * Eigen::Vector3d(0.6, 0.48, 0.64);
    follow(other, motion, moved);
    if (plain.size() != states.size() || moved.size() != states.size())
      throw std::logic_error(std::string(motion.name) + ": a trajectory of small steps ended early");
    for (std::size_t i = 0; i < plain.size(); ++i)
      spread.push_back(distance(plain[i], moved[i]) / disturbance);
    lyapunov = std::log(spread.back() / spread[spread.size() / 10]) / (0.9 * motion.t_end);
  }

  std::vector<RigidState<double>> at(double t) const {
    const auto point = reference.at(Extended(t));
    std::vector<RigidState<double>> bodies;
    for (const auto& body : reference.model().bodies) {
      RigidState<Extended> wide;
      body.read_pose(point.q, wide);
      RigidState<double> s = RigidState<double>::ground();
      s.x = wide.x.cast<double>();
      s.R = wide.R.cast<double>();
      bodies.push_back(s);
    }
    return bodies;
  }

 private:
  static void follow(const AssembledScene& scene, const Motion& motion,
                     std::vector<std::vector<RigidState<double>>>& states) {
    SceneRun run;
    run.scene = std::make_shared<AssembledScene>(scene);
    const Contestant method = contestant("bliedf2nd", {{"k", 4}});
    run.integrator = "bliedf2nd";
    run.options = method.options_for(motion.constrained ? "index3" : "");
    run.step_size = 1e-4;
    run.steps = std::uint64_t(std::llround(motion.t_end / run.step_size));
    run.every = std::uint64_t(std::llround(spacing / run.step_size));
    run.watch = [&](const WatchedState& s) { states.push_back(s.bodies); };
    run_scene(run);
  }
};

const Known& known(std::size_t motion) {
  static std::array<std::once_flag, 3> once;
  static std::array<std::unique_ptr<const Known>, 3> all;
  std::call_once(once[motion], [&] { all[motion] = std::make_unique<const Known>(motions()[motion]); });
  return *all[motion];
}

Finding examine(std::size_t number, const Contestant& method, const std::string& form, double h) {
  const Motion& motion = motions()[number];
  const Known& exact = known(number);
  SceneRun run;
  run.scene = exact.scene;
  run.integrator = std::string(method.method->name);
  run.options = method.options_for(form);
  run.step_size = h;
  run.steps = std::uint64_t(std::llround(motion.t_end / h));
  run.every = std::uint64_t(std::llround(spacing / h));
  double leaving = motion.t_end;
  bool gone = false;
  std::vector<double> errors;
  run.watch = [&](const WatchedState& s) {
    double error = 0.0;
    if (method.chooses_steps()) {
      error = distance(s.bodies, exact.at(s.t));
      // Of a step that leaps over some of the times, for all of them.
      errors.resize(std::min(std::size_t(s.t / spacing) + 1, exact.states.size()), error);
    } else {
      error = distance(s.bodies, exact.states[errors.size()]);
      errors.push_back(error);
    }
    if (!gone && !(error <= left)) {
      gone = true;
      leaving = s.t;
    }
  };
  Finding finding = finding_of(run_scene(run));
  finding.what = "time to part, as part of the predicted";
  if (weakly_unstable(method, form)) {
    finding.at_worst = Grade::failed;
    finding.reason = "rho_inf = 1: the multipliers of the index-3 form are weakly unstable";
  }
  if (finding.grade == Grade::failed) return finding;
  // What the first tenth of the run has as error grows as the disturbance does; what comes later adds to it.
  const std::size_t early = errors.size() / 10;
  double predicted = motion.t_end;
  for (std::size_t i = early; i < errors.size(); ++i)
    if (errors[early] * exact.spread[i] / exact.spread[early] > left) {
      predicted = double(i) * spacing;
      break;
    }
  finding.measured["time"] = leaving;
  finding.measured["predicted_time"] = predicted;
  finding.measured["lyapunov_exponent"] = exact.lyapunov;
  finding.measured["early_error"] = errors[early];
  finding.amount = leaving / predicted;
  finding.reason =
      fmt::format("the error of the first {:.2g} s, {:.2g}, grows as a disturbance does, by exp({:.2g} t)",
                  double(early) * spacing, errors[early], exact.lyapunov);
  if (method.order() == 1) {
    finding.at_worst = Grade::degraded;
    finding.reason += "; order 1 damps the motion away from it all the time";
  }
  finding.grade = *finding.amount >= 0.5   ? Grade::survived
                  : *finding.amount >= 0.2 ? Grade::degraded
                                           : Grade::failed;
  return finding;
}

std::vector<Trial> trials() {
  std::vector<Trial> all;
  for (std::size_t number = 0; number < motions().size(); ++number) {
    const Motion& motion = motions()[number];
    const TrialMaker make = [&](const Contestant& method, const std::string& form) -> std::optional<Trial> {
      if (!method.chooses_steps()) return std::nullopt;
      Trial t;
      t.variant = motion.name;
      t.parameters = {{"motion", motion.name}, {"t_end", motion.t_end}};
      t.quick = number == 0;
      t.work = 3.0 * motion.t_end;
      t.run = [=, &method] { return examine(number, method, form, spacing); };
      return t;
    };
    add_trials(all, motion.constrained ? constrained_forms : unconstrained, make);
  }
  for (std::size_t number = 0; number < motions().size(); ++number)
    for (const double h : {2e-2, 5e-3, 1e-3}) {
      const Motion& motion = motions()[number];
      // A tenth of a swing is no step.
      if (motion.constrained && h > 1e-2) continue;
      const TrialMaker make = [&](const Contestant& method, const std::string& form) -> std::optional<Trial> {
        if (method.chooses_steps()) return std::nullopt;
        Trial t;
        t.variant = fmt::format("{}, h = {} s", motion.name, h);
        t.parameters = {{"motion", motion.name}, {"step_size", h}, {"t_end", motion.t_end}};
        t.quick = number == 0;
        t.work = 3.0 * motion.t_end / h / 1000.0;
        t.run = [=, &method] { return examine(number, method, form, h); };
        return t;
      };
      add_trials(all, motion.constrained ? constrained_forms : unconstrained, make);
    }
  return all;
}

}  // namespace

}  // namespace unstable_motion_case

StabilityCase unstable_motion() {
  return {.name = "unstable_motion",
          .title = "Unstable motion",
          .question = "Until when does a trajectory stay with the reference where neighbours part?",
          .criterion =
              "survived: 0.1 m or 0.1 of R from the reference no earlier than at 0.5 of the predicted time; "
              "degraded: 0.2",
          .theory = "the early error grows as a small disturbance of the start does (Lyapunov)",
          .trials = unstable_motion_case::trials};
}

}  // namespace liebench
