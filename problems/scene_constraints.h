#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <utility>

#include "problems/prescribed_motion.h"
#include "problems/scene_bodies.h"

// What joints are made of: constraints between two bodies a and b, one of which may be the ground. Each gives
//
//   rows
//   residual(t, a, b)             Phi, in m; in rad for directions (their product, near zero)
//   rate(t, a, b)                 B v + Phi_t with the velocities of the states
//   curvature(t, a, b)            d^2 Phi / dt^2 less what accelerations add
//   add_wrenches(a, b, lambda, on_a, on_b)    B^T lambda as wrenches on the bodies
//
// on states of any scalar U made from T, for the derivatives of a Newton matrix come by Jets. With `moving` false, rate is B v.

namespace liebench {

// R (omega x s) and R (omega x (omega x s)): how a vector s of the body changes, and changes again, without an acceleration.
template <class U>
Eigen::Matrix<U, 3, 1> turning(const RigidState<U>& body, const Eigen::Matrix<U, 3, 1>& s) {
  return body.R * body.omega.cross(s);
}
template <class U>
Eigen::Matrix<U, 3, 1> turning_twice(const RigidState<U>& body, const Eigen::Matrix<U, 3, 1>& s) {
  return body.R * body.omega.cross(body.omega.cross(s));
}

// (R_a n) . (R_b w) of two directions in body frames.
template <class U>
class DirectionProduct {
 public:
  using Vector = Eigen::Matrix<U, 3, 1>;
  DirectionProduct(const RigidState<U>& a, const RigidState<U>& b, const Vector& n, const Vector& w)
      : a_(a), b_(b), n_(n), w_(w), n_inertial_(a.R * n), w_inertial_(b.R * w) {}

  U value() const { return n_inertial_.dot(w_inertial_); }
  U rate() const { return turning<U>(a_, n_).dot(w_inertial_) + n_inertial_.dot(turning<U>(b_, w_)); }
  // The second derivative less what angular accelerations add.
  U curvature() const {
    return turning_twice<U>(a_, n_).dot(w_inertial_) + U(2.0) * turning<U>(a_, n_).dot(turning<U>(b_, w_)) +
           n_inertial_.dot(turning_twice<U>(b_, w_));
  }
  // Its gradient times a factor.
  void add_torques(const U& factor, Wrench<U>& on_a, Wrench<U>& on_b) const {
    on_a.torque += factor * n_.cross(a_.R.transpose() * w_inertial_);
    on_b.torque += factor * w_.cross(b_.R.transpose() * n_inertial_);
  }

 private:
  const RigidState<U>& a_;
  const RigidState<U>& b_;
  Vector n_, w_, n_inertial_, w_inertial_;
};

// A point of b is a point of a:  Phi = p_b - p_a.
template <class T>
struct Coincidence {
  static constexpr int rows = 3;
  using Vector = Eigen::Matrix<T, 3, 1>;
  template <class U>
  using Rows = Eigen::Matrix<U, rows, 1>;
  Vector point_a, point_b;  // body frames

  template <class U>
  Rows<U> residual(const T&, const RigidState<U>& a, const RigidState<U>& b) const {
    return b.point(point_b.template cast<U>()) - a.point(point_a.template cast<U>());
  }
  template <class U>
  Rows<U> rate(const T&, const RigidState<U>& a, const RigidState<U>& b, bool) const {
    return b.point_velocity(point_b.template cast<U>()) - a.point_velocity(point_a.template cast<U>());
  }
  template <class U>
  Rows<U> curvature(const T&, const RigidState<U>& a, const RigidState<U>& b) const {
    return turning_twice<U>(b, point_b.template cast<U>()) - turning_twice<U>(a, point_a.template cast<U>());
  }
  template <class U>
  void add_wrenches(const RigidState<U>& a, const RigidState<U>& b, const Rows<U>& lambda, Wrench<U>& on_a,
                    Wrench<U>& on_b) const {
    on_a.force -= lambda;
    on_a.torque -= point_a.template cast<U>().cross(a.R.transpose() * lambda);
    on_b.force += lambda;
    on_b.torque += point_b.template cast<U>().cross(b.R.transpose() * lambda);
  }

  // The same where a is the ground, in its own frame.
  Vector residual_on_ground(const RigidState<T>& b) const { return b.point(point_b) - point_a; }
  Vector rate_on_ground(const RigidState<T>& b) const { return b.point_velocity(point_b); }
  Wrench<T> wrench_on_ground(const RigidState<T>& b, const Vector& lambda) const {
    return {lambda, point_b.cross(b.R.transpose() * lambda)};
  }

  // What a Newton matrix needs, without Jets: the derivatives of the torques and of the rate with respect to the rotation of
  // the same body; all others vanish.
  static constexpr bool only_turning = true;
  using Matrix = Eigen::Matrix<T, 3, 3>;
  std::pair<Matrix, Matrix> turning_stiffness(const RigidState<T>& a, const RigidState<T>& b,
                                              const Vector& lambda) const {
    return {-(skew(point_a) * skew(Vector(a.R.transpose() * lambda))),
            skew(point_b) * skew(Vector(b.R.transpose() * lambda))};
  }
  std::pair<Matrix, Matrix> turning_rate(const RigidState<T>& a, const RigidState<T>& b) const {
    return {a.R * skew(Vector(a.omega.cross(point_a))), -(b.R * skew(Vector(b.omega.cross(point_b))))};
  }
};

// A direction of b at a right angle to one of a:  Phi = (R_a n) . (R_b w).
template <class T>
struct Perpendicular {
  static constexpr int rows = 1;
  using Vector = Eigen::Matrix<T, 3, 1>;
  template <class U>
  using Rows = Eigen::Matrix<U, rows, 1>;
  Vector axis_a, axis_b;  // n and w, body frames

  template <class U>
  Rows<U> residual(const T&, const RigidState<U>& a, const RigidState<U>& b) const {
    return Rows<U>(DirectionProduct<U>(a, b, axis_a.template cast<U>(), axis_b.template cast<U>()).value());
  }
  template <class U>
  Rows<U> rate(const T&, const RigidState<U>& a, const RigidState<U>& b, bool) const {
    return Rows<U>(DirectionProduct<U>(a, b, axis_a.template cast<U>(), axis_b.template cast<U>()).rate());
  }
  template <class U>
  Rows<U> curvature(const T&, const RigidState<U>& a, const RigidState<U>& b) const {
    return Rows<U>(
        DirectionProduct<U>(a, b, axis_a.template cast<U>(), axis_b.template cast<U>()).curvature());
  }
  template <class U>
  void add_wrenches(const RigidState<U>& a, const RigidState<U>& b, const Rows<U>& lambda, Wrench<U>& on_a,
                    Wrench<U>& on_b) const {
    DirectionProduct<U>(a, b, axis_a.template cast<U>(), axis_b.template cast<U>())
        .add_torques(lambda(0), on_a, on_b);
  }
};

// The angle phi by which w of b is turned from axis_a towards across_a follows c(t):  Phi = phi - c(t), to within (-pi, pi], with
// tan phi = S / C, S = (R_a across_a) . (R_b w), C = (R_a axis_a) . (R_b w).
template <class T>
struct PrescribedAngle {
  static constexpr int rows = 1;
  using Vector = Eigen::Matrix<T, 3, 1>;
  template <class U>
  using Rows = Eigen::Matrix<U, rows, 1>;
  Vector axis_a, across_a, axis_b;
  PrescribedMotion<T> angle;

  template <class U>
  Rows<U> residual(const T& t, const RigidState<U>& a, const RigidState<U>& b) const {
    using std::atan2;
    using std::cos;
    using std::sin;
    const T c = angle.at(t)[0];
    const U cosine(cos(c)), sine(sin(c));
    const U C = product(axis_a, a, b).value(), S = product(across_a, a, b).value();
    return Rows<U>(atan2(S * cosine - C * sine, C * cosine + S * sine));
  }
  template <class U>
  Rows<U> rate(const T& t, const RigidState<U>& a, const RigidState<U>& b, bool moving) const {
    const auto c = product(axis_a, a, b), s = product(across_a, a, b);
    const U C = c.value(), S = s.value();
    U sum = (C * s.rate() - S * c.rate()) / (C * C + S * S);
    if (moving) sum -= U(angle.at(t)[1]);
    return Rows<U>(sum);
  }
  template <class U>
  Rows<U> curvature(const T& t, const RigidState<U>& a, const RigidState<U>& b) const {
    const auto c = product(axis_a, a, b), s = product(across_a, a, b);
    const U C = c.value(), S = s.value(), square = C * C + S * S;
    const U turn = (C * s.rate() - S * c.rate()) / square;
    return Rows<U>((C * s.curvature() - S * c.curvature()) / square -
                   turn * U(2.0) * (C * c.rate() + S * s.rate()) / square - U(angle.at(t)[2]));
  }
  template <class U>
  void add_wrenches(const RigidState<U>& a, const RigidState<U>& b, const Rows<U>& lambda, Wrench<U>& on_a,
                    Wrench<U>& on_b) const {
    const auto c = product(axis_a, a, b), s = product(across_a, a, b);
    const U C = c.value(), S = s.value(), square = C * C + S * S;
    s.add_torques(lambda(0) * C / square, on_a, on_b);
    c.add_torques(-lambda(0) * S / square, on_a, on_b);
  }

 private:
  template <class U>
  DirectionProduct<U> product(const Vector& n, const RigidState<U>& a, const RigidState<U>& b) const {
    return DirectionProduct<U>(a, b, n.template cast<U>(), axis_b.template cast<U>());
  }
};

// The distance of a point of b from a plane of a:  Phi = (R_a n) . (p_b - p_a) - c(t), n a unit vector.
template <class T>
struct InPlane {
  static constexpr int rows = 1;
  using Vector = Eigen::Matrix<T, 3, 1>;
  template <class U>
  using Rows = Eigen::Matrix<U, rows, 1>;
  Vector normal_a, point_a, point_b;
  PrescribedMotion<T> distance{};

  template <class U>
  Rows<U> residual(const T& t, const RigidState<U>& a, const RigidState<U>& b) const {
    return Rows<U>((a.R * normal_a.template cast<U>()).dot(apart(a, b)) - U(distance.at(t)[0]));
  }
  template <class U>
  Rows<U> rate(const T& t, const RigidState<U>& a, const RigidState<U>& b, bool moving) const {
    const Eigen::Matrix<U, 3, 1> n = normal_a.template cast<U>();
    U sum = turning<U>(a, n).dot(apart(a, b)) + (a.R * n).dot(apart_rate(a, b));
    if (moving && distance.moves()) sum -= U(distance.at(t)[1]);
    return Rows<U>(sum);
  }
  template <class U>
  Rows<U> curvature(const T& t, const RigidState<U>& a, const RigidState<U>& b) const {
    const Eigen::Matrix<U, 3, 1> n = normal_a.template cast<U>();
    U sum = turning_twice<U>(a, n).dot(apart(a, b)) + U(2.0) * turning<U>(a, n).dot(apart_rate(a, b)) +
            (a.R * n).dot(turning_twice<U>(b, point_b.template cast<U>()) -
                          turning_twice<U>(a, point_a.template cast<U>()));
    if (distance.moves()) sum -= U(distance.at(t)[2]);
    return Rows<U>(sum);
  }
  template <class U>
  void add_wrenches(const RigidState<U>& a, const RigidState<U>& b, const Rows<U>& lambda, Wrench<U>& on_a,
                    Wrench<U>& on_b) const {
    const Eigen::Matrix<U, 3, 1> n = normal_a.template cast<U>();
    const Eigen::Matrix<U, 3, 1> force = lambda(0) * (a.R * n);
    on_a.force -= force;
    // The normal turns with a, about the point of b.
    const Eigen::Matrix<U, 3, 1> arm = a.R.transpose() * (b.point(point_b.template cast<U>()) - a.x);
    on_a.torque += lambda(0) * n.cross(arm);
    on_b.force += force;
    on_b.torque += point_b.template cast<U>().cross(b.R.transpose() * force);
  }

 private:
  template <class U>
  Eigen::Matrix<U, 3, 1> apart(const RigidState<U>& a, const RigidState<U>& b) const {
    return b.point(point_b.template cast<U>()) - a.point(point_a.template cast<U>());
  }
  template <class U>
  Eigen::Matrix<U, 3, 1> apart_rate(const RigidState<U>& a, const RigidState<U>& b) const {
    return b.point_velocity(point_b.template cast<U>()) - a.point_velocity(point_a.template cast<U>());
  }
};

// A massless rod of length L:  Phi = (|p_b - p_a|^2 - L^2) / (2 L); lambda is the tension in it, N.
template <class T>
struct Distance {
  static constexpr int rows = 1;
  using Vector = Eigen::Matrix<T, 3, 1>;
  template <class U>
  using Rows = Eigen::Matrix<U, rows, 1>;
  Vector point_a, point_b;
  T length;

  template <class U>
  Rows<U> residual(const T&, const RigidState<U>& a, const RigidState<U>& b) const {
    return Rows<U>((apart(a, b).squaredNorm() - U(length * length)) / U(length * T(2.0)));
  }
  template <class U>
  Rows<U> rate(const T&, const RigidState<U>& a, const RigidState<U>& b, bool) const {
    return Rows<U>(apart(a, b).dot(apart_rate(a, b)) / U(length));
  }
  template <class U>
  Rows<U> curvature(const T&, const RigidState<U>& a, const RigidState<U>& b) const {
    return Rows<U>(
        (apart_rate(a, b).squaredNorm() + apart(a, b).dot(turning_twice<U>(b, point_b.template cast<U>()) -
                                                          turning_twice<U>(a, point_a.template cast<U>()))) /
        U(length));
  }
  template <class U>
  void add_wrenches(const RigidState<U>& a, const RigidState<U>& b, const Rows<U>& lambda, Wrench<U>& on_a,
                    Wrench<U>& on_b) const {
    const Eigen::Matrix<U, 3, 1> force = apart(a, b) * (lambda(0) / U(length));
    on_a.force -= force;
    on_a.torque -= point_a.template cast<U>().cross(a.R.transpose() * force);
    on_b.force += force;
    on_b.torque += point_b.template cast<U>().cross(b.R.transpose() * force);
  }

 private:
  template <class U>
  Eigen::Matrix<U, 3, 1> apart(const RigidState<U>& a, const RigidState<U>& b) const {
    return b.point(point_b.template cast<U>()) - a.point(point_a.template cast<U>());
  }
  template <class U>
  Eigen::Matrix<U, 3, 1> apart_rate(const RigidState<U>& a, const RigidState<U>& b) const {
    return b.point_velocity(point_b.template cast<U>()) - a.point_velocity(point_a.template cast<U>());
  }
};

}  // namespace liebench
