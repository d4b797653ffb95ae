#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>

#include "problems/heavy_top_parameters.h"
#include "problems/scene_description.h"

// Scenes of any size, and the heavy top of any parameters. The others are data: problems/scenes.

namespace liebench {

// The heavy top as a body of the kind, on a spherical joint or with a fixed point; the orientation of the parameters is not looked at: it is the identity.
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
      .push_back({UniformGravity<double>{p.mass, vector(p.gravity)}, 0, -1});
  return scene;
}

// n rods in a row along x from the origin, where the first hangs on the ground: each of length 1 m, mass 1 kg and a square cross
// section 0.1 m wide, joined by spherical joints, at rest; gravity of 9.81 m/s^2 along -z. n = 3 is problems/scenes/chain_3.json.
inline SceneDescription chain(int n) {
  SceneDescription scene;
  scene.name = "chain_" + std::to_string(n);
  scene.summary = "rods in a row, hung up at one end and let go from the horizontal";
  for (int i = 1; i <= n; ++i) {
    BodyDescription rod;
    rod.name = "rod " + std::to_string(i);
    rod.position = {i - 0.5, 0.0, 0.0};
    rod.inertia = Eigen::Vector3d(0.02 / 12.0, 1.01 / 12.0, 1.01 / 12.0).asDiagonal();
    scene.bodies.push_back(rod);
    JointDescription joint;
    joint.name = "joint " + std::to_string(i);
    joint.kind = JointKind::spherical;
    joint.a = i - 2;
    joint.b = i - 1;
    joint.point_a = {i == 1 ? 0.0 : 0.5, 0.0, 0.0};
    joint.point_b = {-0.5, 0.0, 0.0};
    scene.joints.push_back(joint);
    std::get<std::vector<Placed<UniformGravity<double>>>>(scene.effects)
        .push_back({{1.0, {0.0, 0.0, -9.81}}, i - 1, -1});
  }
  return scene;
}

// n windows of bars, A02 of the IFToMM library: n + 1 links that stand upright on the ground in the points A_i = (i, 0, 0), their
// upper ends B_i coupled by n bars, all of length 1 m and mass 1 kg and slender, by revolute joints about z. B_0 begins with 1 m/s
// along x; gravity of 9.81 m/s^2 along -y. A pendulum of one degree of freedom:
//
//   phi'' = w2 sin(phi), w2 = g ((n + 1) / 2 + n) / ((n + 1) / 3 + n), phi(0) = 0, phi'(0) = 1 rad/s, clockwise from upright
//
// on the branch where the bars stay level. Three of the constraints of each window are redundant. n = 2 is
// problems/scenes/four_bar.json.
inline SceneDescription four_bar(int n) {
  SceneDescription scene;
  scene.name = "four_bar_" + std::to_string(n);
  scene.summary = "windows of bars: a pendulum of one degree of freedom, singular when flat";
  scene.duration = 10.0;
  // About the axis of a bar any moment does: none turns about it.
  constexpr double across = 1.0 / 12.0, along = 0.001;
  const auto add_body = [&](const BodyDescription& body) {
    const int index = int(scene.bodies.size());
    scene.bodies.push_back(body);
    std::get<std::vector<Placed<UniformGravity<double>>>>(scene.effects)
        .push_back({{body.mass, {0.0, -9.81, 0.0}}, index, -1});
    return index;
  };
  const auto add_link = [&](int i) {
    BodyDescription link;
    link.name = "link " + std::to_string(i);
    link.inertia = Eigen::Vector3d(across, along, across).asDiagonal();
    link.position = {double(i), 0.5, 0.0};
    link.velocity = {0.5, 0.0, 0.0};
    link.angular_velocity = {0.0, 0.0, -1.0};
    return add_body(link);
  };
  const auto add_joint = [&](const std::string& name, int a, const Eigen::Vector3d& point_a, int b,
                             const Eigen::Vector3d& point_b) {
    JointDescription joint;
    joint.name = name;
    joint.kind = JointKind::revolute;
    joint.a = a;
    joint.b = b;
    joint.point_a = point_a;
    joint.point_b = point_b;
    scene.joints.push_back(joint);
  };
  const Eigen::Vector3d foot(0.0, -0.5, 0.0), head(0.0, 0.5, 0.0), left(-0.5, 0.0, 0.0), right(0.5, 0.0, 0.0);
  int before = add_link(0);
  add_joint("A 0", -1, Eigen::Vector3d::Zero(), before, foot);
  for (int i = 1; i <= n; ++i) {
    const std::string number = std::to_string(i);
    BodyDescription coupler;
    coupler.name = "coupler " + number;
    coupler.inertia = Eigen::Vector3d(along, across, across).asDiagonal();
    coupler.position = {i - 0.5, 1.0, 0.0};
    coupler.velocity = {1.0, 0.0, 0.0};
    const int bar = add_body(coupler), link = add_link(i);
    add_joint("B " + std::to_string(i - 1) + " " + number, before, head, bar, left);
    add_joint("B " + number, bar, right, link, head);
    add_joint("A " + number, -1, {double(i), 0.0, 0.0}, link, foot);
    before = link;
  }
  return scene;
}

}  // namespace liebench
