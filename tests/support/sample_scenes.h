#pragma once

#include <Eigen/Core>
#include <vector>

#include "problems/scene_examples.h"
#include "problems/scene_model.h"
#include "tests/support/heavy_top_samples.h"

// Small scenes in code, for tests.

namespace liebench {

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
