#include "problems/scene_system.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "groups/extended.h"
#include "problems/check_system.h"
#include "problems/scene_model.h"
#include "problems/scene_with_power.h"
#include "tests/support/sample_scenes.h"

namespace liebench::scene_system_test {
namespace {

using System = SceneSystem<double>;
using Vector = Eigen::VectorXd;

constexpr std::array kinds{BodyKind::r3xso3, BodyKind::r3xs3, BodyKind::se3, BodyKind::s3_r3,
                           BodyKind::udq,    BodyKind::so3,   BodyKind::s3,  BodyKind::r3};
constexpr std::array joints{JointKind::spherical,   JointKind::revolute,  JointKind::prismatic,
                            JointKind::cylindrical, JointKind::universal, JointKind::planar,
                            JointKind::fixed,       JointKind::distance,  JointKind::point_on_plane};

// Every law but those of initial values, for axes and points here are in general position.
void expect_laws(const SceneDescription& scene, const std::string& text) {
  const SystemCheck check = check_system(SceneWithPower<double>(make_scene_model<double>(scene)),
                                         SceneWithPower<Extended>(make_scene_model<Extended>(scene)));
  EXPECT_NE(check.find(Law::stiffness), nullptr) << text;
  EXPECT_EQ(check.find(Law::gradient_derivative) != nullptr, !scene.joints.empty()) << text;
  for (const LawCheck& law : check.laws)
    if (!info(law.law).initial) {
      EXPECT_TRUE(law.holds) << text << ": " << message(law);
    }
}

TEST(SceneSystem, KeepsItsLawsForEveryKindOfBody) {
  for (const BodyKind first : kinds)
    for (const BodyKind second : {BodyKind::r3xso3, BodyKind::se3, BodyKind::so3}) {
      SceneDescription scene = two_bodies(first, second);
      std::get<std::vector<Placed<UniformGravity<double>>>>(scene.effects)
          .push_back({UniformGravity<double>{1.0, {0.1, 0.2, -9.81}}, 0, -1});
      std::get<std::vector<Placed<SpringDamper<double>>>>(scene.effects)
          .push_back({SpringDamper<double>{{0.1, 0.0, 0.2}, {0.0, 0.3, 0.1}, 7.0, 0.4, 0.5}, 0, 1});
      scene.joints.push_back(general_joint(JointKind::spherical, 0, 1));
      expect_laws(scene, std::to_string(int(first)) + " " + std::to_string(int(second)));
    }
}

TEST(SceneSystem, KeepsItsLawsForEveryJoint) {
  for (const JointKind kind : joints)
    for (const int a : {-1, 0})
      for (const BodyKind body : {BodyKind::r3xso3, BodyKind::se3, BodyKind::so3}) {
        SceneDescription scene = two_bodies(body, body);
        scene.joints.push_back(general_joint(kind, a, 1));
        expect_laws(scene, std::to_string(int(kind)));
      }
}

TEST(SceneSystem, KeepsItsLawsWherePrescribedMotionsDrive) {
  for (const JointKind kind : {JointKind::revolute, JointKind::prismatic}) {
    SceneDescription scene = two_bodies(BodyKind::r3xso3, BodyKind::s3_r3);
    JointDescription joint = general_joint(kind, 0, 1);
    joint.motion = PrescribedMotion<double>{{0.2, 0.7, -0.3}, {{0.4, 2.0, 0.1}}};
    scene.joints.push_back(joint);
    expect_laws(scene, std::to_string(int(kind)));
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
