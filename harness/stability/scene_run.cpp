#include "harness/stability/scene_run.h"

#include <cmath>

#include "harness/run_method.h"
#include "harness/scene_visit.h"
#include "integrators/consistent_projection.h"

namespace liebench {

namespace {

template <class S>
class Watcher {
 public:
  Watcher(const S& system, const SceneRun& run) : system_(system), run_(run) {}

  bool wants(std::uint64_t n) const {
    return run_.watch && (n == run_.steps || (run_.every != 0 && n % run_.every == 0));
  }
  void look(std::uint64_t n, const Configuration<S>& q, const Velocity<S>& v, const Multipliers<S>& lambda) {
    WatchedState state;
    state.step = n;
    state.t = run_.step_size * double(n);
    for (const Body<double>& body : system_.model().bodies) {
      RigidState<double> s;
      body.read_pose(q, s);
      body.read_velocity(v, s);
      state.bodies.push_back(s);
    }
    state.multipliers = lambda;
    if (const auto dynamics = consistent_dynamics(system_, state.t, q, v, unused_))
      state.consistent_multipliers = dynamics->lambda;
    state.energy = system_.energy(q, v);
    state.angular_momentum = system_.angular_momentum(q, v);
    if (system_.multipliers() > 0) {
      state.position_constraint = system_.constraint(state.t, q).cwiseAbs().maxCoeff();
      state.velocity_constraint = system_.constraint_rate(state.t, q, v).cwiseAbs().maxCoeff();
    }
    state.group = system_.group().defect(q);
    run_.watch(state);
  }

 private:
  const S& system_;
  const SceneRun& run_;
  NoAudit unused_;
};

// The points that a method starts from, on the exact motion.
template <class S>
StepResult take_exact(const S& system, const SceneRun& run, std::span<SolutionPoint<S>> points) {
  NoAudit unused;
  for (std::size_t j = 0; j < points.size(); ++j) {
    SolutionPoint<S>& p = points[j];
    p.t = run.step_size * double(j);
    const auto model = make_scene_model<double>(run.exact(p.t), run.scene->implied);
    p.q = model->q;
    p.v = model->v;
    const auto dynamics = consistent_dynamics(system, p.t, p.q, p.v, unused);
    if (!dynamics) return {Outcome::singular_matrix};
    p.acceleration = dynamics->acceleration;
    p.lambda = dynamics->lambda;
  }
  return {};
}

template <class S>
void disturb_points(const SceneRun& run, std::span<SolutionPoint<S>> points) {
  std::vector<StartingPoint> plain;
  for (const SolutionPoint<S>& p : points) plain.push_back({p.q, p.v, p.acceleration, p.lambda});
  run.disturb(plain);
  for (std::size_t j = 0; j < points.size(); ++j) {
    points[j].q = plain[j].q;
    points[j].v = plain[j].v;
    points[j].acceleration = plain[j].acceleration;
    points[j].lambda = plain[j].multipliers;
  }
}

template <class S>
StepResult begin(const S& system, const SceneRun& run, AnyStepper<S>& stepper,
                 std::span<SolutionPoint<S>> points) {
  if (!run.exact && !run.disturb) return stepper.start_itself(run.step_size, points);
  if (run.exact) {
    if (const StepResult found = take_exact(system, run, points); found.outcome != Outcome::ok) return found;
  } else {
    NoAudit unused;
    if (const StepResult found = self_start(system, 0.0, run.step_size, points, unused);
        found.outcome != Outcome::ok)
      return found;
  }
  if (run.disturb) disturb_points<S>(run, points);
  return stepper.start(run.step_size, points);
}

template <class S>
SceneRunEnd follow(const S& system, const SceneRun& run) {
  RunRequest request;
  request.integrator = run.integrator;
  request.options = run.options;
  const auto stepper = any_stepper(detail::options_of(request), system);
  std::vector<SolutionPoint<S>> points(std::size_t(stepper->starting_points()));
  Watcher<S> watcher(system, run);
  SceneRunEnd end;
  const auto fail = [&](const StepResult& result, std::uint64_t n) {
    end.outcome = result.outcome;
    end.failure = RunFailure{.time = double(n) * run.step_size,
                             .step = n,
                             .residual = result.residual,
                             .message = std::string(detail::explanation(result.outcome))};
    return end;
  };
  const auto first = std::uint64_t(stepper->steps());
  if (const StepResult start = begin(system, run, *stepper, std::span(points)); start.outcome != Outcome::ok)
    return fail(start, first - 1);
  for (std::uint64_t n = 0; n < first && n <= run.steps; ++n) {
    end.reached = n;
    const SolutionPoint<S>& p = points[std::size_t(n)];
    if (watcher.wants(n)) watcher.look(n, p.q, p.v, p.lambda);
    end.finite = p.q.allFinite() && p.v.allFinite() && p.lambda.allFinite();
  }
  while (end.reached < run.steps) {
    std::uint64_t chunk = run.steps - end.reached;
    if (run.every != 0) chunk = std::min(chunk, run.every - end.reached % run.every);
    const double before = stepper->time();
    if (const StepResult result = stepper->advance(chunk); result.outcome != Outcome::ok) {
      const double taken = (stepper->time() - before) / run.step_size;
      end.reached += std::isfinite(taken) ? std::uint64_t(std::llround(taken)) : 0;
      end.finite = stepper->configuration().allFinite() && stepper->velocity().allFinite();
      return fail(result, end.reached + 1);
    }
    end.reached += chunk;
    if (watcher.wants(end.reached))
      watcher.look(end.reached, stepper->configuration(), stepper->velocity(), stepper->multipliers());
    end.finite = stepper->configuration().allFinite() && stepper->velocity().allFinite() &&
                 stepper->multipliers().allFinite();
  }
  return end;
}

}  // namespace

SceneRunEnd run_scene(const SceneRun& run) {
  return with_scene(*run.scene, [&](const auto& system) { return follow(system, run); });
}

std::shared_ptr<const AssembledScene> assembled(const SceneDescription& scene) {
  return std::make_shared<AssembledScene>(assemble(scene, scene.name));
}

}  // namespace liebench
