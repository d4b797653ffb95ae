#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

#include "groups/entrywise.h"
#include "integrators/affine_closure.h"
#include "integrators/bdf_stepper.h"
#include "integrators/recent_motions.h"

// The kinematic equation of the BDF method in canonical coordinates about the new point: q(t) = q_{n+1} o exp(s~(t)), where
// s(t_{n+1}) = 0 and T(0) = I, so that v_{n+1} is the derivative of s itself,
//
//   v_{n+1} = (1/h) sum_{i=1}^k alpha_i s_{n+1-i},   s_{n+1-i} = log(q_{n+1}^{-1} o q_{n+1-i}) = -L_i
//   L_i = log(P_i o exp(h Dq_n~)),   P_i = q_{n+1-i}^{-1} o q_n,   L_1 = h Dq_n
//
// No T, no commutator; k - 1 logarithms in every residual, which span k steps. As d exp(L) = exp(L) (T(L) dL)~,
//
//   dL_i = h T^{-1}(L_i) T(h Dq_n) dDq_n
//
// k = 2, ..., 6; for k = 1 kappa = 0 (ExplicitCorrection without a correction).

namespace liebench {

template <MechanicalSystem S>
struct CentredClosure {
  using T = typename S::Scalar;
  using Linear = LinearScalar<T>;
  using Group = typename S::Group;
  [[no_unique_address]] Group group;
  AffineClosure<S> affine;  // of its v' all but v_{n+1}
  const BdfState<S>& state;
  const RecentMotions<S, BdfState<S>::most_steps - 1>& motions;  // P_{j+1}
  double turned;

  const Velocity<S>& base() const { return affine.base_increment; }
  Velocity<S> increment(const Velocity<S>& d) const { return affine.base_increment + d; }

  ClosureValues<S> at(const Velocity<S>& d) const { return at(d, motion_by(d)); }
  ClosureValues<S> at(const Velocity<S>& d, const Configuration<S>& motion) const {
    Velocity<S> sum;
    set(sum, alpha(2) * log_over(2, motion));
    for (int i = 3; i <= state.k; ++i) set(sum, sum + alpha(i) * log_over(i, motion));
    ClosureValues<S> values;
    set(values.velocity, -(alpha(1) * increment(d) + sum / state.h));
    set(values.velocity_change, values.velocity - affine.velocity);
    set(values.scaled_acceleration,
        affine.scaled_acceleration +
            affine.velocity_slope * (values.velocity_change - affine.velocity_change));
    return values;
  }

  // The logarithms and Dq_n are known to eps of their own size, i |Dq|.
  Linear rounding() const {
    Linear sum(0.0);
    for (int i = 1; i <= state.k; ++i) sum += Linear(i) * std::abs(to_double(alpha(i)));
    return sum / to_linear(affine.velocity_slope);
  }

  [[gnu::noinline]] ClosureDerivatives<DerivativeMatrix<S>> linearization(const Velocity<S>& d) const {
    const auto linear_group = linear_group_of<S>(group);
    using Matrix = DerivativeMatrix<S>;
    const Configuration<S> motion = motion_by(d);
    const Matrix tangent = linear_group.tangent((state.h * increment(d)).eval().template cast<Linear>());
    Matrix sum = zero_like(tangent);
    for (int i = 2; i <= state.k; ++i)
      sum += to_linear(alpha(i)) * linear_group.tangent_inverse(log_over(i, motion).template cast<Linear>());
    const Matrix bent = sum * tangent;
    const Matrix dv = -to_linear(alpha(1)) * identity_like(tangent) - bent;
    return {dv, to_linear(affine.velocity_slope) * dv};
  }

 private:
  const T& alpha(int i) const { return state.coefficients.alpha[std::size_t(i)]; }
  Configuration<S> motion_by(const Velocity<S>& d) const { return group.exp(state.h * increment(d)); }
  // L_i
  Velocity<S> log_over(int i, const Configuration<S>& motion) const {
    return group.log(group.compose(motions.over(i - 1), motion));
  }
};

template <MechanicalSystem S>
class CentredKinematics {
 public:
  using T = typename S::Scalar;

  template <class Options>
  CentredKinematics(const S& system, const Options& options)
      : group_(group_of(system)), motions_(system, options.k - 1) {}

  void start(std::span<const Configuration<S>> motions) {
    for (const Configuration<S>& motion : motions) accept(motion);
  }
  void accept(const Configuration<S>& motion) { motions_.push(motion); }

  // The logarithms are those of the motion while it turns by less than pi over all of them: the k - 1 steps so far, and the new
  // one if its increment grows as the last one did.
  bool defined(const BdfState<S>& state) const {
    const Velocity<S> next = state.increment + state.increment_changes[0];
    return to_double(turn_before(state)) + to_double(group_.rotation_angle(state.h * next)) <
           std::numbers::pi;
  }

  CentredClosure<S> closure(const BdfState<S>& state, const AffineClosure<S>& affine) const {
    return {group_, affine, state, motions_, to_double(turn_before(state))};
  }

 private:
  LinearScalar<T> turn_before(const BdfState<S>& state) const { return state.turn(group_, state.k - 1); }

  [[no_unique_address]] typename S::Group group_;
  RecentMotions<S, BdfState<S>::most_steps - 1> motions_;
};

}  // namespace liebench
