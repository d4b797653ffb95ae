#pragma once

#include <Eigen/Core>
#include <array>

#include "problems/scene_bodies.h"

// What Newton matrices need of effects and constraints: derivatives by Jets. Compiled once for a scalar (scene_derivatives.cpp),
// for double and Counted, the scalars of linear algebra.

namespace liebench {

// D of the wrench (f, tau) on the body i, 0 for a and 1 for b, with respect to (delta x, delta theta) and to (x', Omega) of body j.
template <class T>
struct WrenchDerivatives {
  using Matrix = Eigen::Matrix<T, 6, 6>;
  std::array<std::array<Matrix, 2>, 2> pose, velocity;
};

template <class Effect, class T>
WrenchDerivatives<T> effect_derivatives(const Effect& effect, const T& t, const RigidState<T>& a,
                                        const RigidState<T>& b);

// The same of the wrenches of a constraint (without velocities), and D_{(x, theta)} of its rate at fixed (x', Omega).
template <class Constraint, class T>
struct ConstraintDerivatives {
  std::array<std::array<Eigen::Matrix<T, 6, 6>, 2>, 2> pose;
  std::array<Eigen::Matrix<T, Constraint::rows, 6>, 2> rate;
};

template <class Constraint, class T>
ConstraintDerivatives<Constraint, T> constraint_derivatives(
    const Constraint& constraint, const T& t, const RigidState<T>& a, const RigidState<T>& b,
    const Eigen::Matrix<T, Constraint::rows, 1>& lambda);

}  // namespace liebench
