#include "harness/references/scene_reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "harness/instances/run_time_scenes.h"
#include "integrators/self_start.h"
#include "problems/audited_system.h"
#include "problems/scene_model.h"

namespace liebench {

namespace {

constexpr double wanted_error = 1e-17;
constexpr std::size_t window = 10;

}  // namespace

SceneReference::SceneReference(const AssembledScene& scene, double duration)
    : model_(make_scene_model<Extended>(scene.scene, scene.implied)),
      system_(run_time_scene<Extended>(scene.scene, scene.implied)),
      duration_(duration) {
  const auto bodies = std::max<std::size_t>(1, scene.scene.bodies.size());
  const std::uint64_t most = std::max<std::uint64_t>(800, 40000 / bodies);
  std::uint64_t steps = 100;
  // An explicit method: what is stiff stops it in large steps. Those of the last round must not stop.
  const auto may_stop = [most](std::uint64_t n) { return 4 * n <= most; };
  std::vector<Node> coarse = trajectory(steps, may_stop(steps));
  while (true) {
    std::vector<Node> fine = trajectory(2 * steps, may_stop(2 * steps));
    error_estimate_ = coarse.empty() || fine.empty() ? INFINITY : distance(coarse.back(), fine.back());
    if (error_estimate_ < 63.0 * wanted_error || !may_stop(steps)) {
      std::size_t agreed = 0;
      while (agreed + 1 < coarse.size() && distance(coarse[agreed + 1], fine[2 * agreed + 2]) < agreement)
        ++agreed;
      agreement_time_ = duration * double(agreed) / double(steps);
      if (agreed < steps && !scene.scene.chaotic)
        throw std::runtime_error(
            fmt::format("trajectories of {} and {} steps agree up to t = {:.3g} s only; choose \"t_end\" up "
                        "to that, or say "
                        "\"chaotic\": true in the scene, to be compared by invariants",
                        steps, 2 * steps, agreement_time_));
      // Beyond that time nothing is compared.
      if (agreed < steps) error_estimate_ = distance(coarse[agreed], fine[2 * agreed]);
      // Richardson: the finer trajectory is 63 times nearer.
      error_estimate_ = std::max(error_estimate_ / 63.0, 1e-30);
      nodes_ = std::move(fine);
      spacing_ = Extended(duration) / Extended(double(2 * steps));
      return;
    }
    coarse = std::move(fine);
    steps *= 2;
  }
}

std::vector<SceneReference::Node> SceneReference::trajectory(std::uint64_t steps, bool may_stop) const {
  NoAudit audit;
  const Extended h = Extended(duration_) / Extended(double(steps));
  System::Vector q = system_.initial_configuration(), v = system_.initial_velocity();
  std::vector<Node> nodes;
  for (std::uint64_t n = 0; n <= steps; ++n) {
    const Extended t = h * Extended(double(n));
    StepResult result;
    if (n > 0) result = index1_step(system_, Extended(t - h), h, q, v, audit).result;
    if (result.outcome == Outcome::ok) result = project_on_constraints(system_, t, q, v, audit);
    const auto dynamics = consistent_dynamics(system_, t, q, v, audit);
    if (result.outcome != Outcome::ok || !dynamics) {
      if (may_stop) return {};
      throw std::runtime_error(fmt::format(
          "the reference method stops at t = {:.3g} s in steps of {:.2g} s: {}; choose \"t_end\" up to that",
          to_double(t), to_double(h),
          name(result.outcome == Outcome::ok ? Outcome::singular_matrix : result.outcome)));
    }
    nodes.push_back({q, v, dynamics->lambda});
  }
  return nodes;
}

double SceneReference::distance(const Node& a, const Node& b) const {
  const double position = group().separation(a.q, b.q).lpNorm<Eigen::Infinity>();
  const System::Vector difference = a.v - b.v;
  const double size = 1.0 + to_double(Extended(b.v.norm()));
  const double velocity = to_double(Extended(difference.norm())) / size;
  return std::isfinite(position + velocity) ? std::max(position, velocity) : INFINITY;
}

SceneReference::Point SceneReference::at(const Extended& t) const {
  const Uncounted uncounted;
  const double place = to_double(t / spacing_);
  const auto nearest = std::size_t(std::clamp(std::lround(place), 0L, long(nodes_.size()) - 1));
  const std::size_t first =
      nearest < window / 2 ? 0
                           : std::min(nearest - window / 2, nodes_.size() - std::min(nodes_.size(), window));
  const std::size_t last = std::min(nodes_.size(), first + window);
  const auto group = system_.group();
  const Node& centre = nodes_[nearest];
  const System::Vector back = group.inverse(centre.q);
  const Extended x = t / spacing_;
  System::Vector s = zero_velocity(system_), v = s, lambda = zero_multipliers(system_);
  for (std::size_t j = first; j < last; ++j) {
    Extended weight(1.0);
    for (std::size_t i = first; i < last; ++i)
      if (i != j) weight *= (x - Extended(double(i))) / Extended(double(j) - double(i));
    if (j != nearest) s += weight * group.log(group.compose(back, nodes_[j].q));
    v += weight * nodes_[j].v;
    lambda += weight * nodes_[j].lambda;
  }
  Point point{t, group.compose(centre.q, group.exp(s)), v, zero_velocity(system_), lambda};
  NoAudit audit;
  if (const auto dynamics = consistent_dynamics(system_, t, point.q, point.v, audit))
    point.acceleration = dynamics->acceleration;
  return point;
}

std::string SceneReference::method() const {
  return fmt::format("Runge-Kutta-Munthe-Kaas of order 6, {} steps, 106 bits", nodes_.size() - 1);
}

}  // namespace liebench
