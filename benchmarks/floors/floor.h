#pragma once

#include <numbers>
#include <span>
#include <type_traits>

#include "benchmarks/floors/index3_top.h"
#include "benchmarks/floors/rotation.h"
#include "benchmarks/floors/so3_top.h"
#include "benchmarks/floors/stabilized_top.h"
#include "integrators/starting_values.h"

// A floor is what an engineer would write by hand for this one top and this one method: plain doubles, the structure of
// the problem written out (diagonal inertia, centre of mass on an axis, gravity on another), one straight loop. It does
// the arithmetic of the general stepper - same prediction, same closure in differences, same residual and matrix, a full
// LU factorization kept by the same rule, same end of the iteration, the last exponential - so that both follow the same
// trajectory to round-off, which the benchmark program checks before it measures. What the general code takes more time
// for than its floor is the price of its generality.
//
// Tops (one step of Newton's iteration): so3_top.h, index3_top.h, stabilized_top.h, and momentum_top.h for methods that balance the
// momentum. Where a matrix serves one solution alone (half-explicit stages, projections), what the diagonal mass matrix leaves of it,
// tip_force.h. The other files are methods.

namespace liebench::floors {

inline Vec3 commutator(const Vec3& v, const Vec3& w) {
  return cross(v, w);
}
inline Vec6 commutator(const Vec6& v, const Vec6& w) {
  return {{0.0, 0.0, 0.0}, cross(v.w, w.w)};
}

// The next value of the polynomial through the last `count` <= 5 values, newest first; those beyond count are zero.
inline constexpr double extrapolation[6][5] = {{0, 0, 0, 0, 0},  {1, 0, 0, 0, 0},   {2, -1, 0, 0, 0},
                                               {3, -3, 1, 0, 0}, {4, -6, 4, -1, 0}, {5, -10, 10, -5, 1}};

inline bool turns_too_far(const Vec3& turn) {
  return !(squared_norm(turn) < std::numbers::pi * std::numbers::pi);
}

// From and to the vectors of the general code, outside of the measured loop.
inline Vec3 from_eigen(const Eigen::Vector3d& v) {
  return {v(0), v(1), v(2)};
}
inline Vec6 from_eigen(const Eigen::Matrix<double, 6, 1>& v) {
  return {from_eigen(Eigen::Vector3d(v.head<3>())), from_eigen(Eigen::Vector3d(v.tail<3>()))};
}
inline Mat3 from_eigen(const Eigen::Matrix3d& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}
template <class Configuration>
Configuration configuration_from(const Eigen::Matrix3d& R) {
  return {from_eigen(R)};
}
template <class Configuration>
Configuration configuration_from(const std::pair<Eigen::Vector3d, Eigen::Matrix3d>& q) {
  return {from_eigen(q.first), from_eigen(q.second)};
}
inline double distance(const Vec3& a, const Eigen::Vector3d& b) {
  return max_norm(a - from_eigen(b));
}
inline double distance(const Vec6& a, const Eigen::Matrix<double, 6, 1>& b) {
  return max_norm(a - from_eigen(b));
}
template <class Configuration>
double distance(const Configuration& a, const Eigen::Matrix3d& R) {
  return max_norm(a.R - from_eigen(R));
}
template <class Configuration>
double distance(const Configuration& a, const std::pair<Eigen::Vector3d, Eigen::Matrix3d>& q) {
  return std::max(max_norm(a.R - from_eigen(q.second)), max_norm(a.x - from_eigen(q.first)));
}

// The rotation vector of R by its unit quaternion and the series of atan; angles beyond 1/4, which the benchmark never
// meets, by the groups' own function.
inline Vec3 log(const Mat3& R) {
  const double trace = R.xx + R.yy + R.zz;
  const Vec3 doubled{R.zy - R.yz, R.xz - R.zx, R.yx - R.xy};
  const double root = std::sqrt(trace + 1.0);
  const double t_squared = squared_norm(doubled) / ((trace + 1.0) * (trace + 1.0));
  if (!(trace > 1.0) || !(t_squared <= atan_series_reach)) {
    Eigen::Matrix3d m;
    m << R.xx, R.xy, R.xz, R.yx, R.yy, R.yz, R.zx, R.zy, R.zz;
    return from_eigen(SO3<double>::log(m));
  }
  constexpr double a[9] = {1.0,       -1.0 / 3, 1.0 / 5,   -1.0 / 7, 1.0 / 9,
                           -1.0 / 11, 1.0 / 13, -1.0 / 15, 1.0 / 17};
  double p = a[8];
  for (int i = 7; i >= 0; --i) p = p * t_squared + a[i];
  // Axis doubled / (2 root), cosine root / 2.
  return (2.0 / (root * root) * p) * doubled;
}

// Dq of the step from points[j], by the groups' own logarithm.
template <class System>
auto increment_from(double h, std::span<const SolutionPoint<System>> points, std::size_t j) {
  using Group = typename System::Group;
  return from_eigen((Group::log(Group::compose(Group::inverse(points[j].q), points[j + 1].q)) / h).eval());
}

// v and h v' affine in the change of the increment: BLieDF2nd and generalized-alpha.
template <class Vector>
struct AffineClosure {
  Vector base;             // the increment at d = 0
  Vector velocity;         // v_n
  Vector velocity_change;  // at d = 0
  Vector scaled_acceleration;
  double velocity_slope;
  double acceleration_slope;

  template <class Solution>
  void evaluate(double, const Vector& d, Solution& s) const {
    s.velocity_change = velocity_slope * d + velocity_change;
    s.scaled_acceleration = acceleration_slope * d + scaled_acceleration;
  }
  Mat3 velocity_derivative(double, const Vector&) const {
    return diagonal(velocity_slope, velocity_slope, velocity_slope);
  }
  Mat3 acceleration_derivative(double, const Vector&) const {
    return diagonal(acceleration_slope, acceleration_slope, acceleration_slope);
  }
};

}  // namespace liebench::floors
