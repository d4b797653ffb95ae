#pragma once

#include "groups/entrywise.h"
#include "problems/system.h"

// A closure is what a method adds to the step equation: v and h v' at the new point as functions of the change
// d = Dq_n - base of the increment. Every closure gives
//
//   base()             the increment at d = 0
//   increment(d)       Dq_n = base() + d
//   at(d)              ClosureValues: v_{n+1} - v_n, v_{n+1}, h v'_{n+1}
//   linearization(d)   ClosureDerivatives of v and h v' with respect to d, in the scalar of the Newton matrix
//
// and, where the new step is in a logarithm with some before it,
//
//   turned             by how much those turn [rad], a double

namespace liebench {

template <MechanicalSystem S>
struct ClosureValues {
  Velocity<S> velocity_change;  // v_{n+1} - v_n
  Velocity<S> velocity;
  Velocity<S> scaled_acceleration;  // h v'_{n+1}
};

// Derivative: a number where it is a multiple of the identity, else an m x m matrix. explicit_forces: the equations
// of motion have their forces, and those of the constraints, at q_n and not at the new point.
template <class Derivative, bool explicit_forces = false>
struct ClosureDerivatives {
  Derivative velocity;
  Derivative scaled_acceleration;
};

// The matrix of a derivative.
template <MechanicalSystem S>
using DerivativeMatrix = typename S::template rebind<LinearScalar<typename S::Scalar>>::Group::TangentMatrix;

// Closure of the methods whose v and v' are affine in the increment:
//
//   Dq = base_increment + d
//   v = v_n + velocity_slope d + velocity_change
//   h v' = acceleration_slope d + scaled_acceleration
template <MechanicalSystem S>
struct AffineClosure {
  using T = typename S::Scalar;
  Velocity<S> base_increment;
  Velocity<S> velocity;  // v_n
  T velocity_slope;
  Velocity<S> velocity_change;
  T acceleration_slope;
  Velocity<S> scaled_acceleration;

  const Velocity<S>& base() const { return base_increment; }
  // A sum that holds references to both.
  auto increment(const Velocity<S>& d) const { return base_increment + d; }
  ClosureValues<S> at(const Velocity<S>& d) const {
    ClosureValues<S> values;
    put(d, values);
    return values;
  }
  // The same into vectors that are there.
  void put(const Velocity<S>& d, ClosureValues<S>& values) const {
    if constexpr (!goes_by_entries<Velocity<S>>) {
      values.velocity_change = velocity_slope * d + velocity_change;
      values.velocity = velocity + values.velocity_change;
      values.scaled_acceleration = acceleration_slope * d + scaled_acceleration;
    } else {
      values.velocity_change.resize(d.size());
      values.velocity.resize(d.size());
      values.scaled_acceleration.resize(d.size());
      const auto put_entry = [&](Eigen::Index i) __attribute__((always_inline)) {
        const T change = velocity_slope * d(i) + velocity_change(i);
        values.velocity_change(i) = change;
        values.velocity(i) = velocity(i) + change;
        values.scaled_acceleration(i) = acceleration_slope * d(i) + scaled_acceleration(i);
      };
      each_entry(d.size(), put_entry);
    }
  }
  ClosureDerivatives<LinearScalar<T>> linearization(const Velocity<S>&) const {
    return {to_linear(velocity_slope), to_linear(acceleration_slope)};
  }
};

}  // namespace liebench
