#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "groups/entrywise.h"
#include "integrators/audit.h"
#include "integrators/inlining.h"
#include "integrators/outcome.h"
#include "integrators/step_equation.h"
#include "integrators/step_matrix.h"

// The Newton kernel that solves the step equation of every method: StepEquation with its matrix, or another with the same functions
// (MomentumEquation; integrators/radau_equation.h with a matrix of its own).
//
// Simplified Newton iteration: one factorization serves iterations and steps until a fresh one is cheaper.
// The residual is evaluated in the scalar T of the run, matrix and correction in LinearScalar<T>, double (iterative
// refinement: in extended precision each correction still gains the digits that double has).
//
// Stopping rule. Let s_i be the size of the i-th correction in units of round-off of the unknowns, and
// theta = s_i / s_{i-1} the observed contraction. The iteration ends
//   - converged, when s_i or the predicted next one, theta s_i, is below 1/20;
//   - converged at the round-off floor, when corrections no longer shrink by a factor of 2 and s_i is below 32, or,
//     with a matrix formed in this step, below 1e5, the floor that the condition of the matrix allows; the multipliers of nearly
//     dependent constraints more, see at_floor();
//   - newton_diverged, when above that floor, with a matrix formed in this step, a correction grows after one that did not
//     shrink by a factor of 2; after 60 iterations; or when an increment turns by more than 1e8 rad.
// The round-off unit of d is eps times |d| + |Dq| / 100, and eps |q| / h in addition where a constraint is present:
// Phi is known to eps |q| only, and its row is Phi / h. That of h lambda is eps |h lambda| and the unit of d through
// the mass matrix. (A tolerance of eps |Dq| would do for the increment, but what it leaves of the residual acts like
// a force eps |v| / h in every step.)

namespace liebench {

template <MechanicalSystem S, Form form, class Audit, class StepEquationType = StepEquation<S, form>,
          class StepMatrix = typename StepMatrixOf<S, form>::type>
class NewtonKernel {
 public:
  using T = typename S::Scalar;
  using Linear = LinearScalar<T>;
  using Equation = StepEquationType;
  using Unknowns = typename Equation::Unknowns;
  using Point = typename Equation::Point;
  static constexpr int m = Equation::m;
  static constexpr int l = Equation::l;
  static constexpr int n = Equation::n;

  explicit NewtonKernel(const S& system) : system_(system), matrix_(system) {}

  const S& system() const { return system_; }
  const Audit& audit() const { return audit_; }
  Audit& audit() { return audit_; }

  // The next step size, or closure, is another one: solve() forms its matrix anew.
  void outdate() { outdated_ = true; }

  // The part of a velocity w at q that the constraint allows, w - M^{-1} B^T mu with B w = 0 afterwards, by the matrix of the last
  // step, from J (d, h lambda) = (M w, 0): as good as M and B are in it, and less what is stiff there. `slope` is the factor of M in J.
  Velocity<S> tangential_part(const Configuration<S>& q, const Velocity<S>& w, const T& slope) {
    Unknowns r = Equation::unknowns(system_);
    r.setConstant(T(0.0));
    Equation::change(r, system_) = system_.momentum(q, w);
    const Correction d = matrix_.solve(in_linear_scalar(r));
    audit_.solve();
    return slope * Equation::change(d, system_).template cast<T>();
  }

  // Solves the step equation from the prediction in z; leaves the solution in z and the new state in `point`. Not to be
  // inlined: all methods whose closures are of one type share its code. In double all that it calls is, so that the small
  // matrices stay in registers.
  template <class Closure>
  [[gnu::noinline]] StepResult solve(const T& t, const T& h, const Configuration<S>& q_n,
                                     const Closure& closure, Unknowns& z, Point& point) {
    if constexpr (inlines_all<S>) {
      return solve_inlined(t, h, q_n, closure, z, point);
    } else {
      return iterate(t, h, q_n, closure, z, point);
    }
  }

  // The same by a damped iteration, from where `z` is: slower, and for what the one above gives up. A correction d is taken as z - mu d
  // with the largest mu = 1, 1/2, ... for which the next simplified correction is smaller, |J^{-1} r(z - mu d)| <= (1 - mu / 4) |d| [the
  // natural monotonicity test, Deuflhard 2004, Newton Methods for Nonlinear Problems, ch. 3.3]; every correction has a matrix of its
  // own. Where no mu is small enough the iteration has converged if rounding is what is left (at_rounding()), or has diverged.
  template <class Closure>
  [[gnu::noinline, gnu::cold]] StepResult solve_damped(const T& t, const T& h, const Configuration<S>& q_n,
                                                       const Closure& closure, Unknowns& z, Point& point) {
    const Linear scale = fixed_scale(closure, q_n, to_linear(h));
    Unknowns r = Equation::unknowns(system_), tried = z;
    const auto residual_at = [&](const Unknowns& at) {
      Equation::evaluate(system_, h, q_n, closure, at, point);
      Equation::residual(system_, t, h, point, at, r);
      audit_.iteration();
    };
    Linear previous_size(0.0);
    residual_at(z);
    for (int iteration = 1; iteration <= max_damped_iterations; ++iteration) {
      if (!is_finite(r)) return failure(Outcome::non_finite, r);
      if (const Outcome formed = factorize(t, h, q_n, closure, z, z, FactorizationCause::slow_convergence);
          formed != Outcome::ok)
        return failure(formed, r);
      const Correction d = matrix_.solve(in_linear_scalar(r));
      audit_.solve();
      Linear largest_d;
      const Linear size = weighted_norm(d, z, scale, largest_d);
      if (!std::isfinite(to_double(size))) return failure(Outcome::non_finite, r);
      if (size <= unit) {
        z -= d.template cast<T>();
        Equation::evaluate(system_, h, q_n, closure, z, point);
        finish(iteration);
        return {};
      }
      // Where the corrections have stopped to converge quadratically, rounding may be all that is left; smaller steps would creep.
      if (iteration > 1 && size > Linear(slowest_rate) * previous_size &&
          at_rounding(t, h, q_n, d, z, point, r)) {
        finish(iteration);
        return {};
      }
      previous_size = size;
      bool shrunk = false;
      for (int halvings = 0; halvings <= most_halvings && !shrunk; ++halvings) {
        const Linear mu = std::ldexp(1.0, -halvings);
        tried = z - (mu * d).template cast<T>();
        residual_at(tried);
        if (!is_finite(r)) continue;
        const Correction next = matrix_.solve(in_linear_scalar(r));
        audit_.solve();
        Linear unused;
        shrunk = weighted_norm(next, z, scale, unused) <= (Linear(1.0) - mu / Linear(4.0)) * size;
      }
      if (shrunk) {
        z = tried;
        continue;
      }
      residual_at(z);
      if (at_rounding(t, h, q_n, d, z, point, r)) {
        finish(iteration);
        return {};
      }
      return failure(Outcome::newton_diverged, r);
    }
    return failure(Outcome::newton_diverged, r);
  }

 private:
  template <class Closure>
  [[gnu::flatten]] StepResult solve_inlined(const T& t, const T& h, const Configuration<S>& q_n,
                                            const Closure& closure, Unknowns& z, Point& point) {
    return iterate(t, h, q_n, closure, z, point);
  }

  template <class Closure>
  StepResult iterate(const T& t, const T& h, const Configuration<S>& q_n, const Closure& closure, Unknowns& z,
                     Point& point) {
    bool fresh = false;    // the matrix was formed in this step
    bool stalled = false;  // the last increment did not shrink, with a fresh matrix
    Linear previous = 0.0;
    const Linear scale = fixed_scale(closure, q_n, to_linear(h));
    Unknowns r = Equation::unknowns(system_);
    if (!factorized_ || outdated_ || marginal_cost_exceeds_average()) {
      const auto cause = factorized_ ? FactorizationCause::refresh : FactorizationCause::first;
      if (const Outcome formed = factorize(t, h, q_n, closure, z, z, cause); formed != Outcome::ok)
        return {formed};
      fresh = true;
    }
    for (int iteration = 1;; ++iteration) {
      // One place each where a point is evaluated in the loop and behind it: so the compiler keeps it in registers.
      Equation::evaluate(system_, h, q_n, closure, z, point);
      Equation::residual(system_, t, h, point, z, r);
      audit_.iteration();
      const Correction d = matrix_.solve(in_linear_scalar(r));
      audit_.solve();
      const Unknowns before = z;
      set(z, z - d.template cast<T>());
      Linear largest_d;
      const Linear size = weighted_norm(d, z, scale, largest_d);
      if (!std::isfinite(to_double(size))) return failure(Outcome::non_finite, r);
      if constexpr (may_have_commutators<S>())
        if (to_double(largest_d * abs_of(to_linear(h))) > farthest)
          return failure(Outcome::newton_diverged, r);

      // Below one unit a size is noise: it bounds the rate, it does not measure it.
      const Linear rate = iteration > 1 ? std::max(size, Linear(1.0)) / previous : rate_;
      if (size <= unit || rate * size <= unit) {
        rate_ = fresh ? Linear(1.0) : std::min(Linear(1.0), rate * safety);
        finish(iteration);
        break;
      }
      if (iteration > 1 && rate > slowest_rate) {
        if (size <= noise_ || (fresh && at_floor(size, d, scale, largest_d))) {
          if (fresh) noise_ = std::clamp(noise_growth * to_double(size), noise, matrix_.most_noise());
          finish(iteration);
          break;
        }
        if (!fresh) {
          const Outcome formed =
              factorize(t, h, q_n, closure, before, z, FactorizationCause::slow_convergence);
          if (formed != Outcome::ok) return failure(formed, r);
          fresh = true;
        } else if (stalled && rate > 1.0) {
          return failure(Outcome::newton_diverged, r);
        } else {
          stalled = true;
        }
      } else {
        stalled = false;
      }
      if (iteration == max_iterations) return failure(Outcome::newton_diverged, r);
      previous = size;
    }
    Equation::evaluate(system_, h, q_n, closure, z, point);
    return {};
  }

  static constexpr int max_iterations = 60;
  static constexpr int max_damped_iterations = 100;
  static constexpr int most_halvings = 40;
  // rad: no sine is worth taking beyond.
  static constexpr double farthest = 1e8;
  static constexpr double slowest_rate = 0.5;
  // The rate of a factorization grows as it ages: a rate seen before counts for twice as much, so that it is
  // seen anew before it can mislead. That of the step it was made in says nothing of the next: the matrix was that of this
  // step, and is one step old then.
  static constexpr double safety = 2.0;
  // In units of round-off: the tolerance; what a stalled iteration is allowed where the matrix may be old, at least; and where
  // it is fresh, because residual round-off reaches the unknowns through the inverse of the matrix (condition 3.6e3 for the
  // top). Where a fresh one stalls, an old one will, too, and may where a matrix is dear (most_noise()): a chain of a thousand
  // bodies stalls at a hundred units, and would ask for a new one in every step.
  static constexpr double unit = 0.05;
  static constexpr double noise = 32.0;
  static constexpr double floor = 1e5;
  static constexpr double noise_growth = 4.0;
  // Of a residual: sums of some dozen products, and what they are made of.
  static constexpr double rounding = 256.0;

  using Correction = Eigen::Matrix<Linear, n, 1, 0, Equation::most, 1>;

  // r itself where T is the scalar of the linear algebra.
  static decltype(auto) in_linear_scalar(const Unknowns& r) {
    if constexpr (std::is_same_v<T, Linear>)
      return (r);
    else
      return Correction(r.template cast<Linear>());
  }

  // What round-off of d is relative to, apart from d itself.
  template <class Closure>
  Linear fixed_scale(const Closure& closure, const Configuration<S>& q_n, const Linear& h) const {
    Linear scale = Linear(0.01) * largest_entry(closure.base().template cast<Linear>());
    if (multiplier_size(system_) != 0)
      scale += largest_entry(S::Group::stacked(q_n).template cast<Linear>()) / abs_of(h);
    return scale;
  }

  // Where constraints depend on each other but for an angle 1 / c (a four-bar that is nearly flat), the position is known to c
  // units along the direction that they hardly hold, and the multipliers, which answer by M d / h^2 along it, to c^2. One
  // correction tells c to a factor of `noise`.
  bool at_floor(const Linear& size, const Correction& d, const Linear& scale, const Linear& largest_d) const {
    if (size <= floor) return true;
    // A system of fixed size is none of these: where it stalls that far above the floor, the step is too large.
    if (matrix_.most_noise() <= noise) return false;
    const Linear c =
        relative(Equation::change(d, system_).template lpNorm<Eigen::Infinity>(), scale + largest_d);
    return c <= floor && size <= noise * noise * c * c;
  }

  // What rounding leaves: a correction that moves q by no more units of its round-off than `noise`, or a residual that is no more
  // units of the sums that it is the difference of, group by group of rows, than `rounding`. The light bodies of a scene know their
  // acceleration to what the heavy ones round away, and a thin rod the one about its axis to what those across leave.
  bool at_rounding(const T& t, const T& h, const Configuration<S>& q_n, const Correction& d,
                   const Unknowns& z, const Point& point, const Unknowns& r) const {
    const auto largest = [](const auto& v) {
      return v.size() == 0 ? Linear(0.0) : to_linear(T(v.template lpNorm<Eigen::Infinity>()));
    };
    const Linear eps(to_double(Eigen::NumTraits<T>::epsilon()));
    const Linear step = abs_of(to_linear(h));
    const Linear position = largest(S::Group::stacked(q_n)) / step;
    if (Equation::change(d, system_).template lpNorm<Eigen::Infinity>() <= Linear(noise) * eps * position)
      return true;
    const Linear allowed = Linear(rounding) * eps;
    const auto& v = point.values.velocity;
    Linear sum = largest(Velocity<S>(system_.momentum(point.q, point.values.scaled_acceleration))) +
                 step * largest(Velocity<S>(system_.force(t, point.q, v)));
    if constexpr (l != 0)
      if (multiplier_size(system_) != 0) {
        const Multipliers<S> lambda = Equation::scaled_lambda(z, system_);
        sum += largest(Velocity<S>(system_.constraint_force(point.q, lambda)));
        if (!(largest(Multipliers<S>(Equation::scaled_lambda(r, system_))) <= allowed * position))
          return false;
        if constexpr (Equation::stabilized)
          if (!(largest(Multipliers<S>(Equation::eta(r, system_))) <=
                allowed * largest(v) * std::max(Linear(1.0), position * step)))
            return false;
      }
    return largest(Velocity<S>(Equation::change(r, system_))) <= allowed * sum;
  }
  static bool is_finite(const Unknowns& r) { return std::isfinite(to_double(T(r.squaredNorm()))); }

  // Corrections in units of round-off of the unknowns; and the largest |d_i| of z.
  [[gnu::always_inline]] Linear weighted_norm(const Correction& d, const Unknowns& z, Linear scale,
                                              Linear& largest_d) const {
    decltype(auto) z_linear = in_linear_scalar(z);
    largest_d = largest_entry(Equation::change(z_linear, system_));
    scale += largest_d;
    Linear largest = largest_entry(Equation::change(d, system_));
    if constexpr (Equation::stabilized) largest = std::max(largest, largest_entry(Equation::eta(d, system_)));
    Linear size = relative(largest, scale);
    if (multiplier_size(system_) != 0) {
      const Linear multiplier_scale =
          largest_entry(Equation::scaled_lambda(z_linear, system_)) + matrix_.mass_scale() * scale;
      size = std::max(size, relative(largest_entry(Equation::scaled_lambda(d, system_)), multiplier_scale));
    }
    return size;
  }

  static Linear relative(const Linear& value, const Linear& scale) {
    const double eps = to_double(Eigen::NumTraits<T>::epsilon());
    return value / (Linear(eps) * scale + Linear(std::numeric_limits<double>::min()));
  }

  // At the point of `at`, with the multipliers of z.
  template <class Closure>
  [[gnu::noinline]] Outcome factorize(const T& t, const T& h, const Configuration<S>& q_n,
                                      const Closure& closure, const Unknowns& at, const Unknowns& z,
                                      FactorizationCause cause) {
    Point point;
    Equation::evaluate(system_, h, q_n, closure, at, point);
    const Outcome formed = matrix_.factorize(system_, t, h, q_n, closure, point, z);
    factorized_ = formed == Outcome::ok;
    outdated_ = false;
    audit_.factorization(cause);
    spent_ = matrix_.factorization_cost();
    steps_ = 0;
    last_ = 0;
    rate_ = 1.0;
    return formed;
  }

  void finish(int iterations) {
    spent_ += iterations;
    ++steps_;
    last_ = iterations;
  }

  StepResult failure(Outcome outcome, const Unknowns& r) {
    factorized_ = false;
    return {outcome, to_double(in_linear_scalar(r).template lpNorm<Eigen::Infinity>())};
  }

  // A factorization is worth keeping while one more step with it costs less than the steps since it was made
  // did on average, itself included.
  bool marginal_cost_exceeds_average() const { return steps_ > 0 && last_ * steps_ > spent_; }

  S system_;
  StepMatrix matrix_;
  bool factorized_ = false;
  bool outdated_ = false;  // outdate()
  Linear rate_ = 1.0;      // contraction seen with this factorization
  double noise_ = noise;   // what a stalled iteration is allowed with an old matrix
  double spent_ = 0.0;
  int steps_ = 0;  // steps since the factorization
  int last_ = 0;   // iterations of the last one
  [[no_unique_address]] Audit audit_;
};

}  // namespace liebench
