#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <concepts>
#include <random>
#include <type_traits>
#include <vector>

#include "groups/extended.h"
#include "problems/dense_pieces.h"
#include "problems/system.h"
#include "problems/system_check.h"
#include "problems/system_laws.h"

// Whether a mechanical system says the same in all its functions: what the author of a problem asks first.
//
//   const SystemCheck check = check_system(system);
//   for (const LawCheck& law : check.laws) std::cout << message(law) << "\n";
//
// Every derivative that the concept asks for (problems/system.h) is compared with differences, the mass matrix with what it has to
// be, the energy with the power of the forces, the initial values with the constraints and their first two derivatives. Laws of
// functions that a system does not have are left out. The laws are looked at where the system begins and at points beside it:
// beside the constraints, too, for Newton's iteration goes there. The points are the same in every run.
//
// A system that can be had in extended precision, by cast<Extended>() or as a second argument, is differenced there, and the
// differences are right to the round-off of double (problems/law_differences.h): then any term that is wrong by more than some 1e-13
// of the largest is found. Otherwise differences in double find errors from 1e-8 on.
//
// Where forces without a potential act that do not vanish at rest (a motor, a load that depends on time), the system says their power
// and that of all others without a potential, damping among them, for its energy to be balanced: power(t, q, v), W.
//
// What it does not see: an error that all functions share (a wrong inertia, a joint in the wrong place), and what happens away from
// the points.

namespace liebench {

namespace detail {

// Numbers in [-1, 1), the same on every machine.
class CheckNumbers {
 public:
  CheckVector vector(Eigen::Index size) {
    CheckVector v(size);
    for (Eigen::Index i = 0; i < size; ++i) v(i) = double(engine_()) / 2147483648.0 - 1.0;
    return v;
  }
  CheckVector signs(Eigen::Index size) {
    CheckVector v = vector(size);
    for (double& x : v) x = x < 0.0 ? -1.0 : 1.0;
    return v;
  }

 private:
  std::mt19937 engine_{1};
};

// Of the forces that have no potential, W. Where a system doesn't say it, its forces at rest are the gradient of its potential, and
// those that velocities add have this power.
template <MechanicalSystem S>
typename S::Scalar power_of_forces(const S& system, const typename S::Scalar& t, const Configuration<S>& q,
                                   const Velocity<S>& v) {
  if constexpr (requires { system.power(t, q, v); }) {
    return system.power(t, q, v);
  } else {
    const Velocity<S> still = zero_velocity(system);
    return v.dot(Velocity<S>(system.force(t, q, still)) - Velocity<S>(system.force(t, q, v)));
  }
}

template <class W, class S>
Configuration<W> in_scalar_of_witness(const Configuration<S>& q) {
  using T = typename W::Scalar;
  if constexpr (std::same_as<typename S::Scalar, T>)
    return q;
  else if constexpr (requires { S::Group::template cast<T>(q); })
    return S::Group::template cast<T>(q);
  else
    return q.template cast<T>();
}

template <MechanicalSystem W>
class WitnessOf final : public SystemWitness<typename W::Scalar> {
  using T = typename W::Scalar;
  using Vector = WitnessVector<T>;

 public:
  WitnessOf(const W& system, const Configuration<W>& q) : system_(system), q_(q) {}

  Vector momentum(const Vector& w, const Vector& a) const override {
    return system_.momentum(moved(w), Velocity<W>(a));
  }
  Vector force(const T& t, const Vector& w, const Vector& v) const override {
    return system_.force(t, moved(w), Velocity<W>(v));
  }
  T energy(const Vector& w, const Vector& v) const override {
    return system_.energy(moved(w), Velocity<W>(v));
  }
  T power(const T& t, const Vector& v) const override {
    return power_of_forces<W>(system_, t, q_, Velocity<W>(v));
  }
  Vector constraint(const T& t, const Vector& w) const override {
    if constexpr (ConstrainedSystem<W>)
      return constraint_at(system_, t, moved(w));
    else
      return {};
  }
  Vector constraint_force(const Vector& w, const Vector& lambda) const override {
    if constexpr (ConstrainedSystem<W>)
      return system_.constraint_force(moved(w), Multipliers<W>(lambda));
    else
      return {};
  }
  Vector constraint_product(const Vector& w, const Vector& v) const override {
    if constexpr (ConstrainedSystem<W>)
      return liebench::constraint_product(system_, moved(w), Velocity<W>(v));
    else
      return {};
  }

 private:
  Configuration<W> moved(const Vector& w) const {
    const auto group = group_of(system_);
    return group.compose(q_, group.exp(Velocity<W>(w)));
  }

  const W& system_;
  Configuration<W> q_;
};

template <MechanicalSystem S>
StatedValues stated_values(const S& system, const Configuration<S>& q, const CheckPoint& p) {
  const Velocity<S> v = p.v, a = p.a;
  const Eigen::Index m = p.v.size(), l = p.lambda.size();
  StatedValues stated;
  stated.force = system.force(p.t, q, v);
  stated.energy = system.energy(q, v);
  const auto unit = [&](Eigen::Index j) { return Velocity<S>(CheckVector::Unit(m, j)); };
  stated.momentum.resize(m, m);
  for (Eigen::Index j = 0; j < m; ++j) stated.momentum.col(j) = system.momentum(q, unit(j));
  if constexpr (requires { system.mass_matrix(q); }) stated.mass = system.mass_matrix(q);
  if constexpr (requires { system.damping(p.t, q, v); }) stated.damping = system.damping(p.t, q, v);
  Multipliers<S> lambda = zero_multipliers(system);
  if constexpr (ConstrainedSystem<S>) {
    lambda = p.lambda;
    if (l > 0) {
      stated.constraint = constraint_at(system, p.t, q);
      stated.rate = constraint_rate(system, p.t, q, v);
      stated.curvature = constraint_curvature_at(system, p.t, q, v);
      stated.constraint_product.resize(l, m);
      for (Eigen::Index j = 0; j < m; ++j)
        stated.constraint_product.col(j) = constraint_product(system, q, unit(j));
      stated.constraint_force.resize(l, m);
      for (Eigen::Index i = 0; i < l; ++i)
        stated.constraint_force.row(i) =
            CheckVector(system.constraint_force(q, Multipliers<S>(CheckVector::Unit(l, i)))).transpose();
      if constexpr (requires { system.constraint_gradient(q); })
        stated.gradient = system.constraint_gradient(q);
      if constexpr (requires { system.constraint_gradient_derivative(q, v); })
        stated.gradient_derivative = system.constraint_gradient_derivative(q, v);
    }
  }
  if constexpr (requires { system.stiffness(p.t, q, v, a, lambda); })
    stated.stiffness = system.stiffness(p.t, q, v, a, lambda);
  if constexpr (requires(DensePieces<S> & pieces) { system.linearize(p.t, q, v, lambda, pieces); }) {
    DensePieces<S> pieces(system);
    system.linearize(p.t, q, v, lambda, pieces);
    stated.mass = pieces.mass();
    stated.damping = pieces.C;
    stated.stiffness = pieces.K;
    if (l > 0) {
      stated.gradient = pieces.B;
      stated.gradient_derivative = pieces.Z;
    }
  }
  return stated;
}

}  // namespace detail

// `witness`: the same system in the scalar of the differences, extended or double.
template <MechanicalSystem S, MechanicalSystem W>
requires std::same_as<typename S::Scalar, double> SystemCheck check_system(const S& system, const W& witness,
                                                                           const CheckOptions& options = {}) {
  using T = typename W::Scalar;
  const auto group = group_of(system);
  const Configuration<S> q_0 = system.initial_configuration();
  const CheckVector v_0 = system.initial_velocity();
  const Eigen::Index m = velocity_size(system), l = multiplier_size(system);
  LawChecks checks(options.names);
  detail::CheckNumbers random;
  CheckMatrix initial_mass;
  for (int k = 0; k <= options.nearby_points; ++k) {
    CheckPoint point{
        .number = k, .t = 0.1 * k, .v = v_0, .a = CheckVector::Zero(m), .lambda = CheckVector::Zero(l)};
    Configuration<S> q = q_0;
    if (k > 0) {
      q = group.compose(q, group.exp(Velocity<S>(options.reach * random.vector(m))));
      point.v += std::max(1.0, max_norm(v_0)) * random.vector(m);
    }
    point.coordinates = std::max(1.0, max_norm(group.stacked(q)));
    // Accelerations and multipliers of the size that the forces give them.
    StatedValues stated = detail::stated_values(system, q, point);
    const auto size_by = [&](const CheckMatrix& A) {
      const double size = (1.0 + max_norm(stated.force)) / max_norm(A);
      return std::isfinite(size) ? size : 1.0;
    };
    point.a = size_by(stated.M()) * random.vector(m);
    if (l > 0) point.lambda = size_by(stated.B()) * random.vector(l);
    stated = detail::stated_values(system, q, point);

    CheckPoint moved = point;
    moved.v += roundings * double_eps * max_norm(point.v) * random.signs(m);
    const Velocity<S> step = roundings * double_eps * point.coordinates * random.signs(m);
    const StatedValues rounded = detail::stated_values(system, group.compose(q, group.exp(step)), moved);

    const detail::WitnessOf<W> about(witness, detail::in_scalar_of_witness<W, S>(q));
    const LawsAtPoint<T> laws_here(checks, point, stated, rounded, about);
    laws_here.check(!std::same_as<T, double>);
    if (k == 0) initial_mass = stated.M();
    if constexpr (requires { requires S::constant_mass; }) laws_here.check_constant_mass(initial_mass);
    if constexpr (requires { S::mass_block; }) laws_here.check_mass_blocks(S::mass_block);
    if (k > 0) continue;
    if constexpr (requires { group.defect(q); })
      checks.compare(Law::group, point, LawChecks::none, LawChecks::none, group.defect(q), 0.0,
                     roundings * double_eps, 0.0);
    laws_here.check_initial_values(options.gap);
  }
  return {
      .laws = checks.result(), .points = options.nearby_points + 1, .extended = ScalarTraits<T>::extended};
}

template <MechanicalSystem S>
SystemCheck check_system(const S& system, const CheckOptions& options = {}) {
  if constexpr (requires { system.template cast<Extended>(); })
    return check_system(system, system.template cast<Extended>(), options);
  else
    return check_system(system, system, options);
}

}  // namespace liebench
