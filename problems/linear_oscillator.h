#pragma once

#include <complex>

#include "groups/real_space.h"
#include "problems/system.h"

namespace liebench {

// x'' = 2 Re(mu) x' - |mu|^2 x on the line, whose solutions are exp(mu t) and its conjugate: what linear stability is defined by. A
// positive real part is an oscillator that feeds itself.
template <Scalar T>
class LinearOscillator {
 public:
  using Scalar = T;
  using Group = RealSpace<T, 1>;
  template <class U>
  using rebind = LinearOscillator<U>;
  static constexpr int constraints = 0;
  static constexpr bool constant_mass = true;
  using Vector = Eigen::Matrix<T, 1, 1>;
  using NoMultipliers = Eigen::Matrix<T, 0, 1>;

  explicit LinearOscillator(const std::complex<double>& mu)
      : damping_(-2.0 * mu.real()), stiffness_(std::norm(mu)) {}
  LinearOscillator(const T& damping, const T& stiffness) : damping_(damping), stiffness_(stiffness) {}
  template <class U>
  LinearOscillator<U> cast() const {
    return {U(damping_), U(stiffness_)};
  }

  Vector mass_matrix(const Vector&) const { return Vector::Constant(T(1.0)); }
  Vector momentum(const Vector&, const Vector& w) const { return w; }
  Vector force(const T&, const Vector& q, const Vector& v) const { return damping_ * v + stiffness_ * q; }
  Vector damping(const T&, const Vector&, const Vector&) const { return Vector::Constant(damping_); }
  Vector stiffness(const T&, const Vector&, const Vector&, const Vector&, const NoMultipliers&) const {
    return Vector::Constant(stiffness_);
  }
  T energy(const Vector& q, const Vector& v) const {
    return (v(0) * v(0) + stiffness_ * q(0) * q(0)) / T(2.0);
  }
  T angular_momentum(const Vector&, const Vector&) const { return T(0.0); }
  Vector initial_configuration() const { return Vector::Constant(T(1.0)); }
  Vector initial_velocity() const { return Vector::Constant(T(0.0)); }

 private:
  T damping_, stiffness_;
};

}  // namespace liebench
