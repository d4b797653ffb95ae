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
//   momentum(q, w)          M(q) w, without the products that the structure of M makes trivial
//   force(t, q, v)          g(t, q, v): note the sign, applied forces enter negatively
// Invariants of the exact motion, where nothing dissipates:
//   energy(q, v)            kinetic plus potential energy, J
//   angular_momentum(q, v)  about the origin, along the axis of symmetry of the force (gravity), kg m^2/s
//
//   initial_configuration(), initial_velocity()   q(t_0), v(t_0)
//
// Flags: `constraints` = l, or run_time_size.
// `rebind<U>` is the same system in another scalar, `cast<U>()` makes it (Newton matrices of
// extended-precision runs are formed in double).
template <class S>
concept MechanicalSystem = (LieGroup<typename S::Group> ||
                            SizedLieGroup<typename S::Group>)&&requires(const S& s,
                                                                        const typename S::Scalar& t,
                                                                        const typename S::Group::Element& q,
                                                                        const typename S::Group::Tangent& v) {
  { S::constraints } -> std::convertible_to<int>;
  { s.momentum(q, v) } -> std::convertible_to<typename S::Group::Tangent>;
  { s.force(t, q, v) } -> std::convertible_to<typename S::Group::Tangent>;
  { s.energy(q, v) } -> std::convertible_to<typename S::Scalar>;
  { s.angular_momentum(q, v) } -> std::convertible_to<typename S::Scalar>;
  { s.initial_configuration() } -> std::convertible_to<typename S::Group::Element>;
  { s.initial_velocity() } -> std::convertible_to<typename S::Group::Tangent>;
};

// A system with independent holonomic constraints, eq. (17), in addition:
//
//   constraint(q)                Phi(q), l
//   constraint_force(q, lambda)  B(q)^T lambda, m
//   constraint_curvature(q, v)   Z(q)(v, v), l, eq. (19): d^2 Phi / dt^2 = B v' + Z(v, v)
// and the matrices below, or constraint_product(q, w) = B(q) w. A system whose constraints depend on time has t as their first
// argument, and constraint_rate(t, q, v) = B v + Phi_t; see the functions at the end of this header.
template <class S>
concept ConstrainedSystem = MechanicalSystem<S> &&(S::constraints != 0);

// A small system of fixed size, whose Newton matrices are dense and made of
//
//   mass_matrix(q)          M(q), m x m, symmetric positive definite
//   damping(t, q, v)        C = dg/dv, m x m
//   stiffness(t, q, v, a, lambda)   K, m x m: K w = D_q(M(q) a + g(t, q, v) + B(q)^T lambda) . (q w~)
//   constraint_gradient(q)          B(q), l x m: D Phi(q) . (q w~) = B(q) w, eq. (18)
//   constraint_gradient_derivative(q, v)   l x m: w -> Z(q)(v, w) = D_q(B(q) v) . (q w~)
//
// the last two where there are constraints. Flag: `constant_mass` (M does not depend on q). Where M is block diagonal,
// with blocks of one size that divides m, the system may say so: `mass_block`.
template <class S>
concept DenseSystem = MechanicalSystem<S> && LieGroup<typename S::Group> &&
    requires(const S& s, const typename S::Scalar& t, const typename S::Group::Element& q,
             const typename S::Group::Tangent& v,
             const Eigen::Matrix<typename S::Scalar, S::constraints, 1>& lambda) {
  { S::constant_mass } -> std::convertible_to<bool>;
  { s.mass_matrix(q) } -> std::convertible_to<typename S::Group::TangentMatrix>;
  { s.damping(t, q, v) } -> std::convertible_to<typename S::Group::TangentMatrix>;
  { s.stiffness(t, q, v, v, lambda) } -> std::convertible_to<typename S::Group::TangentMatrix>;
};

template <DenseSystem S>
constexpr int mass_block() {
  if constexpr (requires { S::mass_block; })
    return S::mass_block;
  else
    return S::Group::dimension;
}

inline constexpr int run_time_size = Eigen::Dynamic;

// A system of a size known at run time that writes its vectors where they belong, all of a point in one go; lambda and r are
// consecutive numbers:
//
//   group().put_motion(q_n, step, motion, q)      motion = exp(step), q = q_n o motion
//   put_step_residual(t, h, q, v, w, lambda, r, rate)
//                                                 r = (M w + h g(t, q, v) + B(q)^T lambda, Phi(t, q) / h);
//                                                 rate = B(q) v + Phi_t, unless it is null
//   put_constraint_force(q, lambda, f)            f = B(q)^T lambda
template <class S>
concept InPlaceSystem = MechanicalSystem<S> && SizedLieGroup<typename S::Group> &&
    requires(const S& s, const typename S::Scalar& t, const typename S::Group::Element& q,
             typename S::Group::Element& to, const typename S::Group::Tangent& v,
             typename S::Group::Tangent& f, const typename S::Scalar* lambda, typename S::Scalar* r) {
  s.group().put_motion(q, v, to, to);
  s.put_step_residual(t, t, q, v, v, lambda, r, r);
  s.put_constraint_force(q, lambda, f);
};

// The most multipliers that a system can have, where their number is known at run time only.
template <class S>
constexpr int most_multipliers() {
  if constexpr (requires { S::most_constraints; })
    return S::most_constraints;
  else
    return S::constraints;
}

// Shorthands for the vectors and matrices of a system.
template <class S>
using Configuration = typename S::Group::Element;
template <class S>
using Velocity = typename S::Group::Tangent;
template <class S>
using Multipliers = Eigen::Matrix<typename S::Scalar, S::constraints, 1, 0, most_multipliers<S>(), 1>;
template <class S>
using VelocityMatrix = typename S::Group::TangentMatrix;
template <class S>
using ConstraintGradient = Eigen::Matrix<typename S::Scalar, S::constraints, S::Group::dimension>;

// The most unknowns of a step, n where it is known: velocities, and multipliers once or twice.
template <class S, bool twice>
constexpr int most_unknowns() {
  constexpr int m = S::Group::Tangent::MaxRowsAtCompileTime, l = most_multipliers<S>();
  return m == run_time_size || l == run_time_size ? run_time_size : m + (twice ? 2 : 1) * l;
}

// The group of a system: an object without a state, unless its size is known at run time only.
template <class S>
decltype(auto) group_of(const S& system) {
  if constexpr (requires { system.group(); })
    return system.group();
  else
    return typename S::Group{};
}

// The group of the same system in the scalar of the linear algebra.
template <class S>
auto linear_group_of(const typename S::Group& group) {
  using Linear = LinearScalar<typename S::Scalar>;
  if constexpr (SizedLieGroup<typename S::Group>)
    return group.template over<Linear>();
  else
    return typename S::template rebind<Linear>::Group{};
}

// m and l.
template <class S>
Eigen::Index velocity_size(const S& system) {
  if constexpr (S::Group::dimension != run_time_size)
    return S::Group::dimension;
  else
    return system.group().size();
}
template <class S>
Eigen::Index multiplier_size(const S& system) {
  if constexpr (S::constraints != run_time_size)
    return S::constraints;
  else
    return system.multipliers();
}

template <class S>
Velocity<S> zero_velocity(const S& system) {
  return Velocity<S>::Constant(velocity_size(system), typename S::Scalar(0.0));
}
template <class S>
Multipliers<S> zero_multipliers(const S& system) {
  return Multipliers<S>::Constant(multiplier_size(system), typename S::Scalar(0.0));
}

// False where every commutator of the group vanishes: no method may compute one.
template <class S>
bool has_commutators(const S& system) {
  if constexpr (SizedLieGroup<typename S::Group>)
    return !system.group().commutative();
  else
    return !S::Group::commutative;
}
// Whether they can be left out at compile time.
template <class S>
constexpr bool may_have_commutators() {
  if constexpr (SizedLieGroup<typename S::Group>)
    return true;
  else
    return !S::Group::commutative;
}

// Phi(t, q), B(q) w, B(q) v + Phi_t, and d^2 Phi / dt^2 - B v', of systems whose constraints depend on time and of those whose
// do not.
template <ConstrainedSystem S>
Multipliers<S> constraint_at(const S& system, const typename S::Scalar& t, const Configuration<S>& q) {
  if constexpr (requires { system.constraint(t, q); })
    return system.constraint(t, q);
  else
    return system.constraint(q);
}
template <ConstrainedSystem S>
Multipliers<S> constraint_product(const S& system, const Configuration<S>& q, const Velocity<S>& w) {
  if constexpr (requires { system.constraint_product(q, w); })
    return system.constraint_product(q, w);
  else
    return system.constraint_gradient(q) * w;
}
template <ConstrainedSystem S>
Multipliers<S> constraint_rate(const S& system, const typename S::Scalar& t, const Configuration<S>& q,
                               const Velocity<S>& v) {
  if constexpr (requires { system.constraint_rate(t, q, v); })
    return system.constraint_rate(t, q, v);
  else
    return constraint_product(system, q, v);
}
template <ConstrainedSystem S>
Multipliers<S> constraint_curvature_at(const S& system, const typename S::Scalar& t,
                                       const Configuration<S>& q, const Velocity<S>& v) {
  if constexpr (requires { system.constraint_curvature(t, q, v); })
    return system.constraint_curvature(t, q, v);
  else
    return system.constraint_curvature(q, v);
}

}  // namespace liebench
