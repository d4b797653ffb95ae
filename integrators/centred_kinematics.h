#pragma once

#include <array>
#include <cstddef>
#include <numbers>
#include <span>

#include "groups/entrywise.h"
#include "integrators/affine_closure.h"
#include "integrators/bdf_stepper.h"
#include "integrators/recent_motions.h"

// The kinematic equation of the BDF method in canonical coordinates about the new point: q(t) = q_{n+1} o exp(s~(t)),
// where s(t_{n+1}) = 0 and T(0) = I, so that v_{n+1} is the derivative of s itself,
//
//   v_{n+1} = (1/h) sum_{i=1}^k alpha_i s_{n+1-i},   s_{n+1-i} = log(q_{n+1}^{-1} o q_{n+1-i}) = -L_i
//   L_i = log(P_i o exp(h Dq_n~)),   P_i = q_{n+1-i}^{-1} o q_n,   L_1 = h Dq_n
//
// No commutator; k - 1 logarithms, which span k steps. As d exp(L) = exp(L) (T(L) dL)~,
//
//   dL_i = h T^{-1}(L_i) T(h Dq_n) dDq_n
//
// k = 2, ..., 6; for k = 1 kappa = 0 (ExplicitCorrection without a correction).

namespace liebench {

// x to half of its digits, 24 of a double, by Veltkamp's splitting [Dekker 1971]: GCC 12 leaves out the conversion to float and back where
// it forms vectors (-ftree-slp-vectorize).
template <class T>
T leading_half(const T& x) {
  const double leading = to_double(x);
  if constexpr (ScalarTraits<T>::extended) {
    return T(leading);
  } else {
    const double scaled = 0x1.00000008p29 * leading;
    return T(scaled - (scaled - leading));
  }
}

// The logarithms are evaluated at a point next to d, and v_{n+1} at d by its derivative there: with b = h (d - point),
// the rest is of the size of [b, [b, L_i]] / 12, and below their round-off, eps |L_i|, where |b|^2 is below eps. So a
// change of d by some units of its last place changes v by as many, and not by those of the logarithms, which would act
// on the velocity like a force eps |v| / h in every step. The point is the prediction of d, or, where that is too far
// away, d to half of its digits beyond it.
template <MechanicalSystem S>
class CentredClosure {
 public:
  using T = typename S::Scalar;
  using Linear = LinearScalar<T>;
  using Group = typename S::Group;
  using Motions = RecentMotions<S, BdfState<S>::most_steps - 1>;

  CentredClosure(const Group& group, const BdfState<S>& state, const AffineClosure<S>& affine,
                 const Motions& motions)
      : turned(to_double(state.turn(group, state.k - 1))),
        group_(group),
        affine_(affine),
        state_(state),
        motions_(motions),
        predicted_(expansion_at(state.predicted_change())) {}

  const Velocity<S>& base() const { return affine_.base_increment; }
  Velocity<S> increment(const Velocity<S>& d) const { return affine_.base_increment + d; }

  ClosureValues<S> at(const Velocity<S>& d) const {
    ClosureValues<S> values;
    const Velocity<S> e = d - predicted_.change;
    const T farthest = largest_entry(e), b = state_.h * farthest;
    if (b * b < Eigen::NumTraits<T>::epsilon()) {
      set(values.velocity_change, velocity_change(predicted_, e));
    } else {
      // To half of the digits of the largest entry.
      const T origin = leading_half(T(2.0) * farthest);
      const Expansion next = expansion_at(
          predicted_.change + e.unaryExpr([&](const T& x) { return leading_half(x + origin) - origin; }));
      set(values.velocity_change, velocity_change(next, d - next.change));
    }
    set(values.velocity, affine_.velocity + values.velocity_change);
    set(values.scaled_acceleration,
        affine_.scaled_acceleration +
            affine_.velocity_slope * (values.velocity_change - affine_.velocity_change));
    return values;
  }

  [[gnu::noinline]] ClosureDerivatives<DerivativeMatrix<S>> linearization(const Velocity<S>& d) const {
    const auto linear_group = linear_group_of<S>(group_);
    using Matrix = DerivativeMatrix<S>;
    const Expansion here = expansion_at(d);
    const Matrix tangent = linear_group.tangent(here.step.template cast<Linear>());
    Matrix sum = zero_like(tangent);
    for (int i = 2; i <= state_.k; ++i)
      sum += to_linear(alpha(i)) *
             linear_group.tangent_inverse(here.logarithms[place(i)].template cast<Linear>());
    const Matrix bent = sum * tangent;
    const Matrix dv = -to_linear(alpha(1)) * identity_like(tangent) - bent;
    return {dv, to_linear(affine_.velocity_slope) * dv};
  }

  double turned;

 private:
  // What belongs to a d.
  struct Expansion {
    Velocity<S> change;                                                            // d
    Velocity<S> step;                                                              // h Dq_n
    std::array<Velocity<S>, std::size_t(BdfState<S>::most_steps - 1)> logarithms;  // L_2, ...
    Velocity<S> velocity_change;                                                   // v_{n+1} - v_n
  };

  Expansion expansion_at(const Velocity<S>& d) const {
    Expansion here;
    here.change = d;
    const Velocity<S> Dq = increment(d);
    set(here.step, state_.h * Dq);
    const Configuration<S> motion = group_.exp(here.step);
    const auto logarithm = [&](int i) -> const Velocity<S>& {
      return here.logarithms[place(i)] = group_.log(group_.compose(motions_.over(i - 1), motion));
    };
    Velocity<S> sum = alpha(2) * logarithm(2);
    for (int i = 3; i <= state_.k; ++i) set(sum, sum + alpha(i) * logarithm(i));
    set(here.velocity_change, -(alpha(1) * Dq + sum / state_.h) - affine_.velocity);
    return here;
  }

  // v_{n+1} - v_n for d + e
  Velocity<S> velocity_change(const Expansion& at, const Velocity<S>& e) const {
    const Velocity<S> moved = group_.tangent_times(at.step, e);
    Velocity<S> change;
    set(change, alpha(1) * e);
    for (int i = 2; i <= state_.k; ++i)
      set(change, change + alpha(i) * group_.tangent_inverse_times(at.logarithms[place(i)], moved));
    set(change, at.velocity_change - change);
    return change;
  }

  const T& alpha(int i) const { return state_.coefficients.alpha[std::size_t(i)]; }
  static std::size_t place(int i) { return std::size_t(i - 2); }

  [[no_unique_address]] Group group_;
  AffineClosure<S> affine_;  // of BDF: base_increment, v_n, and h v' but for kappa_{n+1} - kappa_n
  const BdfState<S>& state_;
  const Motions& motions_;
  Expansion predicted_;
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

  // The logarithms are those of the motion while it turns by less than pi over all of them: the k - 1 steps so far, and
  // the new one as it is predicted.
  bool defined(const BdfState<S>& state) const {
    const Velocity<S> next = state.increment + state.predicted_change();
    return to_double(state.turn(group_, state.k - 1)) + to_double(group_.rotation_angle(state.h * next)) <
           std::numbers::pi;
  }

  CentredClosure<S> closure(const BdfState<S>& state, const AffineClosure<S>& affine) const {
    return {group_, state, affine, motions_};
  }

 private:
  [[no_unique_address]] typename S::Group group_;
  RecentMotions<S, BdfState<S>::most_steps - 1> motions_;
};

}  // namespace liebench
