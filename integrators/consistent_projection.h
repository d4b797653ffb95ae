#pragma once

#include <optional>

#include "integrators/dense_lu.h"
#include "problems/system.h"

namespace liebench {

// The saddle point system of a constrained system at q,
//
//   [ M(q)  B(q)^T ] [ x ]   [ a ]
//   [ B(q)  0      ] [ y ] = [ b ]
//
// which gives consistent accelerations and multipliers (a = -g, b = -Z(v, v)), projections on the hidden
// constraint, and the velocity modification of eq. (56). Solved in double, refined in the scalar of the
// system to its round-off. Empty where M and B make the matrix singular.
template <ConstrainedSystem S>
struct SaddlePointSolution {
  Velocity<S> x;
  Multipliers<S> y;
};

template <ConstrainedSystem S>
std::optional<SaddlePointSolution<S>> solve_saddle_point(const S& system, const Configuration<S>& q,
                                                         const Velocity<S>& a, const Multipliers<S>& b) {
  using T = typename S::Scalar;
  constexpr int m = S::Group::dimension, l = S::constraints;
  const VelocityMatrix<S> M = system.mass_matrix(q);
  const ConstraintGradient<S> B = system.constraint_gradient(q);
  typename DenseLu<double, m + l>::Matrix A;
  A.setZero();
  A.template topLeftCorner<m, m>() = M.template cast<double>();
  A.template topRightCorner<m, l>() = B.transpose().template cast<double>();
  A.template bottomLeftCorner<l, m>() = B.template cast<double>();
  DenseLu<double, m + l> lu;
  if (!lu.factorize(A)) return std::nullopt;
  SaddlePointSolution<S> s{Velocity<S>::Constant(T(0.0)), Multipliers<S>::Constant(T(0.0))};
  // Each pass gains at least ten digits (condition 3.6e3 for the top): four serve 106 bits.
  constexpr int passes = ScalarTraits<T>::extended ? 4 : 2;
  for (int pass = 0; pass < passes; ++pass) {
    Eigen::Matrix<T, m + l, 1> r;
    r.template head<m>() = a - M * s.x - B.transpose() * s.y;
    r.template tail<l>() = b - B * s.x;
    const Eigen::Matrix<T, m + l, 1> d = lu.solve(r.template cast<double>()).template cast<T>();
    s.x += d.template head<m>();
    s.y += d.template tail<l>();
  }
  return s;
}

// The acceleration v' that the equations of motion give at (t, q, v): M v' = -g without constraints; with them, together
// with lambda, such that the second derivative of the constraint vanishes, B v' = -Z(v, v).
template <MechanicalSystem S>
std::optional<Velocity<S>> consistent_acceleration(const S& system, const typename S::Scalar& t,
                                                   const Configuration<S>& q, const Velocity<S>& v) {
  using T = typename S::Scalar;
  const Velocity<S> force = -system.force(t, q, v);
  if constexpr (S::constraints > 0) {
    const auto solution =
        solve_saddle_point(system, q, force, Multipliers<S>(-system.constraint_curvature(q, v)));
    if (!solution) return std::nullopt;
    return solution->x;
  } else {
    constexpr int m = S::Group::dimension;
    DenseLu<double, m> lu;
    const VelocityMatrix<S> M = system.mass_matrix(q);
    if (!lu.factorize(M.template cast<double>())) return std::nullopt;
    Velocity<S> a = Velocity<S>::Constant(T(0.0));
    constexpr int passes = ScalarTraits<T>::extended ? 4 : 2;
    for (int pass = 0; pass < passes; ++pass) {
      const Velocity<S> r = force - system.momentum(q, a);
      a += lu.solve(r.template cast<double>()).template cast<T>();
    }
    return a;
  }
}

}  // namespace liebench
