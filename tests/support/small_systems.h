#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "groups/decimal.h"
#include "groups/real_space.h"
#include "problems/system.h"

// Small mechanical systems on linear spaces: solutions that are known, and failures that are certain.

namespace liebench {

// n coupled oscillators with a cubic spring, damping and a time-dependent force, all terms of the same size:
//   M q'' = -g,  g = K q + D v + q^3 - cos(3 t) e,   M, K, D full matrices, M symmetric positive definite
template <Scalar T, int n>
class Oscillators {
 public:
  using Scalar = T;
  using Group = RealSpace<T, n>;
  template <class U>
  using rebind = Oscillators<U, n>;
  static constexpr int constraints = 0;
  static constexpr bool constant_mass = true;
  using Vector = Eigen::Matrix<T, n, 1>;
  using Matrix = Eigen::Matrix<T, n, n>;
  using NoMultipliers = Eigen::Matrix<T, 0, 1>;

  Oscillators() {
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        mass_(i, j) = T((i == j ? 2.0 : 0.0) + 0.25 / (1 + i + j));
        stiffness_(i, j) = T((i == j ? 3.0 + i : 0.5) - 0.125 * i);
        damping_(i, j) = T((i == j ? 0.25 : 0.0) + 0.0625 * (i - j));
      }
  }
  template <class U>
  Oscillators<U, n> cast() const {
    return {};
  }

  const Matrix& mass_matrix(const Vector&) const { return mass_; }
  Vector momentum(const Vector&, const Vector& w) const { return mass_ * w; }
  Vector force(const T& t, const Vector& q, const Vector& v) const {
    using std::cos;
    return stiffness_ * q + damping_ * v + q.cwiseProduct(q).cwiseProduct(q) -
           Vector::Constant(T(cos(t * 3.0)));
  }
  Matrix damping(const T&, const Vector&, const Vector&) const { return damping_; }
  Matrix stiffness(const T&, const Vector& q, const Vector&, const Vector&, const NoMultipliers&) const {
    Matrix K = stiffness_;
    K.diagonal() += q.cwiseProduct(q) * T(3.0);
    return K;
  }
  T angular_momentum(const Vector&, const Vector&) const { return T(0.0); }
  // Of the conservative part.
  T energy(const Vector& q, const Vector& v) const {
    return (v.dot(mass_ * v) + q.dot(stiffness_ * q)) * T(0.5);
  }

  Vector initial_configuration() const { return Vector::Constant(T(0.5)); }
  Vector initial_velocity() const { return Vector::Constant(T(-0.25)); }

 private:
  Matrix mass_, stiffness_, damping_;
};

enum class ParticleForce {
  none,
  spring_behind_a_wall,  // a constant pull along y, and a spring of 1000 N/m beyond y = 1.5 m
  no_number,
  infinite,
};

// A particle of mass m in the plane, q = (x, y), without gravity, under a force and a law that a test chooses: the law
// has `constraints` and, where it has some, static functions phi(q), gradient(q) and gradient_derivative(q, v).
template <Scalar T, template <class> class Law>
class Particle {
 public:
  using Scalar = T;
  using Group = RealSpace<T, 2>;
  template <class U>
  using rebind = Particle<U, Law>;
  static constexpr int constraints = Law<T>::constraints;
  static constexpr bool constant_mass = true;
  using Vector = Eigen::Matrix<T, 2, 1>;
  using Matrix = Eigen::Matrix<T, 2, 2>;
  using Lambda = Eigen::Matrix<T, constraints, 1>;

  explicit Particle(double mass = 1.0, ParticleForce force = ParticleForce::none)
      : mass_(mass), force_(force) {}
  template <class U>
  Particle<U, Law> cast() const {
    return Particle<U, Law>(mass_, force_);
  }

  Matrix mass_matrix(const Vector&) const { return T(mass_) * Matrix::Identity(); }
  Vector momentum(const Vector&, const Vector& w) const { return T(mass_) * w; }
  Vector force(const T&, const Vector& q, const Vector&) const {
    switch (force_) {
      case ParticleForce::none:
        break;
      case ParticleForce::spring_behind_a_wall: {
        const T reach = q(1) - T(1.5);
        return Vector(T(0.0), T(-1.0) + (T(0.0) < reach ? T(reach * 1000.0) : T(0.0)));
      }
      case ParticleForce::no_number:
        return Vector::Constant(T(std::numeric_limits<double>::quiet_NaN()));
      case ParticleForce::infinite:
        return Vector::Constant(T(std::numeric_limits<double>::infinity()));
    }
    return Vector::Constant(T(0.0));
  }
  Matrix damping(const T&, const Vector&, const Vector&) const { return Matrix::Constant(T(0.0)); }
  Matrix stiffness(const T&, const Vector&, const Vector&, const Vector&, const Lambda&) const {
    return Matrix::Constant(T(0.0));
  }
  T energy(const Vector&, const Vector& v) const { return v.squaredNorm() * T(0.5 * mass_); }
  T angular_momentum(const Vector& q, const Vector& v) const {
    return T(mass_) * (q(0) * v(1) - q(1) * v(0));
  }
  Vector initial_configuration() const { return Vector(T(1.0), T(0.0)); }
  Vector initial_velocity() const { return Vector(T(0.0), T(1.0)); }

  Lambda constraint(const Vector& q) const requires(constraints > 0) { return Law<T>::phi(q); }
  Eigen::Matrix<T, constraints, 2> constraint_gradient(const Vector& q) const requires(constraints > 0) {
    return Law<T>::gradient(q);
  }
  Vector constraint_force(const Vector& q, const Lambda& lambda) const requires(constraints > 0) {
    return Law<T>::gradient(q).transpose() * lambda;
  }
  Lambda constraint_curvature(const Vector& q, const Vector& v) const requires(constraints > 0) {
    return constraint_gradient_derivative(q, v) * v;
  }
  Eigen::Matrix<T, constraints, 2> constraint_gradient_derivative(const Vector& q, const Vector& v) const
      requires(constraints > 0) {
    return Law<T>::gradient_derivative(q, v);
  }

 private:
  double mass_;
  ParticleForce force_;
};

// x^2 + y^2 = 1
template <class T>
struct Circle {
  static constexpr int constraints = 1;
  using Vector = Eigen::Matrix<T, 2, 1>;
  static Eigen::Matrix<T, 1, 1> phi(const Vector& q) {
    return Eigen::Matrix<T, 1, 1>((q.squaredNorm() - T(1.0)) / T(2.0));
  }
  static Eigen::Matrix<T, 1, 2> gradient(const Vector& q) { return q.transpose(); }
  static Eigen::Matrix<T, 1, 2> gradient_derivative(const Vector&, const Vector& v) { return v.transpose(); }
};

// x = 1, said twice: the gradient has rank 1 of 2.
template <class T>
struct RedundantConstraint {
  static constexpr int constraints = 2;
  using Vector = Eigen::Matrix<T, 2, 1>;
  static Vector phi(const Vector& q) { return Vector(q(0) - T(1.0), q(0) - T(1.0)); }
  static Eigen::Matrix<T, 2, 2> gradient(const Vector&) {
    Eigen::Matrix<T, 2, 2> B;
    B << T(1.0), T(0.0), T(1.0), T(0.0);
    return B;
  }
  static Eigen::Matrix<T, 2, 2> gradient_derivative(const Vector&, const Vector&) {
    return Eigen::Matrix<T, 2, 2>::Constant(T(0.0));
  }
};

// 1 + x^2 = 0, which no real x satisfies.
template <class T>
struct ImpossibleConstraint {
  static constexpr int constraints = 1;
  using Vector = Eigen::Matrix<T, 2, 1>;
  static Eigen::Matrix<T, 1, 1> phi(const Vector& q) { return Eigen::Matrix<T, 1, 1>(T(1.0) + q(0) * q(0)); }
  static Eigen::Matrix<T, 1, 2> gradient(const Vector& q) { return {T(2.0) * q(0), T(0.0)}; }
  static Eigen::Matrix<T, 1, 2> gradient_derivative(const Vector&, const Vector& v) {
    return {T(2.0) * v(0), T(0.0)};
  }
};

// None: the particle is free.
template <class T>
struct Unconstrained {
  static constexpr int constraints = 0;
};

}  // namespace liebench
