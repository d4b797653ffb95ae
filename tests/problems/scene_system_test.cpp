#include "problems/scene_system.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "problems/scene_model.h"
#include "tests/support/sample_scenes.h"

namespace liebench::scene_system_test {
namespace {

using System = SceneSystem<double>;
using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

constexpr std::array kinds{BodyKind::r3xso3, BodyKind::r3xs3, BodyKind::se3, BodyKind::s3_r3,
                           BodyKind::udq,    BodyKind::so3,   BodyKind::s3,  BodyKind::r3};
constexpr std::array joints{JointKind::spherical,   JointKind::revolute,  JointKind::prismatic,
                            JointKind::cylindrical, JointKind::universal, JointKind::planar,
                            JointKind::fixed,       JointKind::distance,  JointKind::point_on_plane};

// The pieces of linearize as dense matrices.
struct DensePieces {
  static constexpr bool wants_rate_gradient = true;
  const System& system;
  Matrix K, C, B, Z;
  explicit DensePieces(const System& s) : system(s) {
    const Eigen::Index m = velocity_size(s), l = s.multipliers();
    K = C = Matrix::Zero(m, m);
    B = Z = Matrix::Zero(l, m);
  }
  template <class Block>
  void stiffness(int i, int j, const Block& block) {
    add(K, place(i), place(j), block);
  }
  template <class Block>
  void damping(int i, int j, const Block& block) {
    add(C, place(i), place(j), block);
  }
  void turning_stiffness(int i, const Eigen::Matrix3d& block) { add(K, place(i) + 3, place(i) + 3, block); }
  void turning_damping(int i, const Eigen::Matrix3d& block) { add(C, place(i) + 3, place(i) + 3, block); }
  template <class Block>
  void gradient(Eigen::Index row, int j, const Block& block) {
    add(B, row, place(j), block);
  }
  template <class Block>
  void rate_gradient(Eigen::Index row, int j, const Block& block) {
    add(Z, row, place(j), block);
  }

 private:
  Eigen::Index place(int body) const { return system.model().bodies[std::size_t(body)].v; }
  template <class Block>
  static void add(Matrix& M, Eigen::Index row, Eigen::Index column, const Block& block) {
    M.block(row, column, block.rows(), block.cols()) += block;
  }
};

// Central differences of order four of a vector function along each direction of R^m.
template <class Function>
Matrix differences(Eigen::Index m, Eigen::Index rows, const Function& f) {
  constexpr double s = 1e-3;
  Matrix D(rows, m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const auto at = [&](double x) { return Vector(f(Vector(x * Vector::Unit(m, i)))); };
    D.col(i) = (8.0 * (at(s) - at(-s)) - (at(2.0 * s) - at(-2.0 * s))) / (12.0 * s);
  }
  return D;
}

// The fourth power of the step, and round-off over it, for entries of size `scale`.
double difference_tolerance(double scale) {
  return 1e-9 * (1.0 + scale);
}

void expect_pieces_are_derivatives(const SceneDescription& scene, const std::string& text) {
  const System system(make_scene_model<double>(scene));
  const auto group = system.group();
  const Vector q = system.initial_configuration(), v = system.initial_velocity();
  RandomNumbers random(5);
  Vector lambda(system.multipliers());
  for (Eigen::Index i = 0; i < lambda.size(); ++i) lambda(i) = random.vector<1>()(0);
  const double t = 0.3;
  DensePieces pieces(system);
  system.linearize(t, q, v, lambda, pieces);
  const Eigen::Index m = v.size(), l = lambda.size();
  const auto moved = [&](const Vector& w) { return Vector(group.compose(q, group.exp(w))); };
  const Matrix K = differences(m, m, [&](const Vector& w) {
    return Vector(system.force(t, moved(w), v) + system.constraint_force(moved(w), lambda));
  });
  const Matrix C = differences(m, m, [&](const Vector& w) { return system.force(t, q, v + w); });
  EXPECT_LE((pieces.K - K).norm(), difference_tolerance(K.norm())) << text;
  EXPECT_LE((pieces.C - C).norm(), difference_tolerance(C.norm())) << text;
  if (l == 0) return;
  const Matrix B = differences(m, l, [&](const Vector& w) { return system.constraint(t, moved(w)); });
  const Matrix Z = differences(m, l, [&](const Vector& w) { return system.constraint_product(moved(w), v); });
  EXPECT_LE((pieces.B - B).norm(), difference_tolerance(B.norm())) << text;
  EXPECT_LE((pieces.Z - Z).norm(), difference_tolerance(Z.norm())) << text;
  EXPECT_LE((B * v - system.constraint_product(q, v)).norm(), difference_tolerance(v.norm())) << text;
  EXPECT_LE((B.transpose() * lambda - system.constraint_force(q, lambda)).norm(),
            difference_tolerance(lambda.norm()))
      << text;
}

// d Phi / dt = B v + Phi_t and d^2 Phi / dt^2 = B v' + curvature along q(t) = q o exp(t v + t^2 a / 2), whose velocity at 0 is v
// and whose acceleration is a.
void expect_rates(const SceneDescription& scene, const std::string& text) {
  const System system(make_scene_model<double>(scene));
  const auto group = system.group();
  const Vector q = system.initial_configuration(), v = system.initial_velocity();
  RandomNumbers random(7);
  Vector a(v.size());
  for (Eigen::Index i = 0; i < a.size(); ++i) a(i) = random.vector<1>()(0);
  const double t_0 = 0.3, s = 2e-3;
  const auto phi = [&](double t) {
    return Vector(system.constraint(t_0 + t, group.compose(q, group.exp(t * v + 0.5 * t * t * a))));
  };
  const Vector first = (8.0 * (phi(s) - phi(-s)) - (phi(2 * s) - phi(-2 * s))) / (12.0 * s);
  const Vector second =
      (16.0 * (phi(s) + phi(-s)) - (phi(2 * s) + phi(-2 * s)) - 30.0 * phi(0.0)) / (12.0 * s * s);
  const Vector rate = system.constraint_rate(t_0, q, v);
  EXPECT_LE((first - rate).norm(), 1e-8 * (1.0 + rate.norm())) << text;
  const Vector expected = system.constraint_product(q, a) + system.constraint_curvature(t_0, q, v);
  EXPECT_LE((second - expected).norm(), 1e-7 * (1.0 + expected.norm())) << text;
}

TEST(SceneSystem, MatricesAreDerivativesForEveryKindOfBody) {
  for (const BodyKind first : kinds)
    for (const BodyKind second : {BodyKind::r3xso3, BodyKind::se3, BodyKind::so3}) {
      SceneDescription scene = two_bodies(first, second);
      std::get<std::vector<Placed<UniformGravity<double>>>>(scene.effects)
          .push_back({UniformGravity<double>{1.0, {0.1, 0.2, -9.81}}, 0, -1});
      std::get<std::vector<Placed<SpringDamper<double>>>>(scene.effects)
          .push_back({SpringDamper<double>{{0.1, 0.0, 0.2}, {0.0, 0.3, 0.1}, 7.0, 0.4, 0.5}, 0, 1});
      scene.joints.push_back(general_joint(JointKind::spherical, 0, 1));
      expect_pieces_are_derivatives(scene, std::to_string(int(first)) + " " + std::to_string(int(second)));
    }
}

TEST(SceneSystem, MatricesAreDerivativesForEveryJoint) {
  for (const JointKind kind : joints)
    for (const int a : {-1, 0})
      for (const BodyKind body : {BodyKind::r3xso3, BodyKind::se3, BodyKind::so3}) {
        SceneDescription scene = two_bodies(body, body);
        scene.joints.push_back(general_joint(kind, a, 1));
        expect_pieces_are_derivatives(scene, std::to_string(int(kind)));
        expect_rates(scene, std::to_string(int(kind)));
      }
}

TEST(SceneSystem, PrescribedMotionsHaveTheirRates) {
  for (const JointKind kind : {JointKind::revolute, JointKind::prismatic}) {
    SceneDescription scene = two_bodies(BodyKind::r3xso3, BodyKind::s3_r3);
    JointDescription joint = general_joint(kind, 0, 1);
    joint.motion = PrescribedMotion<double>{{0.2, 0.7, -0.3}, {{0.4, 2.0, 0.1}}};
    scene.joints.push_back(joint);
    expect_pieces_are_derivatives(scene, std::to_string(int(kind)));
    expect_rates(scene, std::to_string(int(kind)));
  }
}

TEST(SceneSystem, WhatIsNotThereIsNotComputed) {
  // A ball without gravity: no force at all; a point mass has no commutators.
  SceneDescription ball = two_bodies(BodyKind::r3xso3, BodyKind::r3xso3);
  for (BodyDescription& body : ball.bodies) body.inertia = 0.4 * Eigen::Matrix3d::Identity();
  const System system(make_scene_model<double>(ball));
  EXPECT_EQ(system.force(0.0, system.initial_configuration(), system.initial_velocity()), Vector::Zero(12));
  EXPECT_EQ(system.multipliers(), 0);
  EXPECT_FALSE(system.group().commutative());
  const System points(make_scene_model<double>(two_bodies(BodyKind::r3, BodyKind::r3)));
  EXPECT_TRUE(points.group().commutative());
  EXPECT_FALSE(points.model().bodies[0].has_inertial_forces());
}

// Energy is kinetic energy in the inertial frame and potential, whatever the group.
TEST(SceneSystem, EnergyDoesNotDependOnTheGroup) {
  double expected = 0.0;
  for (const BodyKind kind : {BodyKind::r3xso3, BodyKind::r3xs3, BodyKind::se3, BodyKind::s3_r3,
                              BodyKind::udq, BodyKind::so3, BodyKind::s3}) {
    const System system(make_scene_model<double>(heavy_top_scene(kind)));
    const double energy = system.energy(system.initial_configuration(), system.initial_velocity());
    const double momentum =
        system.angular_momentum(system.initial_configuration(), system.initial_velocity());
    if (kind == BodyKind::r3xso3) expected = energy;
    EXPECT_NEAR(energy, expected, 8 * 2.3e-16 * std::abs(expected));
    // J_3 Omega_3 about the tip.
    EXPECT_NEAR(momentum, -15.234375 * 4.61538, 1e-13);
  }
}

}  // namespace
}  // namespace liebench::scene_system_test
