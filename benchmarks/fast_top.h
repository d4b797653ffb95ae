#pragma once

#include <vector>

#include "integrators/starting_values.h"
#include "problems/heavy_top.h"

namespace liebench {

// The first points of the fast heavy top on a grid of step h, by a Runge-Kutta-Munthe-Kaas method of order 4
// in 64 substeps: close enough to the solution for a benchmark, and free of the harness.
template <MechanicalSystem S>
std::vector<SolutionPoint<S>> fast_top_points(const S& system, double h, int count) {
  using G = SO3<double>;
  using Vector = Eigen::Vector3d;
  const HeavyTopSO3<double> top{HeavyTopParameters{}};
  const Eigen::Matrix3d inverse_inertia = top.mass_matrix(G::identity()).inverse();
  const auto acceleration = [&](const Eigen::Matrix3d& R, const Vector& w) -> Vector {
    return -(inverse_inertia * top.force(0.0, R, w));
  };
  Eigen::Matrix3d R = top.initial_configuration();
  Vector w = top.initial_velocity();
  std::vector<SolutionPoint<S>> points;
  constexpr int substeps = 64;
  const double s = h / substeps;
  for (int j = 0; j < count; ++j) {
    const Vector a = acceleration(R, w);
    points.push_back({j * h, system.configuration(R), system.velocity(R, w), system.acceleration(R, w, a),
                      system.multipliers(R, w, a)});
    for (int i = 0; i < substeps; ++i) {
      const Vector k1 = w, f1 = acceleration(R, w);
      const auto stage = [&](const Vector& theta, const Vector& v, Vector& k, Vector& f) {
        k = G::tangent_inverse(theta) * v;
        f = acceleration(R * G::exp(theta), v);
      };
      Vector k2, f2, k3, f3, k4, f4;
      stage(0.5 * s * k1, w + 0.5 * s * f1, k2, f2);
      stage(0.5 * s * k2, w + 0.5 * s * f2, k3, f3);
      stage(s * k3, w + s * f3, k4, f4);
      R = R * G::exp(s / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4));
      w += s / 6.0 * (f1 + 2.0 * f2 + 2.0 * f3 + f4);
    }
  }
  return points;
}

}  // namespace liebench
