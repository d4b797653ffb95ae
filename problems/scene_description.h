#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "problems/effects/list.h"
#include "problems/prescribed_motion.h"
#include "problems/scene_bodies.h"

// A scene as its author wrote it, in double; names resolved to indices. -1 is the ground.

namespace liebench {

struct BodyDescription {
  std::string name;
  BodyKind kind = BodyKind::r3xso3;
  double mass = 1.0;                                      // kg
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Identity();  // about the centre of mass, body frame, kg m^2
  Eigen::Vector3d position = Eigen::Vector3d::Zero();     // of the centre of mass, m
  Eigen::Vector4d orientation{1.0, 0.0, 0.0, 0.0};     // unit quaternion w, x, y, z, body to inertial frame
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // inertial frame, m/s
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  // body frame, rad/s
  Eigen::Vector3d fixed_point = Eigen::Vector3d::Zero();       // of a body with one, inertial frame, m
  bool gyroscopic = true;                                      // false: the effect is left out
};

enum class JointKind {
  spherical,    // a point of b is a point of a
  revolute,     // and an axis is common
  prismatic,    // b slides along an axis of a without turning
  cylindrical,  // b slides along an axis of a and turns about it
  universal,    // a point is common, and two axes are at a right angle
  planar,       // b moves in a plane of a
  fixed,
  distance,        // massless rod between two points
  point_on_plane,  // a point of b stays in a plane of a
};

// Points and axes in the frames of their bodies; of the ground in the inertial frame.
struct JointDescription {
  std::string name;
  JointKind kind = JointKind::spherical;
  int a = -1, b = -1;
  Eigen::Vector3d point_a = Eigen::Vector3d::Zero(), point_b = Eigen::Vector3d::Zero();
  // Unit vectors: the axis, or the normal of the plane; of a universal joint the one of a and the one of b.
  Eigen::Vector3d axis_a = Eigen::Vector3d::UnitZ(), axis_b = Eigen::Vector3d::UnitZ();
  // Unit vectors at a right angle to these that coincide where the joint's angle is zero.
  Eigen::Vector3d across_a = Eigen::Vector3d::UnitX(), across_b = Eigen::Vector3d::UnitX();
  double length = 0.0;                             // of a rod, m
  std::optional<PrescribedMotion<double>> motion;  // angle of a revolute, distance of a prismatic joint
};

struct SceneDescription {
  std::string name, summary;
  std::vector<BodyDescription> bodies;
  std::vector<JointDescription> joints;
  SceneEffects<double> effects;
  double duration = 1.0;  // s, where the user names none
  bool chaotic = false;   // compared by invariants and by the time to which trajectories agree
};

}  // namespace liebench
