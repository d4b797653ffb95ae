#include "harness/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/run_method.h"
#include "harness/scene_visit.h"

namespace liebench {

namespace {

template <class Vector, std::size_t n>
std::array<double, n> array_of(const Vector& v) {
  std::array<double, n> a;
  for (std::size_t i = 0; i < n; ++i) a[i] = v(Eigen::Index(i));
  return a;
}

template <class S>
Sample sample_of(const S& system, double t, const Configuration<S>& q, const Velocity<S>& v,
                 const Multipliers<S>& lambda) {
  Sample sample;
  sample.time = t;
  for (const Body<double>& body : system.model().bodies) {
    RigidState<double> s;
    body.read_pose(q, s);
    body.read_velocity(v, s);
    sample.bodies.push_back({array_of<Eigen::Vector3d, 3>(s.x), array_of<Eigen::Vector3d, 3>(s.u),
                             array_of<Eigen::Vector3d, 3>(s.omega),
                             array_of<Eigen::Vector4d, 4>(SO3<double>::quaternion(s.R)), body.rotates()});
  }
  sample.multipliers.assign(lambda.data(), lambda.data() + lambda.size());
  sample.energy = system.energy(q, v);
  if (system.multipliers() > 0) {
    sample.position_constraint = system.constraint(t, q).cwiseAbs().maxCoeff();
    sample.velocity_constraint = system.constraint_rate(t, q, v).cwiseAbs().maxCoeff();
  }
  return sample;
}

template <class S>
std::optional<RunFailure> follow_plan(const S& system, const SimulationPlan& plan,
                                      const std::function<void(const Sample&)>& take) {
  const auto stepper = any_stepper(plan.method, system);
  std::vector<SolutionPoint<S>> points(std::size_t(stepper->starting_points()));
  const auto time_of = [&](std::uint64_t n) {
    return plan.chooses_steps ? stepper->time() : double(n) * plan.step_size;
  };
  const auto failure = [&](const StepResult& result, std::uint64_t n) {
    return RunFailure{.time = time_of(n),
                      .step = n,
                      .residual = result.residual,
                      .message = std::string(detail::explanation(result.outcome))};
  };
  const auto first = std::uint64_t(stepper->steps());
  if (const StepResult start = stepper->start_itself(plan.step_size, points); start.outcome != Outcome::ok)
    return failure(start, first - 1);
  const auto wanted = [&](std::uint64_t n) {
    return n % plan.every == 0 || (plan.chooses_steps ? stepper->finished() : n == plan.steps);
  };
  for (std::uint64_t n = 0; n < first && n <= plan.steps; ++n)
    if (wanted(n)) {
      const SolutionPoint<S>& p = points[std::size_t(n)];
      take(sample_of(system, time_of(n), p.q, p.v, p.lambda));
    }
  for (std::uint64_t n = first; !stepper->finished(); ++n) {
    if (n > plan.steps) {
      if (plan.chooses_steps) return failure({Outcome::step_limit}, n);
      break;
    }
    if (const StepResult result = stepper->step(); result.outcome != Outcome::ok) return failure(result, n);
    if (wanted(n))
      take(sample_of(system, time_of(n), stepper->configuration(), stepper->velocity(),
                     stepper->multipliers()));
  }
  return std::nullopt;
}

}  // namespace

std::optional<RunFailure> simulate(const AssembledScene& scene, const SimulationPlan& plan,
                                   const std::function<void(const Sample&)>& take) {
  return with_scene(scene, [&](const auto& system) { return follow_plan(system, plan, take); });
}

std::vector<std::string> multiplier_names(const AssembledScene& scene) {
  std::vector<std::string> names;
  const std::vector<RowOfJoint> rows = rows_of_joints(scene.scene);
  for (std::size_t r = 0; r < rows.size(); ++r)
    if (r >= scene.implied.size() || !scene.implied[r])
      names.push_back(fmt::format("{}[{}]", rows[r].joint, rows[r].row));
  return names;
}

}  // namespace liebench
