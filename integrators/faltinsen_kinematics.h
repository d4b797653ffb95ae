#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <type_traits>

#include "integrators/affine_closure.h"
#include "integrators/bdf_stepper.h"

// The kinematic equation of the BDF methods of Faltinsen, Marthinsen & Munthe-Kaas 2001, in canonical coordinates about
// q_n: q(t) = q_n o exp(s~(t)), s' = T^{-1}(s) v. With s_j the coordinates of q_j, and u = s_{n+1} = h Dq_n, s_n = 0,
//
//   v_{n+1} = T(u) w,   w = (1/h) sum_{i=0}^k alpha_i s_{n+1-i}
//
// s_{n-1} = -h Dq_{n-1} exactly. The others have, by (5) and with s_{n-i} = -h (Dq_{n-1} + ... + Dq_{n-i} - c_i),
//
//   w = sum_{i=1}^k gamma_i Dq_{n+1-i} + C,   C = alpha_3 c_2 + alpha_4 c_3
//
// T(u) u = u, so that T(u) acts on x = w - u alone, which is small: it is formed from the changes of the increments.
//
//   kappa = C + (T(u) - I) x
//
// k = 2, 3, 4; for k = 1, and for k = 2 with `bch`, kappa = 0 (ExplicitCorrection without a correction).
// Variants: `exact` takes c_2, c_3 from logarithms of products of exponentials; `bch` takes the series of Baker, Campbell
// and Hausdorff, and that of T, as far as order k asks, with the least number of commutators (1 + 1 for k = 3, 3 + 2 for
// k = 4; k = 2 needs none and is BLieDF2nd).

namespace liebench {

// T(s) w = sum_j (-1)^j / (j+1)! ad(s)^j w, and its derivative with respect to s, by terms up to `most`; the sum ends where
// the next term is below 1e-4 of w: for Newton matrices.
template <class Group>
struct TangentSeries {
  typename Group::TangentMatrix tangent;     // T(s)
  typename Group::TangentMatrix derivative;  // D_s (T(s) w)

  TangentSeries(const Group& group, const typename Group::Tangent& s, const typename Group::Tangent& w,
                int most) {
    using T = typename Group::Scalar;
    using Matrix = typename Group::TangentMatrix;
    using std::abs;
    const Matrix A = group.ad(s);
    Matrix power = identity_like(A), Y = zero_like(A);
    typename Group::Tangent y = w;
    tangent = power;
    derivative = Y;
    T factor = 1.0;
    for (int j = 1; j <= most; ++j) {
      factor /= T(-(j + 1.0));
      Y = (A * Y - group.ad(y)).eval();
      y = (A * y).eval();
      power = (A * power).eval();
      tangent += factor * power;
      derivative += factor * Y;
      if (power.template lpNorm<Eigen::Infinity>() * abs(factor) < T(1e-4) && j > 1) break;
    }
  }
};

template <MechanicalSystem S, bool exact>
struct FaltinsenClosure {
  using T = typename S::Scalar;
  using Group = typename S::Group;
  [[no_unique_address]] Group group;
  AffineClosure<S> affine;  // for kappa_{n+1} = kappa_n
  T h;
  Velocity<S> kappa;  // kappa_n
  Velocity<S> C;
  // x = x_slope d + x_known
  T x_slope;
  Velocity<S> x_known;
  int terms;  // of the truncated T, beyond I

  const Velocity<S>& base() const { return affine.base_increment; }
  Velocity<S> increment(const Velocity<S>& d) const { return affine.base_increment + d; }

  ClosureValues<S> at(const Velocity<S>& d) const {
    ClosureValues<S> values = affine.at(d);
    const Velocity<S> u = h * increment(d);
    const Velocity<S> kappa_change = C + bend(u, x_slope * d + x_known) - kappa;
    values.velocity_change += kappa_change;
    values.velocity += kappa_change;
    values.scaled_acceleration += affine.velocity_slope * kappa_change;
    return values;
  }

  // v = T(u) w: dv/dd = T(u) gamma_1 + h D_s (T(s) w) at s = u
  [[gnu::noinline]] ClosureDerivatives<DerivativeMatrix<S>> linearization(const Velocity<S>& d) const {
    using Linear = LinearScalar<T>;
    const auto linear_group = linear_group_of<S>(group);
    using LinearGroup = std::remove_cvref_t<decltype(linear_group)>;
    const Velocity<S> Dq = increment(d);
    const Linear slope = to_linear(affine.velocity_slope), step = to_linear(h);
    const typename LinearGroup::Tangent u = step * Dq.template cast<Linear>();
    const typename LinearGroup::Tangent w = (Dq + x_slope * d + x_known).eval().template cast<Linear>();
    const TangentSeries<LinearGroup> series(linear_group, u, w, exact ? most_terms : terms);
    const DerivativeMatrix<S> dv = slope * series.tangent + step * series.derivative;
    return {dv, slope * dv};
  }

 private:
  static constexpr int most_terms = 20;

  // (T(u) - I) x
  Velocity<S> bend(const Velocity<S>& u, const Velocity<S>& x) const {
    if constexpr (exact) {
      return group.tangent_times(u, x) - x;
    } else {
      const Velocity<S> once = group.commutator(u, x);
      if (terms == 1) return T(-0.5) * once;
      return group.commutator(u, once) / T(6.0) - T(0.5) * once;
    }
  }
};

template <MechanicalSystem S, bool exact>
class FaltinsenKinematics {
 public:
  using T = typename S::Scalar;
  using Group = typename S::Group;
  static constexpr int most_steps = 4;

  template <class Options>
  FaltinsenKinematics(const S& system, const Options& options)
      : group_(group_of(system)), zero_(zero_velocity(system)), k_(options.k) {
    if constexpr (exact) motions_.fill(group_.identity());
  }

  void start(std::span<const Configuration<S>> motions) {
    for (const Configuration<S>& motion : motions) accept(motion);
  }

  void accept(const Configuration<S>& motion) {
    if constexpr (exact) {
      motions_[2] = motions_[1];
      motions_[1] = motions_[0];
      motions_[0] = motion;
    }
  }

  // The logarithms are those of the motion while it turns by less than pi over all of them.
  bool defined(const BdfState<S>& state) const {
    return !exact || k_ < 3 || to_double(state.turn(group_, k_ - 1)) < std::numbers::pi;
  }

  FaltinsenClosure<S, exact> closure(const BdfState<S>& state, const AffineClosure<S>& affine) const {
    const auto& gamma = state.coefficients.gamma;
    FaltinsenClosure<S, exact> closure{.group = group_,
                                       .affine = affine,
                                       .h = state.h,
                                       .kappa = state.kappa,
                                       .C = history_term(state),
                                       .x_slope = gamma[0] - T(1.0),
                                       .x_known = {},
                                       .terms = k_ - 2};
    // x = sum_{i=2}^k gamma_i (Dq_{n+1-i} - Dq_n) + C, Dq_{n+1-i} - Dq_n = -(d_n + ... + d_{n+2-i})
    closure.x_known = closure.C;
    T tail = T(1.0) - gamma[0];  // sum_{i > j} gamma_i
    for (int j = 2; j < k_; ++j) {
      tail = tail - gamma[std::size_t(j - 1)];
      closure.x_known -= tail * state.increment_changes[j - 2];
    }
    return closure;
  }

 private:
  // C = alpha_3 c_2 + alpha_4 c_3
  Velocity<S> history_term(const BdfState<S>& state) const {
    if (k_ < 3) return zero_;
    const auto& alpha = state.coefficients.alpha;
    const Velocity<S>& A = state.increment;
    const Velocity<S>& d1 = state.increment_changes[0];
    const Velocity<S>& d2 = state.increment_changes[1];
    if constexpr (exact) {
      const Velocity<S> B = A - d1;
      // s_{n-2} = log(exp(-h A) exp(-h B)) = -log(exp(h B) exp(h A))
      const Configuration<S> two = group_.compose(motions_[1], motions_[0]);
      Velocity<S> C = alpha[3] * (A + B - group_.log(two) / state.h);
      if (k_ == 4) {
        const Velocity<S> third = B - d2;
        C += alpha[4] * (A + B + third - group_.log(group_.compose(motions_[2], two)) / state.h);
      }
      return C;
    } else {
      // s_{n-2} = -h (A + B) + 1/2 [h A, h B], [A, B] = -[A, d1]
      const Velocity<S> c2 = (state.h / T(-2.0)) * group_.commutator(A, d1);
      Velocity<S> C = alpha[3] * c2;
      if (k_ == 4) {
        // s_{n-3} = s - c - z/2 - [s + c, z]/12 with s = s_{n-2}, c = h Dq_{n-3}, z = [s, c] = [s + 2 c, c]
        const Velocity<S> third = A - d1 - d2;
        const Velocity<S> z = group_.commutator(c2 - d1 - T(2.0) * d2, third);  // z / h^2
        const Velocity<S> s_plus_c = c2 - A - d2;  // (s + c) / h, A + B - c = A + d2
        C += alpha[4] *
             (c2 - (state.h / T(2.0)) * z - (state.h * state.h / T(12.0)) * group_.commutator(s_plus_c, z));
      }
      return C;
    }
  }

  struct Nothing {};
  using Motions =
      std::conditional_t<exact, std::array<Configuration<S>, std::size_t(most_steps - 1)>, Nothing>;
  [[no_unique_address]] Group group_;
  Velocity<S> zero_;
  int k_;
  [[no_unique_address]] Motions motions_{};  // q_{n-1}^{-1} o q_n, q_{n-2}^{-1} o q_{n-1}, ...
};

}  // namespace liebench
