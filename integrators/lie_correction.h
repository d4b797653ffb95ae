#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>

#include "groups/entrywise.h"
#include "integrators/affine_closure.h"
#include "integrators/backward_differences.h"
#include "integrators/bdf_stepper.h"

// The correction term L_k of BLieDF2nd: kappa = -h^2 L_k. From the Magnus expansion of an increment about the middle of
// its step, with all quantities at t_{n+1},
//
//   L_k = 1/12 [v, v'] + h^2 { -1/720 [v, v'''] - 1/180 [v', v''] + 1/720 [v, [v, v'']] - 1/240 [v', [v, v']]
//                              - 1/720 [v, [v, [v, v']]] } + O(h^4)
//
// of which k = 3, 4 need the first commutator to O(h^{k-2}), k = 5, 6 the braces too, to O(h^{k-4}). (The paper has k = 3, 4.)
// In scaled derivatives a = h v', b = h^2 v'', c = h^3 v''' and with W = h [v, a] the whole takes four commutators:
//
//   h^2 L = h/12 [v, a + (h [v, b - W] - c) / 60] - h/240 [a, 4/3 b + W]
//
// Explicit: a, b, c and, for k = 5, 6, v from v_n, ..., v_{n-k+1}; for k = 3, 4 the formulas of eq. (22). In the index-3
// form the constraint fixes Dq, and v_{n+1} = sum gamma_i Dq_{n+1-i} - h^2 L_k(v_n, ...) is an explicit recursion in v: it is
// stable for h |v| up to 3.60, 3.08, 0.259, 0.112 for k = 3, 4, 5, 6 only (docs/theory.md).
// Implicit ("BLieDF-I"): v_{n+1} itself, a, b, c by backward differences from v_{n+1}, ..., v_{n+1-k}; no such bound.

namespace liebench {

// Weights of a, b, c in the changes v_{n+1} - v_n, v_n - v_{n-1}, ... (implicit) or v_n - v_{n-1}, ... (explicit), for
// 3 <= k <= 6; zero below.
template <class T>
struct CorrectionWeights {
  using Weights = std::array<T, most_points>;
  bool higher;  // the braces, k >= 5
  int explicit_changes, implicit_changes;
  std::array<Weights, 3> explicit_derivative, implicit_derivative;
  Weights explicit_velocity;  // v_{n+1} - v_n; zero for k = 3, 4

  explicit CorrectionWeights(int k) : higher(k >= 5), explicit_changes(k - 1), implicit_changes(k) {
    for (int d = 0; d < 3; ++d) {
      explicit_derivative[std::size_t(d)].fill(T(0.0));
      implicit_derivative[std::size_t(d)].fill(T(0.0));
      if (k < 3 || (d > 0 && !higher)) continue;
      explicit_derivative[std::size_t(d)] = change_weights<T>(k, d + 1, 1.0);
      implicit_derivative[std::size_t(d)] = change_weights<T>(k + 1, d + 1, 0.0);
    }
    explicit_velocity.fill(T(0.0));
    if (higher) explicit_velocity = change_weights<T>(k, 0, 1.0);
    // Eq. (22): (3 v_n - 4 v_{n-1} + v_{n-2}) / 2 and (7 v_n - 7 v_{n-1} - 3 v_{n-2} + 3 v_{n-3}) / 4.
    if (k == 3) explicit_derivative[0] = {T(1.5), T(-0.5)};
    if (k == 4) explicit_derivative[0] = {T(1.75), T(0.0), T(-0.75)};
  }
};

// h^2 L for k = 3, 4.
template <class Group>
typename Group::Tangent leading_correction(const Group& group, const typename Group::Scalar& h,
                                           const typename Group::Tangent& v,
                                           const typename Group::Tangent& a) {
  typename Group::Tangent correction = group.commutator(v, a);
  set(correction, (h / typename Group::Scalar(12.0)) * correction);
  return correction;
}

// h^2 L for k = 5, 6.
template <class Group>
typename Group::Tangent full_correction(const Group& group, const typename Group::Scalar& h,
                                        const typename Group::Tangent& v, const typename Group::Tangent& a,
                                        const typename Group::Tangent& b, const typename Group::Tangent& c) {
  using T = typename Group::Scalar;
  using Vector = typename Group::Tangent;
  const Vector W = h * group.commutator(v, a);
  const Vector inner = a + (h * group.commutator(v, b - W) - c) / T(60.0);
  return (h / T(12.0)) * group.commutator(v, inner) -
         (h / T(240.0)) * group.commutator(a, (T(4.0) / T(3.0)) * b + W);
}

// kappa_{n+1} from known velocities, or none: the closure stays affine.
template <MechanicalSystem S>
class ExplicitCorrection {
 public:
  using T = typename S::Scalar;
  using Group = typename S::Group;

  template <class Options>
  ExplicitCorrection(const S& system, const Options& options)
      : group_(group_of(system)),
        present_(options.k >= 3 && has_commutators(system) && options.explicit_correction()),
        weights_(options.k) {}

  void start(std::span<const Configuration<S>>) {}
  bool defined(const BdfState<S>&) const { return true; }
  void accept(const Configuration<S>&) {}

  AffineClosure<S> closure(const BdfState<S>& state, const AffineClosure<S>& given) const {
    AffineClosure<S> affine = given;
    if constexpr (may_have_commutators<S>()) {
      if (present_) {
        Velocity<S> kappa_change = correction(state);
        set(kappa_change, -kappa_change - state.kappa);
        set(affine.velocity_change, affine.velocity_change + kappa_change);
        set(affine.scaled_acceleration, affine.scaled_acceleration + affine.velocity_slope * kappa_change);
      }
    }
    return affine;
  }

 private:
  Velocity<S> correction(const BdfState<S>& state) const {
    const Velocity<S> a = sum(weights_.explicit_derivative[0], state);
    if (!weights_.higher) return leading_correction(group_, state.h, state.velocity, a);
    const Velocity<S> v = state.velocity + sum(weights_.explicit_velocity, state);
    return full_correction(group_, state.h, v, a, sum(weights_.explicit_derivative[1], state),
                           sum(weights_.explicit_derivative[2], state));
  }
  Velocity<S> sum(const typename CorrectionWeights<T>::Weights& weights, const BdfState<S>& state) const {
    Velocity<S> s;
    set(s, weights[0] * state.velocity_changes[0]);
    state.velocity_changes.add_weighted(
        1, weights_.explicit_changes, [&](int i) -> const T& { return weights[std::size_t(i)]; }, s);
    return s;
  }

  [[no_unique_address]] Group group_;
  bool present_;
  CorrectionWeights<T> weights_;
};

// v_{n+1} = sum - h^2 L(v_{n+1}) solved by fixed-point sweeps: a sweep gains a factor of h |v| alpha_0 / 12 and more, at
// most 0.64 for an increment that turns by less than pi (k = 6).
template <MechanicalSystem S>
struct ImplicitCorrectionClosure {
  using T = typename S::Scalar;
  using Linear = LinearScalar<T>;
  using Group = typename S::Group;
  [[no_unique_address]] Group group;
  AffineClosure<S> affine;  // for kappa_{n+1} = kappa_n
  T h;
  Velocity<S> kappa;  // kappa_n
  bool higher;
  // a, b, c = slope (v_{n+1} - v_n) + what the velocities so far give
  std::array<T, 3> slopes;
  std::array<Velocity<S>, 3> known;

  const Velocity<S>& base() const { return affine.base_increment; }
  Velocity<S> increment(const Velocity<S>& d) const { return affine.base_increment + d; }

  ClosureValues<S> at(const Velocity<S>& d) const {
    ClosureValues<S> values = affine.at(d);
    const Velocity<S> fixed = values.velocity_change - kappa;
    Velocity<S>& change = values.velocity_change;
    Velocity<S> correction = -kappa;
    const Linear unit = 0.5 * to_double(Eigen::NumTraits<T>::epsilon());
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      const Velocity<S> next = scaled_correction(change);
      const Linear moved = largest(next - correction);
      correction = next;
      change = fixed - correction;
      if (!(moved > unit * (largest(change) + largest(correction)))) break;  // a NaN ends it, too
    }
    values.velocity = affine.velocity + change;
    // h v' = gamma_1 (v_{n+1} - v_n) + the earlier changes.
    values.scaled_acceleration +=
        affine.velocity_slope * (change - (affine.velocity_slope * d + affine.velocity_change));
    return values;
  }

  // (I - N)^{-1} gamma_1 up to N^3, with N the derivative of -h/12 [v, a] with respect to v.
  [[gnu::noinline]] ClosureDerivatives<DerivativeMatrix<S>> linearization(const Velocity<S>& d) const {
    const auto linear_group = linear_group_of<S>(group);
    using Matrix = DerivativeMatrix<S>;
    const ClosureValues<S> values = at(d);
    const Linear slope = to_linear(affine.velocity_slope);
    const Matrix N = to_linear(h) / Linear(12.0) *
                     (linear_group.ad(derivative(0, values.velocity_change).template cast<Linear>()) -
                      to_linear(slopes[0]) * linear_group.ad(values.velocity.template cast<Linear>()));
    const Matrix I = identity_like(N);
    const Matrix dv = slope * (I + N * (I + N));
    return {dv, slope * dv};
  }

 private:
  static constexpr int most_sweeps = 60;

  // h^2 L(v_n + change)
  Velocity<S> scaled_correction(const Velocity<S>& change) const {
    const Velocity<S> v = affine.velocity + change;
    if (!higher) return leading_correction(group, h, v, derivative(0, change));
    return full_correction(group, h, v, derivative(0, change), derivative(1, change), derivative(2, change));
  }
  Velocity<S> derivative(std::size_t order, const Velocity<S>& change) const {
    return slopes[order] * change + known[order];
  }
  template <class Vector>
  static Linear largest(const Vector& v) {
    return v.eval().template cast<Linear>().template lpNorm<Eigen::Infinity>();
  }
};

template <MechanicalSystem S>
class ImplicitCorrection {
 public:
  using T = typename S::Scalar;

  template <class Options>
  ImplicitCorrection(const S& system, const Options& options)
      : group_(group_of(system)), zero_(zero_velocity(system)), weights_(options.k) {}

  void start(std::span<const Configuration<S>>) {}
  bool defined(const BdfState<S>&) const { return true; }
  void accept(const Configuration<S>&) {}

  ImplicitCorrectionClosure<S> closure(const BdfState<S>& state, const AffineClosure<S>& affine) const {
    ImplicitCorrectionClosure<S> closure{.group = group_,
                                         .affine = affine,
                                         .h = state.h,
                                         .kappa = state.kappa,
                                         .higher = weights_.higher,
                                         .slopes = {},
                                         .known = {}};
    for (std::size_t order = 0; order < 3; ++order) {
      const auto& weights = weights_.implicit_derivative[order];
      closure.slopes[order] = weights[0];
      closure.known[order] = zero_;
      if (order > 0 && !weights_.higher) continue;
      for (int i = 1; i < weights_.implicit_changes; ++i)
        closure.known[order] += weights[std::size_t(i)] * state.velocity_changes[i - 1];
    }
    return closure;
  }

 private:
  [[no_unique_address]] typename S::Group group_;
  Velocity<S> zero_;
  CorrectionWeights<T> weights_;
};

}  // namespace liebench
