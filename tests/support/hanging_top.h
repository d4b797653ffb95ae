#pragma once

#include <vector>

#include "groups/extended.h"
#include "groups/so3.h"
#include "integrators/any_stepper.h"
#include "integrators/starting_values.h"
#include "problems/heavy_top.h"

namespace liebench {

// A top that hangs and spins about its own axis, which is a principal one: v and lambda are constant, q = q_0 exp(t v).
inline HeavyTopParameters hanging_top(double spin) {
  HeavyTopParameters p;
  p.mass = 2;
  p.inertia = {{{0.5, 0, 0}, {0, 0.7, 0}, {0, 0, 0.4}}};
  p.center_of_mass = {0, 0, -0.5};
  p.angular_velocity = {0, 0, spin};
  p.orientation = {0.8, 0, 0, 0.6};
  return p;
}

// The formulation gives its state for a rigid motion: configuration(R), velocity(R, omega), acceleration(R, omega, omega_dot),
// multipliers(R, omega, omega_dot); rounded from extended precision.
template <MechanicalSystem S>
SolutionPoint<S> hanging_top_point(const HeavyTopParameters& p, const typename S::Scalar& t) {
  using T = typename S::Scalar;
  using E = typename S::template rebind<Extended>;
  using Vector = Eigen::Matrix<Extended, 3, 1>;
  const HeavyTopData<Extended> data(p);
  const E system(p);
  const Vector omega = data.omega0, rest = Vector::Constant(Extended(0.0));
  const Eigen::Matrix<Extended, 3, 3> R = data.R0 * SO3<Extended>::exp((omega * Extended(t)).eval());
  const auto rounded = [](const auto& v) { return v.template cast<T>().eval(); };
  return {t, E::Group::template cast<T>(system.configuration(R)), rounded(system.velocity(R, omega)),
          rounded(system.acceleration(R, omega, rest)), rounded(system.multipliers(R, omega, rest))};
}

template <MechanicalSystem S>
std::vector<SolutionPoint<S>> hanging_top_points(const HeavyTopParameters& p, double h, int count) {
  std::vector<SolutionPoint<S>> points;
  for (int j = 0; j < count; ++j) points.push_back(hanging_top_point<S>(p, typename S::Scalar(h * j)));
  return points;
}

// What a stepper shows, bit for bit.
template <MechanicalSystem S>
std::vector<double> state_of(const AnyStepper<S>& stepper) {
  std::vector<double> state{to_double(stepper.time())};
  const auto append = [&](const auto& v) {
    for (Eigen::Index i = 0; i < v.size(); ++i) state.push_back(to_double(v(i)));
  };
  append(S::Group::stacked(stepper.configuration()));
  append(stepper.velocity());
  append(stepper.multipliers());
  return state;
}

}  // namespace liebench
