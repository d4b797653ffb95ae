#pragma once

#include <Eigen/Core>
#include <span>
#include <utility>

#include "benchmarks/floors/floor.h"
#include "benchmarks/floors/so3_top.h"
#include "benchmarks/floors/tip_force.h"

namespace liebench::floors {

template <>
inline TipPoint configuration_from(const std::pair<Eigen::Vector3d, Eigen::Matrix3d>& q) {
  return at(from_eigen(q.first), from_eigen(q.second));
}

// What floors of one-step methods share: state and start.
template <class Top, class Point, class Velocity>
class OneStepFloor {
 public:
  using System = Top;
  using Configuration = Point;
  static constexpr int starting_points = 1;

  void start(double h, std::span<const SolutionPoint<System>> points) {
    h_ = h;
    t_ = points[0].t;
    q_ = configuration_from<Configuration>(points[0].q);
    v_ = from_eigen(points[0].v);
  }
  double time() const { return t_; }
  const Configuration& configuration() const { return q_; }
  const Velocity& velocity() const { return v_; }

 protected:
  double h_ = 0.0, t_ = 0.0;
  Configuration q_{};
  Velocity v_{};
};

using SO3Floor = OneStepFloor<HeavyTopSO3<double>, SO3Top::Configuration, Vec3>;
using TipFloor = OneStepFloor<HeavyTopR3xSO3<double>, TipPoint, Vec6>;

}  // namespace liebench::floors
