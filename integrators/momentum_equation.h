#pragma once

#include "groups/entrywise.h"
#include "integrators/affine_closure.h"
#include "integrators/form.h"
#include "integrators/step_equation.h"
#include "problems/system.h"

// The equation of a step of the methods that balance the momentum p = M v. For a mass matrix that is constant (a
// left-invariant kinetic energy) the equations of motion are those of Euler & Poincare,
//
//   p' = ad(v)^T p - f - B(q)^T lambda,   f(t, q, v) = g(t, q, v) + ad(v)^T M v
//
// where f is what is left of g without its gyroscopic term, and so does not depend on v unless something dissipates.
// The methods have the momentum at the middle of a step transported to its two ends,
//
//   W(-h Dq)^T M Dq = p_n - kicks at q_n,   p_{n+1} = W(h Dq)^T M Dq - kicks at q_{n+1},
//   W(u) = I + ad(u) / 2 + O(u^2)
//
// with W(u) = T(u)^{-1} in variational integrators, and W(u) = Ad(exp(u~ / 2)) where the spatial momentum is kept.
//
// The first is solved here, for d = Dq - base and the impulse mu of the constraints,
//
//   r = M d + known + (W(-h Dq)^T - I) M Dq + B(q_n)^T mu = 0,   Phi(q_{n+1}) / h = 0
//
// in differences: r is known to the round-off of h f and h ad(v)^T M v, not of M v. Unknowns (d, mu) and rows are
// scaled as in StepEquation; the Newton matrix, to the first order in h,
//
//   [ M + h C / 2    B(q_n)^T ]    C = dg/dv at Dq
//   [ B T(h Dq)      0        ]

namespace liebench {

// W(u) = T(u)^{-1}
struct VariationalTransport {
  template <class Group, class Tangent>
  static Tangent change(const Group& group, const Tangent& u, const Tangent& momentum) {
    return group.tangent_inverse_transposed_change(u, momentum);
  }
};

// W(u) = Ad(exp(u~ / 2))
struct AdjointTransport {
  template <class Group, class Tangent>
  static Tangent change(const Group& group, const Tangent& u, const Tangent& momentum) {
    const Tangent half = u / typename Group::Scalar(2.0);
    return group.adjoint_transposed_change(half, momentum);
  }
};

// (W(u)^T - I) w; nothing is computed where all commutators vanish.
template <class Transport, MechanicalSystem S>
[[gnu::always_inline]] inline Velocity<S> transported_change(const S& system, const Velocity<S>& u,
                                                             const Velocity<S>& w) {
  if constexpr (may_have_commutators<S>())
    if (has_commutators(system)) return Transport::change(group_of(system), u, w);
  return zero_velocity(system);
}

template <MechanicalSystem S>
struct MomentumClosure {
  using Linear = LinearScalar<typename S::Scalar>;
  Velocity<S> base_increment;
  Velocity<S> base_momentum;  // M base
  Velocity<S> known;

  const Velocity<S>& base() const { return base_increment; }
  ClosureDerivatives<Linear, true> linearization(const Velocity<S>&) const {
    return {.velocity = Linear(0.5), .scaled_acceleration = Linear(1.0)};
  }
};

template <MechanicalSystem S, class Transport>
class MomentumEquation : public StepEquation<S, Form::index3> {
  using Base = StepEquation<S, Form::index3>;

 public:
  using typename Base::T;
  using typename Base::Unknowns;
  using Closure = MomentumClosure<S>;

  struct Point : Base::Point {
    Velocity<S> momentum;  // M Dq
    Velocity<S> balance;   // r
  };

  [[gnu::always_inline]] static void evaluate(const S& system, const T& h, const Configuration<S>& q_n,
                                              const Closure& closure, const Unknowns& z, Point& p) {
    set(p.change, Base::change(z, system));
    set(p.values.velocity, closure.base_increment + p.change);
    // No matrix of explicit forces asks for it, but it has its size.
    set(p.values.scaled_acceleration, p.change);
    set(p.step, h * p.values.velocity);
    if (multiplier_size(system) != 0)
      move(system, q_n, p);
    else
      p.q = q_n;
    set(p.balance, system.momentum(q_n, p.change));
    set(p.momentum, closure.base_momentum + p.balance);
    const Velocity<S> back = -p.step;
    set(p.balance, p.balance + closure.known + transported_change<Transport>(system, back, p.momentum));
    if constexpr (S::constraints != 0)
      if (multiplier_size(system) != 0) {
        const Multipliers<S> impulse = Base::scaled_lambda(z, system);
        set(p.balance, p.balance + system.constraint_force(q_n, impulse));
      }
  }

  // q_{n+1} = q_n o exp(h Dq~): without constraints no iteration asks for it, and the solution has still to be moved.
  [[gnu::always_inline]] static void move(const S& system, const Configuration<S>& q_n, Point& p) {
    if constexpr (InPlaceSystem<S>) {
      system.group().put_motion(q_n, p.step, p.motion, p.q);
    } else {
      p.motion = group_of(system).exp(p.step);
      p.q = group_of(system).compose(q_n, p.motion);
    }
  }

  [[gnu::always_inline]] static void residual(const S& system, const T& t, const T& h, const Point& p,
                                              const Unknowns&, Unknowns& r) {
    set(Base::change(r, system), p.balance);
    if constexpr (S::constraints != 0)
      if (multiplier_size(system) != 0) Base::scaled_lambda(r, system) = constraint_at(system, t, p.q) / h;
  }
};

}  // namespace liebench
