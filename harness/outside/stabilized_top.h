#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include "harness/outside/scaled_rotation.h"
#include "problems/heavy_top.h"

namespace liebench::outside {

// The heavy top as a free body held at its tip, eq. (58), in the stabilized index-2 form [Gear, Leimkuhler & Gupta
// 1985]: the implicit equation F(y, y') = 0 of y = (x, p, u, Omega, lambda, eta, mu) in R^20, with z = R(p)^T x and J
// about the centre of mass,
//
//   x' = u + R(p) eta                                    q' = DL_q (v - B^T eta)~
//   p' = p (0, Omega - z x eta) / 2 + mu p
//   u' = gamma + R(p) lambda / m,   J Omega' = J Omega x Omega - z x lambda
//   0 = X - z                                            Phi
//   0 = R(p)^T u + z x Omega                             -B v
//   0 = (|p|^2 - 1) / 2
//
// The last line holds the quaternion on the unit sphere by its multiplier mu; eta = 0 and mu = 0 in the exact solution.
// y' of the three multipliers is in no equation.
class StabilizedTop {
 public:
  template <class T>
  using System = HeavyTopR3xS3<T>;
  using Data = HeavyTopParameters;
  static constexpr int size = 20;
  static constexpr int differential = 13;  // x, p, u, Omega come first
  using Vector = Eigen::Matrix<double, size, 1>;
  using Matrix = Eigen::Matrix<double, size, size>;

  explicit StabilizedTop(const HeavyTopParameters& parameters) {
    const HeavyTopData<double> data(parameters);
    mass_ = data.mass;
    inertia_ = data.inertia;
    center_of_mass_ = data.center_of_mass;
    gravity_ = data.gravity;
    const HeavyTopR3xS3<double> system(parameters);
    const Matrix3& R = data.R0;
    const Vector3& omega = data.omega0;
    const Matrix3 J = data.inertia_about_tip();
    const Vector3 torque =
        Vector3(J * omega).cross(omega) + center_of_mass_.cross(Vector3(R.transpose() * data.weight()));
    const Vector3 omega_dot = J.inverse() * torque;
    const auto q = system.initial_configuration();
    const Vector4 p_dot = 0.5 * times_imaginary(q.second) * omega;
    initial_ << q.first, q.second, system.initial_velocity(), system.multipliers(R, omega, omega_dot),
        Eigen::Matrix<double, 4, 1>::Zero();
    initial_rate_ << system.initial_velocity().head<3>(), p_dot, system.acceleration(R, omega, omega_dot),
        Eigen::Matrix<double, 7, 1>::Zero();
  }

  // Consistent: F = 0, by the exact lambda.
  const Vector& initial() const { return initial_; }
  const Vector& initial_rate() const { return initial_rate_; }

  static Configuration<System<double>> configuration(const Vector& y) {
    return {y.head<3>(), y.segment<4>(3).normalized()};
  }
  static Velocity<System<double>> velocity(const Vector& y) { return y.segment<6>(7); }
  static Multipliers<System<double>> multipliers(const Vector& y) { return y.segment<3>(13); }

  // F(y, y')
  void residual(Eigen::Ref<const Vector> y, Eigen::Ref<const Vector> rate, Eigen::Ref<Vector> F) const {
    const Parts s(y);
    const Vector3 spin = s.omega - s.z.cross(s.eta);
    F.segment<3>(0) = rate.segment<3>(0) - s.u - turn(s.p, s.eta);
    F(3) = rate(3) + 0.5 * s.p.tail<3>().dot(spin) - s.mu * s.p(0);
    const Vector3 axis = s.p.tail<3>();
    F.segment<3>(4) = rate.segment<3>(4) - 0.5 * (s.p(0) * spin + axis.cross(spin)) - s.mu * axis;
    F.segment<3>(7) = rate.segment<3>(7) - gravity_ - turn(s.p, s.lambda) / mass_;
    const Vector3 momentum = inertia_ * s.omega;
    F.segment<3>(10) = inertia_ * rate.segment<3>(10) - momentum.cross(s.omega) + s.z.cross(s.lambda);
    F.segment<3>(13) = center_of_mass_ - s.z;
    F.segment<3>(16) = turn_back(s.p, s.u) + s.z.cross(s.omega);
    F(19) = 0.5 * (s.p.squaredNorm() - 1.0);
  }

  // dF/dy + c dF/dy'
  void jacobian(Eigen::Ref<const Vector> y, double c, Eigen::Ref<Matrix> J) const {
    const Parts s(y);
    const Matrix3 back = rotation_back(s.p);  // dz/dx
    const Matrix34 z_p = turn_back_derivative(s.p, s.x, s.z);
    const Vector3 spin = s.omega - s.z.cross(s.eta);
    const Eigen::Matrix<double, 4, 3> Q = 0.5 * times_imaginary(s.p);
    const Matrix3 hat_eta = skew(s.eta), hat_lambda = skew(s.lambda), hat_omega = skew(s.omega),
                  hat_z = skew(s.z);
    J.setZero();
    J.block<3, 3>(0, 0).diagonal().setConstant(c);
    J.block<3, 4>(0, 3) = -turn_derivative(s.p, s.eta, turn(s.p, s.eta));
    J.block<3, 3>(0, 7).diagonal().setConstant(-1.0);
    J.block<3, 3>(0, 16) = -back.transpose();

    // d spin = d Omega + eta x dz - z x d eta
    J.block<4, 3>(3, 0) = -(Q * (hat_eta * back));
    J.block<4, 4>(3, 3) = -0.5 * imaginary_factor(spin) - Q * (hat_eta * z_p);
    J.block<4, 4>(3, 3).diagonal().array() += c - s.mu;
    J.block<4, 3>(3, 10) = -Q;
    J.block<4, 3>(3, 16) = Q * hat_z;
    J.block<4, 1>(3, 19) = -s.p;

    J.block<3, 4>(7, 3) = turn_derivative(s.p, s.lambda, turn(s.p, s.lambda)) / -mass_;
    J.block<3, 3>(7, 7).diagonal().setConstant(c);
    J.block<3, 3>(7, 13) = back.transpose() / -mass_;

    J.block<3, 3>(10, 0) = -(hat_lambda * back);
    J.block<3, 4>(10, 3) = -(hat_lambda * z_p);
    J.block<3, 3>(10, 10) = c * inertia_ - skew(Vector3(inertia_ * s.omega)) + hat_omega * inertia_;
    J.block<3, 3>(10, 13) = hat_z;

    J.block<3, 3>(13, 0) = -back;
    J.block<3, 4>(13, 3) = -z_p;

    J.block<3, 3>(16, 0) = -(hat_omega * back);
    J.block<3, 4>(16, 3) = turn_back_derivative(s.p, s.u, turn_back(s.p, s.u)) - hat_omega * z_p;
    J.block<3, 3>(16, 7) = back;
    J.block<3, 3>(16, 10) = hat_z;

    J.block<1, 4>(19, 3) = s.p.transpose();
  }

 private:
  struct Parts {
    explicit Parts(Eigen::Ref<const Vector> y)
        : x(y.segment<3>(0)),
          p(y.segment<4>(3)),
          u(y.segment<3>(7)),
          omega(y.segment<3>(10)),
          lambda(y.segment<3>(13)),
          eta(y.segment<3>(16)),
          mu(y(19)),
          z(turn_back(p, x)) {}
    Vector3 x;
    Vector4 p;
    Vector3 u, omega, lambda, eta;
    double mu;
    Vector3 z;
  };

  double mass_ = 0.0;
  Matrix3 inertia_;
  Vector3 center_of_mass_, gravity_;
  Vector initial_, initial_rate_;
};

}  // namespace liebench::outside
