#include "harness/stability/scene_run.h"

#include <algorithm>
#include <cmath>

#include "harness/methods.h"
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
  void look(std::uint64_t n, double t, const Configuration<S>& q, const Velocity<S>& v,
            const Multipliers<S>& lambda, bool own_steps = false) {
    WatchedState state;
    state.step = n;
    state.t = t;
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
    if (own_steps) state.energy_of_tolerance = energy_of_tolerance(t, q, v);
    run_.watch(state);
  }

 private:
  // dE = p . dv + (g at rest) . dtheta with p = dE/dv, by differences, which are exact of a kinetic energy.
  double energy_of_tolerance(double t, const Configuration<S>& q, const Velocity<S>& v) const {
    Velocity<S> rest = v;
    rest.setZero();
    const Velocity<S> slope = system_.force(t, q, rest);
    double sum = slope.squaredNorm();
    for (Eigen::Index i = 0; i < v.size(); ++i) {
      Velocity<S> more = v, less = v;
      more(i) += 1.0;
      less(i) -= 1.0;
      const double p = 0.5 * (system_.energy(q, more) - system_.energy(q, less));
      sum += std::pow(p * (1.0 + std::abs(v(i))), 2);
    }
    return std::sqrt(2.0 * double(v.size()) * sum);
  }

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

// The starting points of the run's own making.
template <class S>
StepResult make_points(const S& system, const SceneRun& run, double h, std::span<SolutionPoint<S>> points) {
  NoAudit unused;
  const StepResult found =
      run.exact ? take_exact(system, run, points) : self_start(system, 0.0, h, points, unused);
  if (found.outcome == Outcome::ok && run.disturb) disturb_points<S>(run, points);
  return found;
}

// h: the step size, or the length of the interval.
template <class S>
StepResult begin(const S& system, const SceneRun& run, double h, AnyStepper<S>& stepper,
                 std::span<SolutionPoint<S>> points) {
  if (!run.exact && !run.disturb) return stepper.start_itself(h, points);
  if (const StepResult found = make_points(system, run, h, points); found.outcome != Outcome::ok)
    return found;
  return stepper.start(h, points);
}

RunFailure failure_of(const StepResult& result, std::uint64_t step, double time) {
  return {.time = time,
          .step = step,
          .residual = result.residual,
          .message = std::string(detail::explanation(result.outcome))};
}

template <class S>
bool all_finite(const AnyStepper<S>& stepper) {
  return stepper.configuration().allFinite() && stepper.velocity().allFinite() &&
         stepper.multipliers().allFinite();
}

// A method that chooses its steps.
template <class S>
SceneRunEnd follow_own_steps(const S& system, const SceneRun& run, AnyStepper<S>& stepper) {
  std::vector<SolutionPoint<S>> points(std::size_t(stepper.starting_points()));
  Watcher<S> watcher(system, run);
  SceneRunEnd end;
  const auto fail = [&](const StepResult& result) {
    end.outcome = result.outcome;
    end.failure = failure_of(result, end.reached + 1, end.time);
    return end;
  };
  const double length = run.step_size * double(run.steps), direction = std::copysign(1.0, length);
  if (const StepResult start = begin(system, run, length, stepper, std::span(points));
      start.outcome != Outcome::ok)
    return fail(start);
  const double spacing = std::abs(run.step_size) * double(run.every);
  double next_look = 0.0;
  const auto look = [&] {
    const double passed = std::abs(end.time);
    const bool due = run.watch_own_steps || (run.every != 0 && passed >= next_look);
    if (run.watch && (due || stepper.finished()))
      watcher.look(end.reached, end.time, stepper.configuration(), stepper.velocity(), stepper.multipliers(),
                   true);
    if (due && run.every != 0) next_look = (std::floor(passed / spacing) + 1.0) * spacing;
    end.finite = all_finite(stepper);
  };
  look();
  while (!stepper.finished()) {
    if (end.reached == run.most_own_steps) return fail({Outcome::step_limit});
    if (const StepResult result = stepper.step(); result.outcome != Outcome::ok) {
      end.finite = all_finite(stepper);
      return fail(result);
    }
    ++end.reached;
    const double h = (stepper.time() - end.time) * direction;
    end.time = stepper.time();
    end.longest_step = std::max(end.longest_step, h);
    if (!stepper.finished() && (end.shortest_step == 0.0 || h < end.shortest_step)) end.shortest_step = h;
    look();
  }
  return end;
}

template <class S>
SceneRunEnd follow(const S& system, const SceneRun& run) {
  RunRequest request;
  request.integrator = run.integrator;
  request.options = run.options;
  const auto stepper = any_stepper(detail::options_of(request), system);
  if (find_method(run.integrator)->chooses_steps) return follow_own_steps(system, run, *stepper);
  std::vector<SolutionPoint<S>> points(std::size_t(stepper->starting_points()));
  Watcher<S> watcher(system, run);
  SceneRunEnd end;
  const auto time_of = [&](std::uint64_t n) { return double(n) * run.step_size; };
  const auto fail = [&](const StepResult& result, std::uint64_t n) {
    end.outcome = result.outcome;
    end.failure = failure_of(result, n, time_of(n));
    end.time = time_of(end.reached);
    return end;
  };
  const auto first = std::uint64_t(stepper->steps());
  if (const StepResult start = begin(system, run, run.step_size, *stepper, std::span(points));
      start.outcome != Outcome::ok)
    return fail(start, first - 1);
  for (std::uint64_t n = 0; n < first && n <= run.steps; ++n) {
    end.reached = n;
    const SolutionPoint<S>& p = points[std::size_t(n)];
    if (watcher.wants(n)) watcher.look(n, time_of(n), p.q, p.v, p.lambda);
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
      watcher.look(end.reached, time_of(end.reached), stepper->configuration(), stepper->velocity(),
                   stepper->multipliers());
    end.finite = all_finite(*stepper);
  }
  end.time = time_of(end.reached);
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
