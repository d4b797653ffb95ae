#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "groups/extended.h"
#include "harness/scene_assembly.h"
#include "integrators/run_time_system.h"
#include "integrators/starting_values.h"
#include "problems/scene_system.h"

namespace liebench {

// The motion of a scene in extended precision: the Runge-Kutta-Munthe-Kaas method of order 6 on the index-1 form with projections
// (integrators/self_start.h), another method than those under test, with N and 2 N steps; the finer one is kept, the
// difference of both is the error estimate. Between its steps polynomials of degree 9 in local canonical coordinates.
class SceneReference {
 public:
  using System = RunTimeSystem<Extended>;
  using Point = SolutionPoint<System>;

  // N grows until the estimate is below 1e-17 or a step of 2 N would be the 40,000th of a body. Throws std::runtime_error where a
  // step fails or, of a scene that is not chaotic, the trajectories of N and 2 N steps do not agree to 1 %, with the time up to
  // which they do.
  SceneReference(const AssembledScene& scene, double duration);

  // The solution at t in [0, duration].
  Point at(const Extended& t) const;
  double error_estimate() const { return error_estimate_; }
  // Up to when the trajectories of N and 2 N steps agree to 1 %, s; of a scene that is not chaotic the whole duration.
  double agreement_time() const { return agreement_time_; }
  static constexpr double agreement = 1e-2;
  std::string method() const;
  const SceneModel<Extended>& model() const { return *model_; }
  SceneGroup<Extended> group() const { return SceneGroup<Extended>(model_->bodies); }

 private:
  struct Node {
    System::Vector q, v, lambda;
  };
  // Of steps + 1 nodes; empty where it stops and may.
  std::vector<Node> trajectory(std::uint64_t steps, bool may_stop) const;
  double distance(const Node& a, const Node& b) const;

  std::shared_ptr<const SceneModel<Extended>> model_;
  System system_;
  double duration_;
  Extended spacing_;
  std::vector<Node> nodes_;
  double error_estimate_ = 0.0;
  double agreement_time_ = 0.0;
};

}  // namespace liebench
