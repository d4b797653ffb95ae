#pragma once

#include <Eigen/Core>

#include "problems/system.h"

// The nonlinear system of one step, the same for every method:
//
//   r(Dq, lambda) = M(q) v' + g(t, q, v) + B(q)^T lambda = 0,   Phi(q) = 0,   q = q_n o exp(h Dq~)
//
// A method enters only through its closure, which gives v and v' as functions of the increment Dq. The
// unknown is the change d = Dq - Dq_{n-1} of the increment, which is small: where a method gives h v' as a
// function of d, its round-off is eps |h v'| and not eps |v|. The system is scaled by the step size: rows h r
// and Phi / h, unknowns d and h lambda, so that the Newton matrix
//
//   [ h M dv'/dd + h C dv/dd + h^2 K T(h Dq)    B^T ]
//   [ B T(h Dq)                                  0  ]
//
// keeps its condition as h -> 0 (heavy top: 3.6e3 for every h; unscaled it grows as h^-3 to h^-4).

namespace liebench {

// Closure of the methods whose v and v' are affine in the increment (BLieDF2nd, generalized-alpha), about the
// increment `base` = Dq_{n-1} and the velocity v_n:
//
//   Dq = base + d
//   v = v_n + velocity_slope d + velocity_change
//   h v' = acceleration_slope d + scaled_acceleration
template <MechanicalSystem S>
struct AffineClosure {
  using T = typename S::Scalar;
  Velocity<S> base;
  Velocity<S> velocity;  // v_n
  T velocity_slope;
  Velocity<S> velocity_change;
  T acceleration_slope;
  Velocity<S> scaled_acceleration;

  Velocity<S> increment(const Velocity<S>& d) const { return base + d; }
  Velocity<S> change_of_velocity(const Velocity<S>& d) const { return velocity_slope * d + velocity_change; }
  Velocity<S> velocity_at(const Velocity<S>& d) const { return velocity + change_of_velocity(d); }
  Velocity<S> scaled_acceleration_at(const Velocity<S>& d) const {
    return acceleration_slope * d + scaled_acceleration;
  }
  // Derivatives of both with respect to d: a number or an m x m matrix.
  const T& velocity_derivative() const { return velocity_slope; }
  const T& scaled_acceleration_derivative() const { return acceleration_slope; }
};

template <MechanicalSystem S>
class StepEquation {
 public:
  using T = typename S::Scalar;
  static constexpr int m = S::Group::dimension;
  static constexpr int l = S::constraints;
  using Unknowns = Eigen::Matrix<T, m + l, 1>;  // (d, h lambda)

  // The new state that belongs to given unknowns.
  struct Point {
    Velocity<S> step;  // h Dq
    Configuration<S> q;
    Velocity<S> v;
    Velocity<S> scaled_acceleration;  // h v'
  };

  template <class Closure>
  static Point point(const Configuration<S>& q_n, const T& h, const Closure& closure, const Unknowns& z) {
    const Velocity<S> d = z.template head<m>();
    const Velocity<S> step = h * closure.increment(d);
    return {step, S::Group::compose(q_n, S::Group::exp(step)), closure.velocity_at(d),
            closure.scaled_acceleration_at(d)};
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

  // The Newton matrix at the point, of which dv and h_da are the derivatives of v and h v' with respect to d.
  template <class Matrix, class VelocityDerivative, class AccelerationDerivative>
  static void jacobian(const S& system, const T& t, const T& h, const Point& p, const Unknowns& z,
                       const VelocityDerivative& dv, const AccelerationDerivative& h_da, Matrix& J) {
    const Velocity<S> acceleration = p.scaled_acceleration / h;
    Multipliers<S> lambda;
    if constexpr (l > 0) lambda = z.template tail<l>() / h;
    const VelocityMatrix<S> K = system.stiffness(t, p.q, p.v, acceleration, lambda);
    J.template topLeftCorner<m, m>() = system.mass_matrix(p.q) * h_da +
                                       (h * system.damping(t, p.q, p.v)) * dv +
                                       (h * h) * S::Group::times_tangent(K, p.step);
    if constexpr (l > 0) {
      const ConstraintGradient<S> B = system.constraint_gradient(p.q);
      J.template topRightCorner<m, l>() = B.transpose();
      J.template bottomLeftCorner<l, m>() = S::Group::times_tangent(B, p.step);
      J.template bottomRightCorner<l, l>().setConstant(T(0.0));
    }
  }
};

}  // namespace liebench
