#include "harness/scene_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/harness/sample_scenes.h"

namespace liebench {
namespace {

using testing::HasSubstr;

// What a scene becomes.

TEST(SceneReader, ResolvesNamesAndFrames) {
  const SceneDescription scene = read_scene(scene_json(base_scene));
  ASSERT_EQ(scene.bodies.size(), 3u);
  EXPECT_EQ(scene.bodies[2].kind, BodyKind::r3);
  ASSERT_EQ(scene.joints.size(), 2u);
  const JointDescription& hinge = scene.joints[0];
  EXPECT_EQ(hinge.kind, JointKind::revolute);
  EXPECT_EQ(hinge.a, -1);
  EXPECT_EQ(hinge.b, 0);
  EXPECT_EQ(hinge.point_b, Eigen::Vector3d(-1, 0, 0));
  // x of the inertial frame is -y of a rod that a right angle about z has turned; to the digits of the angle.
  const JointDescription& guide = scene.joints[1];
  EXPECT_LT((guide.axis_b - Eigen::Vector3d(0, -1, 0)).norm(), 1e-15);
  EXPECT_LT(guide.point_b.norm(), 1e-15);
  EXPECT_EQ(guide.point_a, Eigen::Vector3d(1, 0, 0));
}

TEST(SceneReader, PointsInTheFrameOfABodyAreTheDecimalsThatTheyMean) {
  // In double 0.3 - 0.1 is not 0.2.
  Json json = changed_scene("/bodies/0/position", "[0.1, 0, 0]");
  json["joints"][0]["point"] = {0.3, 0, 0};
  EXPECT_EQ(read_scene(json).joints[0].point_b(0), 0.2);
}

TEST(SceneReader, GivesAShapeItsMassAndInertia) {
  const auto body = [](const std::string& shape) {
    return read_scene(changed_scene("/bodies/1/shape", shape)).bodies[1];
  };
  const BodyDescription rod = read_scene(scene_json(base_scene)).bodies[1];
  EXPECT_NEAR(rod.mass, 2.0, 1e-15);
  EXPECT_NEAR(rod.inertia(0, 0), 2.0 * 0.02 / 12.0, 1e-15);
  EXPECT_NEAR(rod.inertia(1, 1), 2.0 * 4.01 / 12.0, 1e-15);
  const BodyDescription box = body(R"({"type": "box", "size": [1, 2, 3], "density": 10})");
  EXPECT_NEAR(box.mass, 60.0, 1e-13);
  EXPECT_LT((box.inertia.diagonal() - Eigen::Vector3d(65, 50, 25)).norm(), 1e-12);
  const BodyDescription ball = body(R"({"type": "sphere", "radius": 2, "density": 3})");
  EXPECT_NEAR(ball.mass, 32.0 * std::acos(-1.0), 1e-12);
  EXPECT_NEAR(ball.inertia(2, 2), 1.6 * ball.mass, 1e-12);
  const BodyDescription disc =
      body(R"({"type": "cylinder", "radius": 2, "length": 1, "axis": "y", "density": 1})");
  EXPECT_NEAR(disc.inertia(1, 1), 2.0 * disc.mass, 1e-12);
  EXPECT_NEAR(disc.inertia(0, 0), 13.0 / 12.0 * disc.mass, 1e-12);
}

TEST(SceneReader, GivesABodyWithAFixedPointTheVelocityThatFollows) {
  Json json = changed_scene("/bodies/0/formulation", "\"SO3\"");
  json["bodies"][0]["fixed_point"] = {0, 0, 0};
  json["bodies"][0]["angular_velocity"] = {0, 0, 3};
  EXPECT_EQ(read_scene(json).bodies[0].velocity, Eigen::Vector3d(0, 3, 0));
}

TEST(SceneReader, AnEffectSwitchedOffIsAsIfItWereNotWritten) {
  const SceneDescription without = read_scene(scene_json(base_scene));
  const char* drag = R"({"type": "drag", "linear": 1, "enabled": false})";
  EXPECT_EQ(effect_count(read_scene(with_effect(drag))), effect_count(without));
  EXPECT_THAT(scene_error(with_effect(R"({"type": "drag", "linear": -1, "enabled": false})")),
              HasSubstr("/effects/2/linear"));
}

TEST(SceneReader, TheGyroscopicTorqueIsOnUntilItIsSwitchedOff) {
  EXPECT_TRUE(read_scene(with_effect(R"({"type": "gyroscopic"})")).bodies[0].gyroscopic);
  const SceneDescription off =
      read_scene(with_effect(R"({"type": "gyroscopic", "bodies": ["crank"], "enabled": false})"));
  EXPECT_FALSE(off.bodies[0].gyroscopic);
  EXPECT_TRUE(off.bodies[1].gyroscopic);
}

TEST(SceneReader, GravityActsOnAllBodiesOrThoseOfAList) {
  EXPECT_EQ(effects_of<UniformGravity>(read_scene(scene_json(base_scene))).size(), 3u);
  const SceneDescription one = read_scene(changed_scene("/effects/0/bodies", "[\"bead\"]"));
  ASSERT_EQ(effects_of<UniformGravity>(one).size(), 1u);
  EXPECT_EQ(effects_of<UniformGravity>(one)[0].a, 2);
  EXPECT_EQ(effects_of<UniformGravity>(one)[0].effect.weight(2), -4.905);
}

TEST(SceneReader, ASpringRestsAtItsPresentLength) {
  const SceneDescription scene = read_scene(scene_json(base_scene));
  EXPECT_EQ(effects_of<SpringDamper>(scene).at(0).effect.rest_length, 3.0);
}

TEST(SceneReader, AMassLessRodKeepsThePresentDistance) {
  const char* rod = R"({"type": "distance", "bodies": ["ground", "bead"], "points": [[0, 4, 0], [0, 0, 0]]})";
  EXPECT_EQ(read_scene(with_joint(rod)).joints[2].length, 5.0);
}

TEST(SceneReader, JointsWithoutNamesAreToldApart) {
  const char* joint = R"({"type": "spherical", "bodies": ["ground", "bead"], "point": [3, 0, 0]})";
  Json json = with_joint(joint);
  json["joints"].push_back(scene_json(joint));
  const SceneDescription scene = read_scene(json);
  EXPECT_EQ(scene.joints[2].name, "spherical ground - bead");
  EXPECT_EQ(scene.joints[3].name, "spherical ground - bead #4");
}

// Every joint and every effect, as the program and the schema accept it.

const std::vector<std::string>& good_joints() {
  static const std::vector<std::string> list{
      R"({"type": "spherical", "bodies": ["rod", "bead"], "points": [[0, 0, 0], [1, 0, 0]]})",
      R"({"type": "revolute", "bodies": ["rod", "ground"], "points": [[0, 0, 0], [2, 0, 0]],
          "axes": [[0, 0, 1], [0, 0, 3]], "motion": {"polynomial": [0, 6.28]}})",
      R"({"type": "prismatic", "bodies": ["ground", "rod"], "point": [0, 0, 0], "axis": [1, 1, 0],
          "motion": {"sines": [{"amplitude": 1, "angular_frequency": 2}]}})",
      R"({"type": "cylindrical", "bodies": ["ground", "rod"], "point": [0, 0, 0], "axis": [1, 1, 0]})",
      R"({"type": "universal", "bodies": ["crank", "rod"], "point": [0, 0, 0], "axes": [[1, 0, 0], [1, 0, 0]]})",
      R"({"type": "planar", "bodies": ["ground", "rod"], "point": [0, 0, 0], "normal": [0, 0, 1]})",
      R"({"type": "fixed", "bodies": ["crank", "rod"]})",
      R"({"type": "fixed", "bodies": ["rod", "ground"], "point": [1, 2, 3]})",
      R"({"type": "distance", "bodies": ["rod", "bead"], "points": [[0, 0, 0], [0, 0, 0]], "length": 2})",
      R"({"type": "point_on_plane", "bodies": ["ground", "bead"], "point": [0, 0, 0], "normal": [0, 0, 1]})"};
  return list;
}

const std::vector<std::string>& good_effects() {
  static const std::vector<std::string> list{
      R"({"type": "uniform_gravity", "name": "g", "acceleration": [0, 0, -1], "bodies": ["rod", "crank"]})",
      R"({"type": "point_gravity", "gravitational_parameter": 4e14, "center": [0, 0, 7e6]})",
      R"({"type": "spring_damper", "bodies": ["crank", "rod"], "points": [[0, 0, 0], [0, 0, 1]],
          "stiffness": 1, "damping": 2, "rest_length": 0})",
      R"({"type": "torsional_spring", "joint": "hinge", "stiffness": 1, "damping": 2, "rest_angle": -1})",
      R"({"type": "bushing", "bodies": ["ground", "rod"], "point": [0, 0, 0], "stiffness": [1, 2, 3],
          "damping": [0, 1, 0], "rotational_stiffness": [1, 1, 1], "rotational_damping": [0, 0, 0]})",
      R"({"type": "drag", "linear": 1, "quadratic": 2, "angular_linear": 3, "angular_quadratic": 4})",
      R"({"type": "applied_force", "body": "rod", "force": [1, 0, 0], "point": [0, 1, 0], "factor": 2})",
      R"({"type": "applied_force", "body": "rod", "torque": [1, 0, 0], "frame": "body",
          "factor": {"table": [[0, 0], [1, 5], [2, 0]]}})",
      R"({"type": "applied_force", "body": "bead", "force": [1, 0, 0], "factor": {"expression": "2*sin(2*t) + 1"}})",
      R"({"type": "motor", "joint": "hinge", "target": {"polynomial": [1]}, "kp": 10, "kd": 1, "limit": 5})",
      R"({"type": "joint_friction", "joint": "hinge", "torque": 1, "slip_velocity": 0.1})",
      R"({"type": "joint_friction", "joint": "guide", "force": 1, "slip_velocity": 0.1})",
      R"({"type": "contact", "body": "rod", "radius": 0.1, "plane": {"normal": [0, 0, 2]}, "stiffness": 1e5})",
      R"({"type": "contact", "body": "rod", "center": [1, 0, 0], "radius": 0, "plane": {"point": [0, 0, 1],
          "normal": [0, 0, 1]}, "stiffness": 1e5, "exponent": 1.5, "damping": 1, "friction": 0.3, "slip_velocity": 1e-3})",
      R"({"type": "gyroscopic", "bodies": ["rod"], "enabled": false})"};
  return list;
}

TEST(SceneReader, AcceptsEveryJointAsTheSchemaDoes) {
  for (const std::string& joint : good_joints()) {
    const Json scene = with_joint(joint);
    EXPECT_EQ(scene_error(scene), "accepted") << joint;
    EXPECT_EQ(scene_schema().violations(scene.dump()), "") << joint;
  }
}

TEST(SceneReader, AcceptsEveryEffectAsTheSchemaDoes) {
  const std::size_t before = effect_count(read_scene(scene_json(base_scene)));
  for (const std::string& effect : good_effects()) {
    const Json scene = with_effect(effect);
    ASSERT_EQ(scene_error(scene), "accepted") << effect;
    EXPECT_EQ(scene_schema().violations(scene.dump()), "") << effect;
    // The gyroscopic torque is no effect of the list, but belongs to the body.
    const std::size_t added = effect.find("gyroscopic") == std::string::npos ? 1 : 0;
    EXPECT_GE(effect_count(read_scene(scene)), before + added) << effect;
  }
}

TEST(SceneReader, AcceptsEveryFormulationAsTheSchemaDoes) {
  for (const char* name : {"R3xSO3", "R3xS3", "SE3", "S3|xR3", "UDQ", "SO3", "S3"}) {
    Json scene = changed_scene("/bodies/0/formulation", '"' + std::string(name) + '"');
    if (std::string(name).size() <= 3 && std::string(name).front() == 'S' && std::string(name) != "SE3")
      scene["bodies"][0]["fixed_point"] = {0, 0, 0};
    EXPECT_EQ(scene_error(scene), "accepted") << name;
    EXPECT_EQ(scene_schema().violations(scene.dump()), "") << name;
  }
}

}  // namespace
}  // namespace liebench
