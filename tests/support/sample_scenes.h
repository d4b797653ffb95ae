#pragma once

#include <Eigen/Core>
#include <vector>

#include "problems/heavy_top_parameters.h"
#include "problems/scene_model.h"
#include "tests/support/heavy_top_samples.h"

// Small scenes in code, for tests.

namespace liebench {

// The heavy top as a body of the kind, on a spherical joint or with a fixed point.
inline SceneDescription heavy_top_scene(BodyKind kind, const HeavyTopParameters& p = {}) {
  SceneDescription scene;
  scene.name = "heavy_top";
  BodyDescription top;
  top.name = "top";
  top.kind = kind;
  top.mass = p.mass;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) top.inertia(Eigen::Index(i), Eigen::Index(j)) = p.inertia[i][j];
  const auto vector = [](const std::array<double, 3>& a) { return Eigen::Vector3d(a[0], a[1], a[2]); };
  const Eigen::Vector3d X = vector(p.center_of_mass), omega = vector(p.angular_velocity);
  // The orientation of the samples of scenes is the identity.
  top.position = X;
  top.angular_velocity = omega;
  top.velocity = omega.cross(X);
  scene.bodies.push_back(top);
  if (!has_fixed_point(kind)) {
    JointDescription tip;
    tip.name = "tip";
    tip.b = 0;
    tip.point_b = -X;
    scene.joints.push_back(tip);
  }
  std::get<std::vector<Placed<UniformGravity<double>>>>(scene.effects)
      .push_back({UniformGravity<double>{p.mass * vector(p.gravity)}, 0, -1});
  return scene;
}

// Two bodies of kinds that a test chooses, in general position, without joints.
inline SceneDescription two_bodies(BodyKind first, BodyKind second) {
  SceneDescription scene;
  RandomNumbers random(17);
  for (const BodyKind kind : {first, second}) {
    BodyDescription body;
    body.name = scene.bodies.empty() ? "first" : "second";
    body.kind = kind;
    body.mass = 1.5 + double(scene.bodies.size());
    body.inertia = Eigen::Vector3d(0.3, 0.4, 0.5).asDiagonal();
    body.inertia(0, 1) = body.inertia(1, 0) = 0.05;
    body.position = random.vector<3>();
    body.orientation = random.vector<4>().normalized();
    if (kind == BodyKind::r3) body.orientation = {1.0, 0.0, 0.0, 0.0};
    body.velocity = random.vector<3>();
    body.angular_velocity = random.vector<3>();
    body.fixed_point = random.vector<3>();
    scene.bodies.push_back(body);
  }
  return scene;
}

// A joint of the kind between the two bodies at their present poses, its axes in general position: residuals do not vanish.
inline JointDescription general_joint(JointKind kind, int a, int b) {
  RandomNumbers random(23);
  JointDescription joint;
  joint.name = "joint";
  joint.kind = kind;
  joint.a = a;
  joint.b = b;
  joint.point_a = random.vector<3>();
  joint.point_b = random.vector<3>();
  const auto axes = [&](Eigen::Vector3d& axis, Eigen::Vector3d& across) {
    axis = random.vector<3>().normalized();
    across = axis.cross(random.vector<3>()).normalized();
  };
  axes(joint.axis_a, joint.across_a);
  axes(joint.axis_b, joint.across_b);
  joint.length = 0.7;
  return joint;
}

}  // namespace liebench
