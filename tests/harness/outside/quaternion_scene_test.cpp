#include "harness/outside/quaternion_scene.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "harness/outside/quaternion_top.h"
#include "harness/scene_assembly.h"
#include "problems/scene_model.h"
#include "tests/harness/sample_scenes.h"

// The equations of scenes that are handed to solvers from outside, against the scenes themselves and against differences.

namespace liebench::outside {
namespace {

using Vector = QuaternionScene::Vector;
using Matrix = QuaternionScene::Matrix;

constexpr double round_off = std::numeric_limits<double>::epsilon();

// Bodies on all groups, or some, in general positions, with forces on and between them. A point mass is the last.
const std::vector<std::string> all_groups{"R3xSO3", "R3xS3", "SE3", "S3|xR3", "UDQ", "SO3", "S3", "R3"};

// Without what no name may have.
std::string name_of(const std::string& group) {
  return group == "S3|xR3" ? "S3R3" : group;
}

AssembledScene scene_of(const std::vector<std::string>& groups) {
  Json scene{{"name", "groups"}, {"bodies", Json::array()}, {"effects", Json::array()}};
  for (const std::string& group : groups) {
    const auto i = double(scene["bodies"].size());
    Json body{{"name", name_of(group)},
              {"formulation", group},
              {"mass", 2.0 + i},
              {"position", {i, 0.5 - i, 0.3 * i}}};
    const bool fixed = group == "SO3" || group == "S3";
    if (fixed) body["fixed_point"] = {i, 0.3, 0.2};
    if (!fixed) body["velocity"] = {1.0, -0.5 * i, 2.0};
    if (group != "R3") {
      body["inertia"] = {1.0, 1.5 + 0.1 * i, 2.0};
      body["orientation"] = {0.6, -0.3, 0.4, 0.7};
      body["angular_velocity"] = {1.0, 2.0, -1.0 - i};
    }
    scene["bodies"].push_back(body);
  }
  scene["effects"] = scene_json(R"([{"type": "uniform_gravity", "acceleration": [1, 2, -9.81]},
    {"type": "drag", "linear": 0.3, "quadratic": 0.1, "angular_linear": 0.2}])");
  std::string before = "ground";
  for (const std::string& group : groups) {
    scene["effects"].push_back({{"type", "spring_damper"},
                                {"bodies", {before, name_of(group)}},
                                {"points", {{0.0, 0.4, 0.0}, {group == "R3" ? 0.0 : 0.2, 0.0, 0.0}}},
                                {"stiffness", 30.0},
                                {"damping", 2.0},
                                {"rest_length", 0.5}});
    before = name_of(group);
  }
  scene["effects"].push_back({{"type", "applied_force"},
                              {"body", name_of(groups.front())},
                              {"force", {1.0, -3.0, 2.0}},
                              {"point", {0.1, 0.2, 0.3}},
                              {"frame", "body"},
                              {"factor", {{"expression", "sin(2*t)"}}}});
  return assemble(read_scene(scene), "test");
}

// Few bodies need no heap, more do.
const std::vector<std::vector<std::string>> samples{
    {"R3xSO3"}, {"SE3", "SO3", "R3"}, {"UDQ", "S3"}, all_groups};

struct Sample {
  explicit Sample(const std::vector<std::string>& groups)
      : scene(scene_of(groups)), model(quaternion_model(scene)), equations(model), own(scene, model) {}
  Vector derivative(const Vector& y) const {
    Vector f(y.size());
    equations.derivative(t, y, f);
    return f;
  }
  AssembledScene scene;
  QuaternionScene::Data model;
  QuaternionScene equations;
  OwnState own;
  double t = 0.4;
};

TEST(QuaternionSceneTest, TheStateBeginsWhereTheSceneDoes) {
  for (const auto& groups : samples) {
    const Sample s(groups);
    const auto model = make_scene_model<double>(s.scene.scene);
    const SceneGroup<double> group(model->bodies);
    const Vector y = s.equations.initial();
    EXPECT_LE(group.separation(s.own.configuration(y), model->q).norm(),
              10.0 * round_off * double(groups.size()));
    EXPECT_EQ(s.own.velocity(y), model->v);
    EXPECT_LE(group.defect(s.own.configuration(y)), 10.0 * round_off);
  }
}

TEST(QuaternionSceneTest, FulfilsTheEquationsOfTheScene) {
  for (const auto& groups : samples) {
    const Sample s(groups);
    const SceneSystem<double> system(make_scene_model<double>(s.scene.scene));
    const Vector y = s.equations.initial(), f = s.derivative(y);
    const Vector q = s.own.configuration(y), v = s.own.velocity(y), acceleration = s.own.velocity(f);
    const Vector force = system.force(s.t, q, v);
    EXPECT_LE((system.momentum(q, acceleration) + force).norm(), 1000.0 * round_off * force.norm());

    // q' = q v~ in the scene's own group, by central differences: d^2 times third derivatives.
    const double d = 1e-4;
    const SceneGroup<double> group = system.group();
    const Vector ahead = group.separation(q, s.own.configuration(y + d * f)),
                 behind = group.separation(q, s.own.configuration(y - d * f));
    EXPECT_LE(((ahead - behind) / (2.0 * d) - v).norm(), 100.0 * d * d * v.norm());
  }
}

TEST(QuaternionSceneTest, TheLengthOfAQuaternionHasNoEffect) {
  const Sample s(all_groups);
  EXPECT_EQ(s.equations.quaternions().size(), 7u);
  const Vector y = s.equations.initial(), f = s.derivative(y);
  Vector longer = y;
  for (const Eigen::Index place : s.equations.quaternions()) {
    longer.segment<4>(place) *= 3.0;
    EXPECT_LE(std::abs(f.segment<4>(place).dot(y.segment<4>(place))),
              10.0 * round_off * f.segment<4>(place).norm());
  }
  const Vector f_longer = s.derivative(longer);
  EXPECT_LE((s.own.velocity(f_longer) - s.own.velocity(f)).norm(), 1000.0 * round_off * f.norm());
  EXPECT_LE((s.own.configuration(longer) - s.own.configuration(y)).norm(), 100.0 * round_off * y.norm());
}

// Off the unit sphere, too: where the iterates of a solver are.
TEST(QuaternionSceneTest, TheJacobianIsTheDerivative) {
  for (const auto& groups : samples) {
    const Sample s(groups);
    Vector y = s.equations.initial();
    for (Eigen::Index i = 0; i < y.size(); ++i) y(i) += 0.1 * std::sin(double(i));
    Matrix J(y.size(), y.size());
    s.equations.jacobian(s.t, y, J);
    // Central differences of step d err by d^2 times third derivatives, and by eps / d times values, both of the size of
    // a hundred here.
    const double d = 1e-5;
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      const Vector step = d * Vector::Unit(y.size(), i);
      const Vector column = (s.derivative(y + step) - s.derivative(y - step)) / (2.0 * d);
      EXPECT_LE((J.col(i) - column).norm(), 1e-7 * J.norm()) << i;
    }
  }
}

TEST(QuaternionSceneTest, OfATopIsTheTop) {
  const AssembledScene scene = assemble(read_scene(scene_json(R"({"name": "top",
    "bodies": [{"name": "top", "formulation": "SO3", "fixed_point": [0, 0, 0], "mass": 15,
                "inertia": [0.234375, 0.46875, 0.234375], "position": [0, 1, 0],
                "angular_velocity": [0, 150, -4.61538]}],
    "effects": [{"type": "uniform_gravity", "acceleration": [0, 0, -9.81]}]})")),
                                        "test");
  const QuaternionScene equations(quaternion_model(scene));
  const QuaternionTop top{HeavyTopParameters{}};
  EXPECT_EQ(equations.initial(), Vector(top.initial()));
  const Vector y = equations.initial() + 0.1 * Vector::LinSpaced(7, -1.0, 1.0);
  Vector f(7);
  QuaternionTop::Vector f_top;
  equations.derivative(0.0, y, f);
  top.derivative(0.0, y, f_top);
  EXPECT_LE((f - f_top).norm(), 100.0 * round_off * f.norm());
  Matrix J(7, 7);
  QuaternionTop::Matrix J_top;
  equations.jacobian(0.0, y, J);
  top.jacobian(0.0, y, J_top);
  EXPECT_LE((J - J_top).norm(), 100.0 * round_off * J_top.norm());
}

}  // namespace
}  // namespace liebench::outside
