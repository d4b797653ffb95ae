#pragma once

#include <Eigen/Core>

#include "problems/system.h"

// The nonlinear system of one step, the same for every method:
//
//   r(Dq, lambda) = M(q) v' + g(t, q, v) + B(q)^T lambda = 0,   Phi(q) = 0,   q = q_n o exp(h Dq~)
//
// A method enters only through its closure, which gives v and v' as functions of the increment Dq. The system
// is scaled by the step size: rows h r and Phi / h, unknowns Dq and h lambda, so that the Newton matrix
//
//   [ h M dv'/dDq + h C dv/dDq + h^2 K T(h Dq)    B^T ]
//   [ B T(h Dq)                                    0  ]
//
// keeps its condition as h -> 0 (heavy top: 3.6e3 for every h; unscaled it grows as h^-3 to h^-4).

namespace liebench {

// Closure of the methods whose v and v' are affine in the increment (BLieDF2nd, generalized-alpha):
//   v = velocity_slope Dq + velocity_offset,   h v' = acceleration_slope Dq + acceleration_offset
template <MechanicalSystem S>
struct AffineClosure {
  using T = typename S::Scalar;
  T velocity_slope;
  Velocity<S> velocity_offset;
  T acceleration_slope;
  Velocity<S> acceleration_offset;

  Velocity<S> velocity(const Velocity<S>& increment) const {
    return velocity_slope * increment + velocity_offset;
  }
  Velocity<S> scaled_acceleration(const Velocity<S>& increment) const {
    return acceleration_slope * increment + acceleration_offset;
  }
  // Derivatives of both with respect to the increment: a number or an m x m matrix.
  const T& velocity_derivative() const { return velocity_slope; }
  const T& scaled_acceleration_derivative() const { return acceleration_slope; }
};

template <MechanicalSystem S>
class StepEquation {
 public:
  using T = typename S::Scalar;
  static constexpr int m = S::Group::dimension;
  static constexpr int l = S::constraints;
  using Unknowns = Eigen::Matrix<T, m + l, 1>;  // (Dq, h lambda)

  // The new state that belongs to given unknowns.
  struct Point {
    Configuration<S> q;
    Velocity<S> v;
    Velocity<S> scaled_acceleration;  // h v'
  };

  template <class Closure>
  static Point point(const Configuration<S>& q_n, const T& h, const Closure& closure, const Unknowns& z) {
    const Velocity<S> increment = z.template head<m>();
    return {S::Group::compose(q_n, S::Group::exp(h * increment)), closure.velocity(increment),
            closure.scaled_acceleration(increment)};
  }

  // (h r, Phi / h)
  static Unknowns residual(const S& system, const T& t, const T& h, const Point& p, const Unknowns& z) {
    Unknowns r;
    r.template head<m>() = system.momentum(p.q, p.scaled_acceleration) + h * system.force(t, p.q, p.v);
    if constexpr (l > 0) {
      const Multipliers<S> scaled_lambda = z.template tail<l>();
      r.template head<m>() += system.constraint_force(p.q, scaled_lambda);
      r.template tail<l>() = system.constraint(p.q) / h;
    }
    return r;
  }

  // The Newton matrix at the point, row by row.
  template <class Matrix, class VelocityDerivative, class AccelerationDerivative>
  static void jacobian(const S& system, const T& t, const T& h, const Point& p, const Unknowns& z,
                       const VelocityDerivative& dv, const AccelerationDerivative& h_da, Matrix& J) {
    const Velocity<S> step = h * z.template head<m>();
    const Velocity<S> acceleration = p.scaled_acceleration / h;
    Multipliers<S> lambda;
    if constexpr (l > 0) lambda = z.template tail<l>() / h;
    const VelocityMatrix<S> K = system.stiffness(t, p.q, p.v, acceleration, lambda);
    J.template topLeftCorner<m, m>() = system.mass_matrix(p.q) * h_da +
                                       (h * system.damping(t, p.q, p.v)) * dv +
                                       (h * h) * S::Group::times_tangent(K, step);
    if constexpr (l > 0) {
      const ConstraintGradient<S> B = system.constraint_gradient(p.q);
      J.template topRightCorner<m, l>() = B.transpose();
      J.template bottomLeftCorner<l, m>() = S::Group::times_tangent(B, step);
      J.template bottomRightCorner<l, l>().setConstant(T(0.0));
    }
  }
};

}  // namespace liebench
