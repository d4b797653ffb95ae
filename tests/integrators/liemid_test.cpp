#include "integrators/liemid.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "groups/extended.h"
#include "groups/se3.h"
#include "problems/heavy_top.h"
#include "tests/support/observed_order.h"
#include "tests/support/steppers.h"
#include "tests/support/verlet.h"

namespace liebench::liemid_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr std::array variants{Liemid::Variant::one_step, Liemid::Variant::half_steps};

TEST(Liemid, HasOrderTwo) {
  for (const auto variant : variants) {
    const Errors order = observed_orders<Liemid, ExtendedSO3>({variant});
    EXPECT_NEAR(order.q, 2, order_tolerance) << int(variant);
    EXPECT_NEAR(order.v, 2, order_tolerance) << int(variant);
  }
}

// Krysl's equations for rotations, by rotation matrices of Eigen and fixed points: exp(-h w / 2) P is turned back by
// h w / 2.
class KryslSteps {
 public:
  using S = HeavyTopSO3<double>;
  using Vector = Eigen::Vector3d;
  KryslSteps(const S& system, int parts, double h) : system_(system), parts_(parts), h_(h) {
    R_ = system.initial_configuration();
    omega_ = system.initial_velocity();
  }
  const Eigen::Matrix3d& attitude() const { return R_; }
  const Vector& velocity() const { return omega_; }
  void step() {
    const Eigen::Matrix3d& J = system_.mass_matrix(R_);
    Vector momentum = J * omega_ + h_ / 2 * torque();
    for (int part = 0; part < parts_; ++part) {
      Vector theta = h_ / parts_ * omega_;
      for (int i = 0; i < 60; ++i)
        theta = h_ / parts_ * J.inverse() * (rotation(theta / 2).transpose() * momentum);
      R_ = (R_ * rotation(theta)).eval();
      momentum = (rotation(theta).transpose() * momentum).eval();
    }
    omega_ = J.inverse() * (momentum + h_ / 2 * torque());
  }

 private:
  Vector torque() const { return -system_.force(0.0, R_, Vector::Zero()); }
  static Eigen::Matrix3d rotation(const Vector& theta) {
    return Eigen::AngleAxisd(theta.norm(), theta.normalized()).toRotationMatrix();
  }
  S system_;
  int parts_;
  double h_;
  Eigen::Matrix3d R_;
  Vector omega_;
};

TEST(Liemid, IsKryslsMethodForRotations) {
  using S = HeavyTopSO3<double>;
  const S system(unsymmetric_top(1));
  constexpr double h = 1.0 / 32;
  for (const auto variant : variants) {
    KryslSteps textbook(system, variant == Liemid::Variant::half_steps ? 2 : 1, h);
    const auto stepper = make_stepper<Liemid, S>({variant}, system);
    const std::vector<SolutionPoint<S>> points{
        {0.0, textbook.attitude(), textbook.velocity(), Eigen::Vector3d::Zero(), {}}};
    ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
    for (int n = 1; n <= 32; ++n) {
      textbook.step();
      ASSERT_EQ(stepper->step().outcome, Outcome::ok);
      // A dozen roundings a step, through J of condition below ten.
      EXPECT_LE((stepper->velocity() - textbook.velocity()).norm(),
                100 * n * eps * textbook.velocity().norm())
          << n;
      EXPECT_LE((stepper->configuration() - textbook.attitude()).norm(), 100 * n * eps) << n;
    }
  }
}

TEST(Liemid, KeepsTheSpatialMomentumOfAFreeRotation) {
  using S = HeavyTopSO3<double>;
  HeavyTopParameters p = unsymmetric_top(1);
  p.gravity = {0, 0, 0};
  const S system(p);
  constexpr double h = 1.0 / 16;  // h |v| = 0.2: the momentum of a method of order two would be off by 1e-3
  for (const auto variant : variants) {
    const auto stepper = make_stepper<Liemid, S>({variant}, system);
    const Eigen::Matrix3d R = system.initial_configuration();
    const Eigen::Vector3d omega = system.initial_velocity();
    const std::vector<SolutionPoint<S>> points{{0.0, R, omega, Eigen::Vector3d::Zero(), {}}};
    ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
    const Eigen::Vector3d momentum = R * system.momentum(R, omega);
    for (int n = 1; n <= 400; ++n) {
      ASSERT_EQ(stepper->step().outcome, Outcome::ok);
      const Eigen::Vector3d now =
          stepper->configuration() * system.momentum(stepper->configuration(), stepper->velocity());
      ASSERT_LE((now - momentum).norm(), 10 * n * eps * momentum.norm()) << n;
    }
    // It is no motion at constant velocity.
    EXPECT_GE((stepper->velocity() - omega).norm(), 0.1);
  }
}

// A free body as a rigid motion, without forces: v = (U, Omega) in the body frame.
template <Scalar T>
class FreeBody {
 public:
  using Scalar = T;
  using Group = SE3<T>;
  template <class U>
  using rebind = FreeBody<U>;
  static constexpr int constraints = 0;
  static constexpr bool constant_mass = true;
  using Vector = Eigen::Matrix<T, 3, 1>;
  using Vector6 = Eigen::Matrix<T, 6, 1>;
  using Matrix6 = Eigen::Matrix<T, 6, 6>;
  using Element = typename Group::Element;
  using NoMultipliers = Eigen::Matrix<T, 0, 1>;

  template <class U>
  FreeBody<U> cast() const {
    return {};
  }
  Matrix6 mass_matrix(const Element&) const { return mass().asDiagonal(); }
  Vector6 momentum(const Element&, const Vector6& w) const { return mass().cwiseProduct(w); }
  Vector6 force(const T&, const Element& q, const Vector6& v) const {
    const Vector6 p = momentum(q, v);
    const Vector omega = v.template tail<3>();
    Vector6 g;
    g << omega.cross(Vector(p.template head<3>())), omega.cross(Vector(p.template tail<3>()));
    return g;
  }
  Matrix6 damping(const T&, const Element& q, const Vector6& v) const {
    const Vector6 p = momentum(q, v);
    const Vector omega = v.template tail<3>(), linear = p.template head<3>(), angular = p.template tail<3>();
    Matrix6 C = Matrix6::Constant(T(0.0));
    const Matrix6 M = mass_matrix(q);
    C.template topLeftCorner<3, 3>() = skew(omega) * M.template topLeftCorner<3, 3>();
    C.template topRightCorner<3, 3>() = -skew(linear);
    C.template bottomRightCorner<3, 3>() = skew(omega) * M.template bottomRightCorner<3, 3>() - skew(angular);
    return C;
  }
  Matrix6 stiffness(const T&, const Element&, const Vector6&, const Vector6&, const NoMultipliers&) const {
    return Matrix6::Constant(T(0.0));
  }
  T energy(const Element& q, const Vector6& v) const { return v.dot(momentum(q, v)) * T(0.5); }
  T angular_momentum(const Element&, const Vector6&) const { return T(0.0); }
  Element initial_configuration() const { return Group::identity(); }
  Vector6 initial_velocity() const {
    Vector6 v;
    v << T(0.5), T(-1.0), T(2.0), T(1.0), T(2.0), T(-0.5);
    return v;
  }

 private:
  static Vector6 mass() {
    Vector6 m;
    m << T(2.0), T(2.0), T(2.0), T(0.5), T(1.0), T(1.25);
    return m;
  }
};

TEST(Liemid, KeepsLinearAndAngularMomentumOfAFreeRigidMotion) {
  using S = FreeBody<double>;
  const S system;
  const auto spatial = [&](const S::Element& q, const S::Vector6& v) {
    const auto [x, R] = S::Group::represented(q);
    const S::Vector6 p = system.momentum(q, v);
    const Eigen::Vector3d linear = R * p.head<3>();
    Eigen::Matrix<double, 6, 1> all;
    all << linear, x.cross(linear) + R * p.tail<3>();
    return all;
  };
  for (const auto variant : variants) {
    const auto stepper = make_stepper<Liemid, S>({variant}, system);
    const std::vector<SolutionPoint<S>> points{
        {0.0, system.initial_configuration(), system.initial_velocity(), S::Vector6::Zero(), {}}};
    ASSERT_EQ(stepper->start(1.0 / 16, points).outcome, Outcome::ok);
    const auto before = spatial(points[0].q, points[0].v);
    for (int n = 1; n <= 100; ++n) {
      ASSERT_EQ(stepper->step().outcome, Outcome::ok);
      const auto now = spatial(stepper->configuration(), stepper->velocity());
      // x grows to |v| n h.
      ASSERT_LE((now - before).norm(), 20 * n * eps * before.norm() * (1 + n / 8.0)) << n;
    }
    EXPECT_GE((stepper->velocity() - points[0].v).norm(), 0.1);
  }
}

TEST(Liemid, IsVerletsMethodInALinearSpace) {
  for (const auto variant : variants) expect_verlets_method<Liemid>({variant});
}

TEST(Liemid, DoesNotFitAConstrainedProblem) {
  EXPECT_FALSE((may_fit<Liemid, HeavyTopR3xSO3<double>>()));
}

}  // namespace
}  // namespace liebench::liemid_test
