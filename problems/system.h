#pragma once

#include <Eigen/Core>
#include <concepts>

#include "groups/lie_group.h"

// Mechanical systems on Lie groups, eqs. (16) and (17):
//
//   q' = DL_q(e) v~,   M(q) v' = -g(t, q, v) - B(q)^T lambda,   0 = Phi(q)
//
// with q in G, v in R^m, lambda in R^l. Units are SI throughout. A system is immutable.

namespace liebench {

// A system without constraints, eq. (16), and what every system gives:
//
//   mass_matrix(q)          M(q), m x m, symmetric positive definite
//   momentum(q, w)          M(q) w, without the products that the structure of M makes trivial
//   force(t, q, v)          g(t, q, v): note the sign, applied forces enter negatively
//   damping(t, q, v)        C = dg/dv, m x m
//   stiffness(t, q, v, a, lambda)   K, m x m: K w = D_q(M(q) a + g(t, q, v) + B(q)^T lambda) . (q w~)
// Invariants of the exact motion, where nothing dissipates:
//   energy(q, v)            kinetic plus potential energy, J
//   angular_momentum(q, v)  about the origin, along the axis of symmetry of the force (gravity), kg m^2/s
//
//   initial_configuration(), initial_velocity()   q(t_0), v(t_0)
//
// Flags: `constraints` = l; `constant_mass` (M does not depend on q).
// `rebind<U>` is the same system in another scalar, `cast<U>()` makes it (Newton matrices of
// extended-precision runs are formed in double).
template <class S>
concept MechanicalSystem = LieGroup<typename S::Group> &&
    requires(const S& s, const typename S::Scalar& t, const typename S::Group::Element& q,
             const typename S::Group::Tangent& v,
             const Eigen::Matrix<typename S::Scalar, S::constraints, 1>& lambda) {
  { S::constraints } -> std::convertible_to<int>;
  { S::constant_mass } -> std::convertible_to<bool>;
  { s.mass_matrix(q) } -> std::convertible_to<typename S::Group::TangentMatrix>;
  { s.momentum(q, v) } -> std::convertible_to<typename S::Group::Tangent>;
  { s.force(t, q, v) } -> std::convertible_to<typename S::Group::Tangent>;
  { s.damping(t, q, v) } -> std::convertible_to<typename S::Group::TangentMatrix>;
  { s.stiffness(t, q, v, v, lambda) } -> std::convertible_to<typename S::Group::TangentMatrix>;
  { s.energy(q, v) } -> std::convertible_to<typename S::Scalar>;
  { s.angular_momentum(q, v) } -> std::convertible_to<typename S::Scalar>;
  { s.initial_configuration() } -> std::convertible_to<typename S::Group::Element>;
  { s.initial_velocity() } -> std::convertible_to<typename S::Group::Tangent>;
};

// A system with l >= 1 independent holonomic constraints, eq. (17), in addition:
//
//   constraint(q)                Phi(q), l
//   constraint_gradient(q)       B(q), l x m: D Phi(q) . (q w~) = B(q) w, eq. (18)
//   constraint_force(q, lambda)  B(q)^T lambda, m
//   constraint_curvature(q, v)   Z(q)(v, v), l, eq. (19): d^2 Phi / dt^2 = B v' + Z(v, v)
//   constraint_gradient_derivative(q, v)   l x m: w -> Z(q)(v, w) = D_q(B(q) v) . (q w~)
template <class S>
concept ConstrainedSystem = MechanicalSystem<S> &&(S::constraints > 0) &&
                            requires(const S& s, const typename S::Group::Element& q,
                                     const typename S::Group::Tangent& v,
                                     const Eigen::Matrix<typename S::Scalar, S::constraints, 1>& lambda) {
  { s.constraint(q) } -> std::convertible_to<Eigen::Matrix<typename S::Scalar, S::constraints, 1>>;
  {
    s.constraint_gradient(q)
    } -> std::convertible_to<Eigen::Matrix<typename S::Scalar, S::constraints, S::Group::dimension>>;
  { s.constraint_force(q, lambda) } -> std::convertible_to<typename S::Group::Tangent>;
  {
    s.constraint_curvature(q, v)
    } -> std::convertible_to<Eigen::Matrix<typename S::Scalar, S::constraints, 1>>;
};

// Shorthands for the vectors and matrices of a system.
template <class S>
using Configuration = typename S::Group::Element;
template <class S>
using Velocity = typename S::Group::Tangent;
template <class S>
using Multipliers = Eigen::Matrix<typename S::Scalar, S::constraints, 1>;
template <class S>
using VelocityMatrix = typename S::Group::TangentMatrix;
template <class S>
using ConstraintGradient = Eigen::Matrix<typename S::Scalar, S::constraints, S::Group::dimension>;

}  // namespace liebench
