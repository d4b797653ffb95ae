#include <fmt/format.h>

#include <array>
#include <cmath>

#include "harness/scene_reader.h"
#include "harness/stability/cases/cases.h"
#include "harness/stability/tolerance.h"
#include "problems/scene_examples.h"

// Mechanisms whose constraints depend on each other: always, somewhere on their way, or nearly.

namespace liebench {

namespace singular_case {

namespace {

// y'' = f(y, y'), by the classical Runge-Kutta method in steps far below those of the runs.
template <class Law>
std::array<double, 2> solution(const Law& law, std::array<double, 2> y, double t_end) {
  constexpr int steps = 200'000;
  const double h = t_end / steps;
  const auto f = [&](const std::array<double, 2>& z) { return std::array<double, 2>{z[1], law(z[0], z[1])}; };
  for (int i = 0; i < steps; ++i) {
    const auto moved = [&](const std::array<double, 2>& k, double s) {
      return std::array<double, 2>{y[0] + s * k[0], y[1] + s * k[1]};
    };
    const auto a = f(y), b = f(moved(a, h / 2)), c = f(moved(b, h / 2)), d = f(moved(c, h));
    for (std::size_t j = 0; j < 2; ++j) y[j] += h / 6.0 * (a[j] + 2.0 * b[j] + 2.0 * c[j] + d[j]);
  }
  return y;
}

struct Plan {
  std::shared_ptr<const AssembledScene> scene;
  double step_size, t_end;
  // Of the last state: how far it is from the exact one, rad or a part of the energy; and of what this is an error.
  std::function<double(const WatchedState& first, const WatchedState& last)> error;
  std::string what;
  double allowed;
  std::string reason;
  bool possible = true;  // for any method, in double
  bool flat = false;     // through places where the constraints lose rank
};

Finding examine(const Plan& plan, const Contestant& method, const std::string& form) {
  SceneRun run;
  run.scene = plan.scene;
  run.integrator = std::string(method.method->name);
  run.options = method.options_for(form);
  run.step_size = plan.step_size;
  run.steps = std::uint64_t(std::llround(plan.t_end / plan.step_size));
  run.every = run.steps;
  WatchedState first, last;
  run.watch = [&](const WatchedState& s) { (s.step == 0 ? first : last) = s; };
  const SceneRunEnd end = run_scene(run);
  Finding finding = finding_of(end);
  // Its own damping takes more than the criterion at these step sizes.
  if (method.order() == 1 && plan.possible) finding.at_worst = Grade::degraded;
  finding.what = plan.what;
  finding.reason = plan.reason;
  if (method.chooses_steps() && plan.possible) {
    // Errors of metres and radians of a motion of one metre.
    const auto coordinates = Eigen::Index(6 * plan.scene->scene.bodies.size());
    expect_by_tolerance(finding, permitted_error(method, end.reached, coordinates), plan.allowed,
                        100.0 * plan.allowed);
    finding.measured["steps"] = double(end.reached);
    finding.reason += "; " + plan.reason;
  }
  if (plan.flat && !method.can_be_safeguarded() && !method.chooses_steps()) {
    finding.at_worst = Grade::failed;
    finding.reason += "; nothing leads an iteration without the safeguard through them";
  }
  if (!plan.possible) {
    finding.grade = finding.outcome == Outcome::singular_matrix ? Grade::survived : Grade::failed;
    return finding;
  }
  if (finding.grade == Grade::failed) return finding;
  const double error = plan.error(first, last);
  finding.amount = error;
  finding.measured["error"] = error;
  if (!(error <= plan.allowed))
    finding.grade = error <= 100.0 * plan.allowed ? Grade::degraded : Grade::failed;
  return finding;
}

double energy_error(const WatchedState& first, const WatchedState& last, double scale) {
  return std::abs(last.energy - first.energy) / scale;
}

Plan four_bar_through_flat() {
  constexpr int n = 2;
  constexpr double t_end = 2.0;
  constexpr double w2 = 9.81 * (0.5 * (n + 1) + n) / ((n + 1) / 3.0 + n);
  static const auto exact =
      solution([](double phi, double) { return w2 * std::sin(phi); }, {0.0, 1.0}, t_end);
  return {assembled(four_bar(n)),
          1e-3,
          t_end,
          [](const WatchedState&, const WatchedState& last) {
            // The link's centre is half a metre from its foot.
            const Eigen::Vector3d& x = last.bodies[0].x;
            return 2.0 * std::hypot(x(0) - 0.5 * std::sin(exact[0]), x(1) - 0.5 * std::cos(exact[0]));
          },
          "position of B_0, m",
          1e-2,
          "at the flat places a direction is held by nothing for an instant; the multipliers of the index-3 "
          "form need not be unique",
          true,
          true};
}

Plan bricard() {
  return {assembled(read_scene_file("builtin:bricard")),
          1e-3,
          2.0,
          [](const WatchedState& first, const WatchedState& last) { return energy_error(first, last, 9.81); },
          "energy, of 9.81 J",
          1e-2,
          "one of 30 constraints is implied by the others everywhere and left out"};
}

// A crank and a rod of equal length with the rod's end on the x axis, from 45 degrees: at 90 degrees the end is in the origin, where the
// mechanism could also turn as one. By symmetry the rod has the angle -theta.
Plan equal_slider_crank() {
  constexpr double t_end = 2.0;
  static const double s = std::sqrt(0.5);
  Json scene = parse_json(R"({"name": "equal slider-crank", "bodies": [], "joints": [
      {"name": "drive", "type": "revolute", "bodies": ["ground", "crank"], "point": [0, 0, 0], "axis": [0, 0, 1]},
      {"name": "pin", "type": "revolute", "bodies": ["crank", "rod"], "point": [], "axis": [0, 0, 1]},
      {"name": "guide", "type": "point_on_plane", "bodies": ["ground", "rod"], "point": [], "normal": [0, 1, 0]}]})",
                          "");
  const auto rod = [](const char* name, double x, double angle, double rate, std::array<double, 2> velocity) {
    return Json{{"name", name},
                {"mass", 1},
                {"inertia", {0.01, 1.0 / 12.0, 1.0 / 12.0}},
                {"position", {x, 0.5 * s, 0.0}},
                {"rotation", {{"axis", {0, 0, 1}}, {"angle", angle}}},
                {"velocity", {velocity[0], velocity[1], 0.0}},
                {"angular_velocity", {0, 0, rate}}};
  };
  const double angle = std::acos(-1.0) / 4.0;
  // theta' = 1: the crank's centre (c, s) / 2, the rod's (3 c, s) / 2.
  scene["bodies"].push_back(rod("crank", 0.5 * s, angle, 1.0, {-0.5 * s, 0.5 * s}));
  scene["bodies"].push_back(rod("rod", 1.5 * s, -angle, -1.0, {-1.5 * s, 0.5 * s}));
  scene["joints"][1]["point"] = {s, s, 0.0};
  scene["joints"][2]["point"] = {2.0 * s, 0.0, 0.0};
  // 2 T = (1/3 + 1/12 + 1/4 + 2 sin^2 theta) theta'^2 without gravity.
  static const auto exact = solution(
      [](double theta, double rate) {
        const double inertia = 2.0 / 3.0 + 2.0 * std::pow(std::sin(theta), 2);
        return -2.0 * std::sin(theta) * std::cos(theta) * rate * rate / inertia;
      },
      {angle, 1.0}, t_end);
  return {assembled(read_scene(scene)),
          1e-3,
          t_end,
          [](const WatchedState&, const WatchedState& last) {
            const Eigen::Vector3d& x = last.bodies[0].x;
            return 2.0 * std::hypot(x(0) - 0.5 * std::cos(exact[0]), x(1) - 0.5 * std::sin(exact[0]));
          },
          "position of the pin, m",
          1e-2,
          "one step in a thousand is near the singular place, and passes it by its momentum"};
}

// A pendulum whose tip is in two planes that differ by a small angle: what holds it along x is the difference of two forces that are
// 1 / angle times as large.
Plan nearly_dependent(double angle) {
  Json scene = parse_json(R"({"name": "two planes",
    "bodies": [{"name": "rod", "mass": 1, "inertia": [0.01, 0.0833333, 0.0833333], "position": [0.5, 0, 0]}],
    "joints": [{"name": "plane", "type": "point_on_plane", "bodies": ["ground", "rod"], "point": [0, 0, 0], "normal": [0, 0, 1]},
               {"name": "tilted plane", "type": "point_on_plane", "bodies": ["ground", "rod"], "point": [0, 0, 0], "normal": [0, 0, 1]},
               {"name": "wall", "type": "point_on_plane", "bodies": ["ground", "rod"], "point": [0, 0, 0], "normal": [0, 1, 0]}],
    "effects": [{"type": "uniform_gravity", "acceleration": [0, 0, -9.81]}]})",
                          "");
  scene["joints"][1]["normal"] = {angle, 0, 1};
  // Assembly would take the tilted plane for the other one, or refuse it.
  AssembledScene as_it_is;
  as_it_is.scene = read_scene(scene);
  return {std::make_shared<AssembledScene>(as_it_is),
          1e-3,
          1.0,
          [](const WatchedState& first, const WatchedState& last) { return energy_error(first, last, 4.9); },
          "energy, of 4.9 J",
          1e-2,
          "the condition is the square of 1 / angle: 1e8 leaves half of the digits; 1e16 none, to say "
          "singular_matrix is the answer",
          angle > 1e-6};
}

// Every joint twice: the second is found redundant and left out.
Plan doubled() {
  const Json scene = parse_json(R"({"name": "doubled",
    "bodies": [{"name": "rod", "mass": 1, "inertia": [0.01, 0.0833333, 0.0833333], "position": [0.5, 0, 0]}],
    "joints": [{"name": "hinge", "type": "revolute", "bodies": ["ground", "rod"], "point": [0, 0, 0], "axis": [0, 1, 0]},
               {"name": "again", "type": "revolute", "bodies": ["ground", "rod"], "point": [0, 0, 0], "axis": [0, 1, 0]}],
    "effects": [{"type": "uniform_gravity", "acceleration": [0, 0, -9.81]}]})",
                                "");
  return {assembled(read_scene(scene)),
          1e-3,
          2.0,
          [](const WatchedState& first, const WatchedState& last) { return energy_error(first, last, 4.9); },
          "energy, of 4.9 J",
          1e-2,
          "the rank of the constraint gradient names what is implied"};
}

std::vector<Trial> trials() {
  std::vector<Trial> all;
  const auto add = [&](const char* variant, bool quick, Plan (*make)()) {
    const auto plan = std::make_shared<const Plan>(make());
    const TrialMaker make_trial = [&](const Contestant& method,
                                      const std::string& form) -> std::optional<Trial> {
      Trial t;
      t.variant = variant;
      t.parameters = {{"mechanism", variant}, {"step_size", plan->step_size}, {"t_end", plan->t_end}};
      t.quick = quick;
      t.work = 10.0 * plan->t_end / plan->step_size / 1000.0;
      t.run = [=, &method] { return examine(*plan, method, form); };
      return t;
    };
    add_trials(all, constrained_forms, make_trial);
  };
  add("four-bar through flat", true, four_bar_through_flat);
  add("Bricard", false, bricard);
  add("equal slider-crank", true, equal_slider_crank);
  add("planes 1e-4 apart", true, [] { return nearly_dependent(1e-4); });
  add("planes 1e-8 apart", true, [] { return nearly_dependent(1e-8); });
  add("hinge twice", true, doubled);
  return all;
}

}  // namespace

}  // namespace singular_case

StabilityCase singular() {
  return {.name = "singular",
          .title = "Singular, redundant",
          .question = "Does a mechanism pass where its constraints depend on each other?",
          .criterion =
              "survived: the end is within 1e-2 of the exact motion or energy; degraded: within 1; planes "
              "1e-8 apart: singular_matrix",
          .theory = "redundant rows are left out; an isolated singular place is passed by momentum",
          .trials = singular_case::trials};
}

}  // namespace liebench
