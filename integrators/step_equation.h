#pragma once

#include <Eigen/Core>

#include "integrators/form.h"
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

// The stabilized index-2 form has, beside Phi(q) = 0, the hidden constraint B(q) v = 0 and an auxiliary multiplier eta
// that joins the increment in the closure of the method (not in the position update): v and h v' are those of
// d + B(q_n)^T eta. On the exact solution eta = 0. Unknowns (d, h lambda, eta), rows (h r, Phi / h, B v):
//
//   [ M* + h^2 K T(h Dq)         B^T   M* B_n^T            ]    M* = h M dv'/dd + h C dv/dd
//   [ B T(h Dq)                   0     0                  ]
//   [ dv/dd B + h Z T(h Dq)       0     dv/dd B B_n^T      ]    Z w = D_q(B(q) v) . (q w~)
template <MechanicalSystem S, Form form = Form::index3>
class StepEquation {
 public:
  using T = typename S::Scalar;
  static constexpr int m = S::Group::dimension;
  static constexpr int l = S::constraints;
  static constexpr bool stabilized = l > 0 && form == Form::stabilized_index2;
  static constexpr int n = m + (stabilized ? 2 * l : l);
  using Unknowns = Eigen::Matrix<T, n, 1>;  // (d, h lambda, eta)

  // What a step starts from: q_n, and B(q_n) where eta needs it.
  struct Origin {
    Configuration<S> q;
    Eigen::Matrix<T, stabilized ? l : 0, m> gradient;
  };
  static Origin origin(const S& system, const Configuration<S>& q_n) {
    Origin o{q_n, {}};
    if constexpr (stabilized) o.gradient = system.constraint_gradient(q_n);
    return o;
  }

  // The new state that belongs to given unknowns.
  struct Point {
    Velocity<S> change;  // d, with B_n^T eta in the stabilized form: what the closure takes
    Velocity<S> step;    // h Dq
    Configuration<S> q;
    Velocity<S> v;
    Velocity<S> scaled_acceleration;  // h v'
  };

  template <class Closure>
  static Point point(const Origin& origin, const T& h, const Closure& closure, const Unknowns& z) {
    const Velocity<S> d = z.template head<m>();
    Velocity<S> change = d;
    if constexpr (stabilized) change += origin.gradient.transpose() * z.template tail<l>();
    const Velocity<S> step = h * closure.increment(d);
    return {change, step, S::Group::compose(origin.q, S::Group::exp(step)), closure.velocity_at(change),
            closure.scaled_acceleration_at(change)};
  }

  // (h r, Phi / h, B v)
  static Unknowns residual(const S& system, const T& t, const T& h, const Point& p, const Unknowns& z) {
    Unknowns r;
    r.template head<m>() = system.momentum(p.q, p.scaled_acceleration) + h * system.force(t, p.q, p.v);
    if constexpr (l > 0) {
      const Multipliers<S> scaled_lambda = z.template segment<l>(m);
      r.template head<m>() += system.constraint_force(p.q, scaled_lambda);
      r.template segment<l>(m) = system.constraint(p.q) / h;
    }
    if constexpr (stabilized) r.template tail<l>() = system.constraint_gradient(p.q) * p.v;
    return r;
  }

  // The Newton matrix at the point, of which dv and h_da are the derivatives of v and h v' with respect to d.
  template <class Matrix, class VelocityDerivative, class AccelerationDerivative>
  static void jacobian(const S& system, const T& t, const T& h, const Origin& origin, const Point& p,
                       const Unknowns& z, const VelocityDerivative& dv, const AccelerationDerivative& h_da,
                       Matrix& J) {
    // A constant mass matrix has no part in K.
    Velocity<S> acceleration = Velocity<S>::Constant(T(0.0));
    if constexpr (!S::constant_mass) acceleration = p.scaled_acceleration / h;
    Multipliers<S> lambda;
    if constexpr (l > 0) lambda = z.template segment<l>(m) / h;
    const VelocityMatrix<S> K = system.stiffness(t, p.q, p.v, acceleration, lambda);
    const VelocityMatrix<S> inertial =
        system.mass_matrix(p.q) * h_da + (h * system.damping(t, p.q, p.v)) * dv;
    if constexpr (n > m) J.setConstant(T(0.0));
    J.template topLeftCorner<m, m>() = inertial + (h * h) * S::Group::times_tangent(K, p.step);
    if constexpr (l > 0) {
      const ConstraintGradient<S> B = system.constraint_gradient(p.q);
      J.template block<m, l>(0, m) = B.transpose();
      J.template block<l, m>(m, 0) = S::Group::times_tangent(B, p.step);
      if constexpr (stabilized) {
        const ConstraintGradient<S> Z = system.constraint_gradient_derivative(p.q, p.v);
        J.template topRightCorner<m, l>() = inertial * origin.gradient.transpose();
        J.template bottomLeftCorner<l, m>() = B * dv + h * S::Group::times_tangent(Z, p.step);
        J.template bottomRightCorner<l, l>() = (B * dv) * origin.gradient.transpose();
      }
    }
  }
};

}  // namespace liebench
