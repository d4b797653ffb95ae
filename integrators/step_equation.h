#pragma once

#include <Eigen/Core>

#include "groups/entrywise.h"
#include "integrators/affine_closure.h"
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
  static constexpr bool stabilized = l != 0 && form == Form::stabilized_index2;
  static constexpr int n = m == run_time_size ? run_time_size : m + (stabilized ? 2 * l : l);
  static constexpr int most = most_unknowns<S, stabilized>();
  using Unknowns = Eigen::Matrix<T, n, 1, 0, most, 1>;  // (d, h lambda, eta)

  static Unknowns unknowns(const S& system) {
    if constexpr (n == run_time_size)
      return Unknowns(velocity_size(system) + (stabilized ? 2 : 1) * multiplier_size(system));
    else
      return {};
  }
  // Their parts.
  template <class Vector>
  static auto change(Vector& z, const S& system) {
    return z.template head<m>(velocity_size(system));
  }
  template <class Vector>
  static auto scaled_lambda(Vector& z, const S& system) {
    return z.template segment<l>(velocity_size(system), multiplier_size(system));
  }
  template <class Vector>
  static auto eta(Vector& z, const S& system) {
    return z.template segment<l>(z.size() - multiplier_size(system), multiplier_size(system));
  }

  // The new state that belongs to given unknowns.
  struct Point {
    Velocity<S> change;       // d, with B_n^T eta in the stabilized form: what the closure takes
    Velocity<S> step;         // h Dq
    Configuration<S> motion;  // exp(h Dq~)
    Configuration<S> q;
    ClosureValues<S> values;
  };

  template <class Closure>
  [[gnu::always_inline]] static void evaluate(const S& system, const T& h, const Configuration<S>& q_n,
                                              const Closure& closure, const Unknowns& z, Point& p) {
    set(p.change, change(z, system));
    set(p.step, h * closure.increment(p.change));
    if constexpr (InPlaceSystem<S>) {
      if constexpr (stabilized) {
        Velocity<S> forces;
        system.put_constraint_force(q_n, z.data() + z.size() - multiplier_size(system), forces);
        set(p.change, p.change + forces);
      }
      system.group().put_motion(q_n, p.step, p.motion, p.q);
    } else {
      if constexpr (stabilized) {
        const Multipliers<S> auxiliary = eta(z, system);
        p.change += system.constraint_force(q_n, auxiliary);
      }
      p.motion = group_of(system).exp(p.step);
      p.q = group_of(system).compose(q_n, p.motion);
    }
    if constexpr (SizedLieGroup<typename S::Group> && requires { closure.put(p.change, p.values); })
      closure.put(p.change, p.values);
    else
      p.values = closure.at(p.change);
  }

  // (h r, Phi / h, B v)
  [[gnu::always_inline]] static void residual(const S& system, const T& t, const T& h, const Point& p,
                                              const Unknowns& z, Unknowns& r) {
    const Velocity<S>& v = p.values.velocity;
    if constexpr (InPlaceSystem<S>) {
      const Eigen::Index rows = velocity_size(system);
      T* const rate = stabilized ? r.data() + rows + multiplier_size(system) : nullptr;
      system.put_step_residual(t, h, p.q, v, p.values.scaled_acceleration, z.data() + rows, r.data(), rate);
    } else {
      change(r, system) = system.momentum(p.q, p.values.scaled_acceleration) + h * system.force(t, p.q, v);
      if constexpr (l != 0) {
        // Of a size known at run time there may be none.
        if (multiplier_size(system) != 0) {
          const Multipliers<S> multipliers = scaled_lambda(z, system);
          change(r, system) += system.constraint_force(p.q, multipliers);
          scaled_lambda(r, system) = constraint_at(system, t, p.q) / h;
        }
      }
      if constexpr (stabilized) eta(r, system) = constraint_rate(system, t, p.q, v);
    }
  }

  // The Newton matrix at the point, with the derivatives of the closure there. With explicit forces K is no part of
  // it, and B^T that at q_n.
  template <class Matrix, class Derivative, bool explicit_forces>
  static void jacobian(const S& system, const T& t, const T& h, const Configuration<S>& q_n, const Point& p,
                       const Unknowns& z, const ClosureDerivatives<Derivative, explicit_forces>& closure,
                       Matrix& J) requires DenseSystem<S> {
    static_assert(!(explicit_forces && stabilized));
    const Velocity<S>& v = p.values.velocity;
    const VelocityMatrix<S> inertial = system.mass_matrix(p.q) * closure.scaled_acceleration +
                                       (h * system.damping(t, p.q, v)) * closure.velocity;
    if constexpr (n > m) J.setConstant(T(0.0));
    if constexpr (explicit_forces) {
      J.template topLeftCorner<m, m>() = inertial;
    } else {
      // A constant mass matrix has no part in K.
      Velocity<S> acceleration = Velocity<S>::Constant(T(0.0));
      if constexpr (!S::constant_mass) acceleration = p.values.scaled_acceleration / h;
      Multipliers<S> lambda;
      if constexpr (l != 0) lambda = z.template segment<l>(m) / h;
      const VelocityMatrix<S> K = system.stiffness(t, p.q, v, acceleration, lambda);
      J.template topLeftCorner<m, m>() = inertial + (h * h) * S::Group::times_tangent(K, p.step);
    }
    if constexpr (l != 0) {
      const ConstraintGradient<S> B = system.constraint_gradient(p.q);
      if constexpr (explicit_forces)
        J.template block<m, l>(0, m) = system.constraint_gradient(q_n).transpose();
      else
        J.template block<m, l>(0, m) = B.transpose();
      J.template block<l, m>(m, 0) = S::Group::times_tangent(B, p.step);
      if constexpr (stabilized) {
        const ConstraintGradient<S> Z = system.constraint_gradient_derivative(p.q, v);
        const ConstraintGradient<S> B_n = system.constraint_gradient(q_n);
        J.template topRightCorner<m, l>() = inertial * B_n.transpose();
        const ConstraintGradient<S> velocity_gradient = B * closure.velocity;
        J.template bottomLeftCorner<l, m>() = velocity_gradient + h * S::Group::times_tangent(Z, p.step);
        J.template bottomRightCorner<l, l>() = velocity_gradient * B_n.transpose();
      }
    }
  }
};

}  // namespace liebench
