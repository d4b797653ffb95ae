#pragma once

#include <ceres/jet.h>

#include <Eigen/Core>
#include <cmath>
#include <type_traits>

#include "groups/extended.h"
#include "problems/system.h"

// Witnesses for the derivatives that a mechanical system gives in closed form: derivatives along
// q o exp(delta~) at delta = 0, by ceres::Jet (exact up to round-off, in double) and by central differences
// (in the system's own scalar).
//
// What is differentiated is a function f(system, q) that returns a vector; it is called with the system in
// its own scalar or in Jets, so it is best a generic lambda:
//
//   const auto phi = [](const auto& system, const auto& q) { return system.constraint(q); };
//   derivative_by_jets(system, q, phi)         // B(q), l x m
//   derivative_by_differences(system, q, phi)  // B(q), l x m, to eps^(4/5)
//
// Vectors that f needs besides q are constants there: in_scalar_of(system, v) casts them.

namespace liebench {

template <int n>
using JetOf = ceres::Jet<double, n>;
// For n derivatives at most: of six, where that is enough, for every type of Jets is one more system to compile.
template <int n>
using JetFor = JetOf<(n > 6 ? n : 6)>;

// x, a matrix of doubles (or already of the system's scalar), in the scalar of `system`.
template <class System, class Derived>
auto in_scalar_of(const System&, const Eigen::MatrixBase<Derived>& x) {
  using T = typename System::Scalar;
  return x.template cast<T>().eval();
}

// Row i, column j: the derivative of component i of f along the j-th direction of delta. In double: the
// system has the scalar double.
template <MechanicalSystem S, class F>
auto derivative_by_jets(const S& system, const Configuration<S>& q, const F& f) {
  constexpr int m = S::Group::dimension;
  using Jet = JetFor<m>;
  using JetSystem = typename S::template rebind<Jet>;
  const JetSystem jets = system.template cast<Jet>();
  typename JetSystem::Group::Tangent delta;
  for (int i = 0; i < m; ++i) delta(i) = Jet(0.0, i);
  using Group = typename JetSystem::Group;
  const typename Group::Element at = Group::compose(S::Group::template cast<Jet>(q), Group::exp(delta));
  const auto value = f(jets, at).eval();
  constexpr int rows = decltype(value)::RowsAtCompileTime;
  Eigen::Matrix<double, rows, m> derivative;
  for (int i = 0; i < rows; ++i) derivative.row(i) = value(i).v.template head<m>().transpose();
  return derivative;
}

// The derivative of f along the one direction w: f(q o exp(s w~)) for s = 0.
template <MechanicalSystem S, class F>
auto directional_derivative_by_jets(const S& system, const Configuration<S>& q, const Velocity<S>& w,
                                    const F& f) {
  using Jet = JetFor<1>;
  using JetSystem = typename S::template rebind<Jet>;
  using Group = typename JetSystem::Group;
  const JetSystem jets = system.template cast<Jet>();
  const Jet s(0.0, 0);
  const typename Group::Tangent delta = w.template cast<Jet>() * s;
  const typename Group::Element at = Group::compose(S::Group::template cast<Jet>(q), Group::exp(delta));
  const auto value = f(jets, at, s).eval();
  constexpr int rows = decltype(value)::RowsAtCompileTime;
  Eigen::Matrix<double, rows, 1> derivative;
  for (int i = 0; i < rows; ++i) derivative(i) = value(i).v(0);
  return derivative;
}

// The derivative of f(v), a vector function of a velocity, by Jets: f(system, v), the system in Jets.
template <MechanicalSystem S, class F>
auto velocity_derivative_by_jets(const S& system, const Velocity<S>& v, const F& f) {
  constexpr int m = S::Group::dimension;
  using Jet = JetFor<m>;
  using JetSystem = typename S::template rebind<Jet>;
  const JetSystem jets = system.template cast<Jet>();
  typename JetSystem::Group::Tangent at;
  for (int i = 0; i < m; ++i) at(i) = Jet(v(i), i);
  const auto value = f(jets, at).eval();
  constexpr int rows = decltype(value)::RowsAtCompileTime;
  Eigen::Matrix<double, rows, m> derivative;
  for (int i = 0; i < rows; ++i) derivative.row(i) = value(i).v.template head<m>().transpose();
  return derivative;
}

// f'(0) for a vector function of one number by the five-point stencil
// (8 (f(d) - f(-d)) - (f(2d) - f(-2d))) / (12 d): truncation d^4 |f^(5)| / 30, noise (3/2) eps |f| / d. Both
// are of size eps^(4/5) at the d = eps^(1/5) that is taken, in units where f and its variable are of size 1
// [Fornberg 1988, table 1]; `unit` is the size of the variable.
template <class T, class F>
auto five_point_derivative(const F& f, double unit = 1.0) {
  const double d = unit * std::pow(to_double(Eigen::NumTraits<T>::epsilon()), 0.2);
  const auto near = (f(T(d)) - f(T(-d))).eval();
  const auto far = (f(T(2 * d)) - f(T(-2 * d))).eval();
  // 12 d in T: rounded to a double it would be off by 1e-16.
  return ((near * T(8.0) - far) / (T(d) * T(12.0))).eval();
}

// As derivative_by_jets, by the five-point stencil, in the scalar of the system.
template <MechanicalSystem S, class F>
auto derivative_by_differences(const S& system, const Configuration<S>& q, const F& f) {
  using T = typename S::Scalar;
  using Group = typename S::Group;
  constexpr int m = Group::dimension;
  constexpr int rows = std::decay_t<decltype(f(system, q).eval())>::RowsAtCompileTime;
  Eigen::Matrix<T, rows, m> derivative;
  for (int j = 0; j < m; ++j)
    derivative.col(j) = five_point_derivative<T>([&](const T& s) {
      Velocity<S> delta = Velocity<S>::Constant(T(0.0));
      delta(j) = s;
      return f(system, Group::compose(q, Group::exp(delta))).eval();
    });
  return derivative;
}

// As velocity_derivative_by_jets, by the five-point stencil; `unit` is the size of a velocity.
template <MechanicalSystem S, class F>
auto velocity_derivative_by_differences(const S& system, const Velocity<S>& v, double unit, const F& f) {
  using T = typename S::Scalar;
  constexpr int m = S::Group::dimension;
  constexpr int rows = std::decay_t<decltype(f(system, v).eval())>::RowsAtCompileTime;
  Eigen::Matrix<T, rows, m> derivative;
  for (int j = 0; j < m; ++j)
    derivative.col(j) = five_point_derivative<T>(
        [&](const T& s) {
          Velocity<S> at = v;
          at(j) += s;
          return f(system, at).eval();
        },
        unit);
  return derivative;
}

}  // namespace liebench
