#pragma once

#include <type_traits>

#include "integrators/dense_lu.h"
#include "integrators/outcome.h"
#include "integrators/step_equation.h"

namespace liebench {

// The Newton matrix of the step equation and what solves with it: in the scalar of the linear algebra, whatever that of the
// run. Dense, for small systems of fixed size.
template <DenseSystem S, Form form>
class DenseStepMatrix {
 public:
  using T = typename S::Scalar;
  using Linear = LinearScalar<T>;
  using Equation = StepEquation<S, form>;
  using Unknowns = typename Equation::Unknowns;
  using Point = typename Equation::Point;
  using Lu = DenseLu<Linear, Equation::n>;
  using Correction = typename Lu::Vector;
  static constexpr int m = Equation::m;

  explicit DenseStepMatrix(const S& system) : linear_system_(system.template cast<Linear>()) {}

  // Forms the matrix at the point, with the multipliers of z, and factorizes it.
  template <class Closure>
  Outcome factorize(const S& system, const T& t, const T& h, const Configuration<S>& q_n,
                    const Closure& closure, const Point& point, const Unknowns& z) {
    const auto derivatives = closure.linearization(point.change);
    if constexpr (std::is_same_v<T, Linear>) {
      return factorize_at(system, t, h, q_n, derivatives, point, z);
    } else {
      typename Lu::Matrix J;
      using LinearEquation = StepEquation<LinearSystem, form>;
      typename LinearEquation::Point linear_point;
      linear_point.step = point.step.template cast<Linear>();
      linear_point.q = S::Group::template cast<Linear>(point.q);
      linear_point.values.velocity = point.values.velocity.template cast<Linear>();
      linear_point.values.scaled_acceleration = point.values.scaled_acceleration.template cast<Linear>();
      LinearEquation::jacobian(linear_system_, to_linear(t), to_linear(h),
                               S::Group::template cast<Linear>(q_n), linear_point, z.template cast<Linear>(),
                               derivatives, J);
      return factorize(J);
    }
  }
  // The same with known derivatives of the closure.
  template <class Derivatives>
  Outcome factorize_at(const S& system, const T& t, const T& h, const Configuration<S>& q_n,
                       const Derivatives& derivatives, const Point& point, const Unknowns& z) {
    typename Lu::Matrix J;
    Equation::jacobian(system, t, h, q_n, point, z, derivatives, J);
    return factorize(J);
  }

  Correction solve(const Correction& r) const { return lu_.solve(r); }

  // Of Jacobian and factorization, in units of one iteration (residual and back-substitution), measured.
  static constexpr double factorization_cost() { return 2.0; }
  // Up to which size a stalled iteration with an old matrix may learn to end, in units of round-off: a fresh one costs little, and
  // keeps the noise of lambda lower.
  static constexpr double most_noise() { return 32.0; }
  // The largest entry of the block of the equations of motion.
  const Linear& mass_scale() const { return mass_scale_; }

 private:
  Outcome factorize(const typename Lu::Matrix& J) {
    mass_scale_ = J.template topLeftCorner<m, m>().template lpNorm<Eigen::Infinity>();
    if (lu_.factorize(J)) return Outcome::ok;
    return J.allFinite() ? Outcome::singular_matrix : Outcome::non_finite;
  }

  using LinearSystem = typename S::template rebind<Linear>;
  LinearSystem linear_system_;
  Lu lu_;
  Linear mass_scale_ = 0.0;
};

// The matrix that a system is solved with: its own where it has one.
template <MechanicalSystem S, Form form>
struct StepMatrixOf {
  using type = typename S::template StepMatrix<form>;
};
template <DenseSystem S, Form form>
struct StepMatrixOf<S, form> {
  using type = DenseStepMatrix<S, form>;
};

}  // namespace liebench
