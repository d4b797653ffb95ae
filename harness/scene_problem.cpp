#include "harness/scene_problem.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "harness/errors.h"
#include "harness/instances/run_time_scenes.h"
#include "harness/methods.h"
#include "harness/outside/outside_methods.h"
#include "harness/problem_checks.h"
#include "harness/references/scene_reference.h"
#include "harness/run_method.h"
#include "harness/scene_assembly.h"
#include "harness/scene_reader.h"
#include "harness/scene_visit.h"
#include "harness/simulate.h"
#include "integrators/form.h"

namespace liebench {

namespace {

// Compares a running method with the reference and keeps the norms; T is the scalar of the run.
template <class T>
class SceneMonitor {
 public:
  using Vector = Eigen::Matrix<T, Eigen::Dynamic, 1>;

  SceneMonitor(const AssembledScene& scene, const SceneReference& reference, std::uint64_t stride)
      : system_(run_time_scene<T>(scene.scene, scene.implied)),
        model_(make_scene_model<T>(scene.scene, scene.implied)),
        chaotic_(scene.scene.chaotic),
        reference_(reference),
        stride_(stride) {
    const Vector q = system_.initial_configuration(), v = system_.initial_velocity();
    energy_ = to_double(system_.energy(q, v));
    angular_momentum_ = to_double(system_.angular_momentum(q, v));
  }

  [[gnu::noinline]] void observe(const detail::ObservedStep& step, const Vector& q, const Vector& v,
                                 const Vector& lambda) {
    const Extended& t = step.t;
    using Wide = SceneReference::System::Vector;
    const SceneReference::Point exact = reference_.at(t);
    const Wide wide_q = q.template cast<Extended>(), wide_v = v.template cast<Extended>();
    const Wide wide_lambda = lambda.template cast<Extended>();
    take(q_, reference_.group().separation(wide_q, exact.q).template lpNorm<Eigen::Infinity>());
    take(v_, detail::max_norm(Wide(wide_v - exact.v)));
    // Points are seen in their order. The last may be a rounding beyond the end of the reference.
    const double known = reference_.agreement_time() * (1.0 + 1e-12);
    if (agrees_ && q_.end_absolute < SceneReference::agreement && to_double(t) <= known)
      agreement_time_ = to_double(t);
    else
      agrees_ = false;
    if (lambda.size() > 0) take(lambda_, detail::max_norm(Wide(wide_lambda - exact.lambda)));
    if (step.last) {
      q_.end_relative = detail::relative_distance(represented(wide_q), represented(exact.q));
      v_.end_relative = detail::relative_distance(wide_v, exact.v);
      if (lambda.size() > 0) lambda_.end_relative = detail::relative_distance(wide_lambda, exact.lambda);
    }
    if (step.number % stride_ == 0 || step.last) observe_drift(q, v, t);
  }

  void report(RunResult& result) const {
    result.drift = drift_;
    if (chaotic_) {
      result.agreement_time = agreement_time_;
      return;
    }
    result.q = q_;
    result.v = v_;
    if (system_.multipliers() > 0) result.lambda = lambda_;
  }

 private:
  static void take(ErrorNorms& norms, double error) {
    norms.end_absolute = error;
    norms.max_absolute = std::max(norms.max_absolute, error);
  }
  // x and R of all bodies, one below the other.
  SceneReference::System::Vector represented(const SceneReference::System::Vector& q) const {
    const auto& bodies = reference_.model().bodies;
    SceneReference::System::Vector all(Eigen::Index(12 * bodies.size()));
    Eigen::Index row = 0;
    for (const Body<Extended>& body : bodies) {
      RigidState<Extended> s;
      body.read_pose(q, s);
      all.segment<3>(row) = s.x;
      all.segment<9>(row + 3) = SO3<Extended>::stacked(s.R);
      row += 12;
    }
    return all;
  }
  void observe_drift(const Vector& q, const Vector& v, const Extended& t) {
    T time;
    if constexpr (std::is_same_v<T, Extended>)
      time = t;
    else
      time = T(to_double(t));
    drift_.energy = std::max(drift_.energy, std::abs(to_double(system_.energy(q, v)) - energy_));
    drift_.angular_momentum = std::max(
        drift_.angular_momentum, std::abs(to_double(system_.angular_momentum(q, v)) - angular_momentum_));
    drift_.group = std::max(drift_.group, to_double(SceneGroup<T>(model_->bodies).defect(q)));
    if (system_.multipliers() == 0) return;
    drift_.position_constraint =
        std::max(drift_.position_constraint.value_or(0.0), detail::max_norm(system_.constraint(time, q)));
    drift_.velocity_constraint = std::max(drift_.velocity_constraint.value_or(0.0),
                                          detail::max_norm(system_.constraint_rate(time, q, v)));
  }

  RunTimeSystem<T> system_;
  std::shared_ptr<const SceneModel<T>> model_;
  bool chaotic_, agrees_ = true;
  double agreement_time_ = 0.0;
  const SceneReference& reference_;
  std::uint64_t stride_;
  double energy_ = 0.0, angular_momentum_ = 0.0;
  ErrorNorms q_, v_, lambda_;
  Drift drift_;
};

class PreparedScene final : public PreparedProblem {
  template <class T>
  RunTimeSystem<T> run_time_system() const {
    return run_time_scene<T>(scene_.scene, scene_.implied);
  }
  // The reference as a function of time, in the vectors of the system's twin in extended precision.
  template <class S>
  auto exact() const {
    using Exact = typename S::template rebind<Extended>;
    return [this](const Extended& t) {
      const SceneReference::Point p = reference_.at(t);
      return SolutionPoint<Exact>{p.t, p.q, p.v, p.acceleration, p.lambda};
    };
  }
  template <class T, class S>
  RunResult compared(const RunRequest& request, const S& system) const {
    RunResult result;
    SceneMonitor<T> monitor(scene_, reference_, detail::drift_stride(request));
    const auto observe = [&](const detail::ObservedStep& step, const auto& q, const auto& v,
                             const auto& lambda) { monitor.observe(step, q, v, lambda); };
    const auto stepper = any_stepper(detail::options_of(request), system);
    detail::follow(*stepper, request, exact<S>(), observe, result);
    if (result.outcome == Outcome::ok) monitor.report(result);
    return result;
  }

  // In double: run as it is timed, and once more with a scalar that counts.
  RunResult counted(const RunRequest& request) const {
    RunResult result =
        with_scene(scene_, [&](const auto& system) { return compared<double>(request, system); });
    RunResult audit;
    const auto stepper = any_stepper(detail::options_of(request), run_time_system<Counted>());
    detail::follow(
        *stepper, request, exact<RunTimeSystem<Counted>>(), [](const auto&...) {}, audit);
    detail::require_same_path(result, audit, "the scene " + scene_.scene.name, request);
    result.cost = audit.cost;
    return result;
  }

  RunResult compared(const RunRequest& request, const OutsideMethod& outside) const {
    using Monitor = SceneMonitor<double>;
    Monitor monitor(scene_, reference_, detail::drift_stride(request));
    const auto observe = [&](const detail::ObservedStep& step, const Monitor::Vector& q,
                             const Monitor::Vector& v) { monitor.observe(step, q, v, Monitor::Vector(0)); };
    RunResult result = outside.runs.run_scene(request, scene_, observe);
    if (result.outcome == Outcome::ok) monitor.report(result);
    return result;
  }

 public:
  PreparedScene(const AssembledScene& scene, double duration) : scene_(scene), reference_(scene, duration) {}

  RunResult run(std::string_view, Precision precision, const RunRequest& request) const override {
    if (const OutsideMethod* outside = find_outside_method(request.integrator))
      return compared(request, *outside);
    RunResult result = precision == Precision::extended
                           ? compared<Extended>(request, run_time_system<Extended>())
                           : counted(request);
    if (has_option(*find_method(request.integrator), form_option.name)) {
      const Form form = form_of(request.options.choice_or(form_option.name, ""));
      result.solver = with_scene(scene_, [&](const auto& system) { return newton_solver(system, form); });
    }
    return result;
  }
  std::unique_ptr<TimedRun> timed(std::string_view, const RunRequest& request) const override {
    if (const OutsideMethod* outside = find_outside_method(request.integrator))
      return outside->runs.timed_scene(request, scene_);
    return with_scene(scene_, [&](const auto& system) -> std::unique_ptr<TimedRun> {
      using S = std::remove_cvref_t<decltype(system)>;
      return timed_run(request, system, exact<S>());
    });
  }
  std::string reference_method() const override { return reference_.method(); }
  double reference_error() const override { return reference_.error_estimate(); }

 private:
  AssembledScene scene_;
  SceneReference reference_;
};

// The names of velocities, in their order.
std::vector<std::string> velocity_names(const SceneDescription& scene) {
  std::vector<std::string> names;
  for (const BodyDescription& body : scene.bodies) {
    const auto add = [&](const char* part) {
      for (const char* axis : {"x", "y", "z"}) names.push_back(fmt::format("{}.{}{}", body.name, part, axis));
    };
    if (!has_fixed_point(body.kind)) add(has_body_velocity(body.kind) ? "U" : "v");
    if (body.kind != BodyKind::r3) add("omega_");
  }
  return names;
}

// Matrices are dense there, and each of their columns takes some ten evaluations of all bodies: 600 velocities, 100 bodies, take a
// minute.
constexpr std::size_t most_checked = 600;

SystemCheck check_assembled(const AssembledScene& scene, const std::string& file) {
  CheckOptions options{
      .names = {.velocities = velocity_names(scene.scene), .multipliers = multiplier_names(scene)},
      .gap = AssembledScene::fits};
  if (const std::size_t size = options.names.velocities.size(); size > most_checked)
    throw InputError(
        file, fmt::format("{} velocities; a scene that is checked has at most {}", size, most_checked));
  return check_scene(scene.scene, scene.implied, options);
}

// Version of the numerical code of scenes, as numerical_version is that of all: part of the hash of the content.
constexpr int scene_version = 3;

// Holds the text that a ProblemInfo points to.
struct SceneEntry {
  AssembledScene scene;
  std::string name, summary;
  ProblemInfo info;
};

std::unique_ptr<SceneEntry> make_entry(const std::string& file) {
  auto entry = std::make_unique<SceneEntry>();
  const Json content = read_scene_json(file);
  entry->scene = assemble(read_scene_file(file), file);
  entry->name = entry->scene.scene.name;
  entry->summary = entry->scene.scene.summary;
  const std::string text = fmt::format("{}\nscenes, version {}", content.dump(), scene_version);
  const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
  Json parameters;
  parameters["content"] = fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
  const auto rows = int(make_scene_model<double>(entry->scene.scene, entry->scene.implied)->rows);
  const AssembledScene* scene = &entry->scene;
  entry->info = {
      .name = entry->name,
      .summary = entry->summary,
      .formulations = {{.name = "scene", .constraints = rows, .summary = "as its file has it"}},
      .parameters = {},
      .complete = [parameters](const JsonView&) { return parameters; },
      .obstacle = [](const Json&, double) { return std::string(); },
      .prepare = [scene](const Json&, double duration, const ReferenceCache&,
                         const MessageCallback&) -> std::shared_ptr<const PreparedProblem> {
        return std::make_shared<PreparedScene>(*scene, duration);
      },
      .check = [scene, file](std::string_view, const Json&) { return check_assembled(*scene, file); }};
  return entry;
}

}  // namespace

const ProblemInfo& scene_problem(const std::string& file) {
  static std::mutex mutex;
  static std::map<std::string, std::unique_ptr<SceneEntry>> entries;
  const std::lock_guard lock(mutex);
  std::unique_ptr<SceneEntry>& entry = entries[file];
  if (!entry) entry = make_entry(file);
  return entry->info;
}

}  // namespace liebench
