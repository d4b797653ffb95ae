#include "harness/implied_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "harness/errors.h"
#include "harness/scene_assembly.h"
#include "harness/scene_reader.h"
#include "problems/scene_examples.h"
#include "problems/scene_model.h"
#include "tests/harness/scene_runs.h"

namespace liebench {
namespace {

// The tolerance of joints that fit.
constexpr double usual_tolerance = 1e-9;

std::vector<bool> implied_in(const SceneDescription& scene, double tolerance = usual_tolerance) {
  const SceneSystem<double> system(make_scene_model<double>(scene));
  return implied_rows(system, system.initial_configuration(), tolerance);
}
std::ptrdiff_t number_of(const std::vector<bool>& implied) {
  return std::count(implied.begin(), implied.end(), true);
}

struct DenseColumns {
  const SceneSystem<double>& system;
  Eigen::MatrixXd columns;
  template <class Block>
  void gradient(Eigen::Index row, int body, const Block& B) {
    columns.col(row).segment(system.model().bodies[std::size_t(body)].v, B.cols()) += B.transpose();
  }
};

// The definition, in double: what a row leaves at right angles to all rows before it (Gram-Schmidt, twice).
std::vector<bool> implied_by_definition(const SceneDescription& scene) {
  const SceneSystem<double> system(make_scene_model<double>(scene));
  DenseColumns B{system, Eigen::MatrixXd::Zero(velocity_size(system), system.multipliers())};
  system.gradient(system.initial_configuration(), B);
  std::vector<bool> implied;
  std::vector<Eigen::VectorXd> basis;
  for (Eigen::Index r = 0; r < B.columns.cols(); ++r) {
    Eigen::VectorXd rest = B.columns.col(r);
    for (int pass = 0; pass < 2; ++pass)
      for (const Eigen::VectorXd& direction : basis) rest -= direction.dot(rest) * direction;
    implied.push_back(rest.norm() <= usual_tolerance * B.columns.col(r).norm());
    if (!implied.back()) basis.push_back(rest.normalized());
  }
  return implied;
}

SceneDescription shuffled(SceneDescription scene, unsigned seed) {
  std::shuffle(scene.joints.begin(), scene.joints.end(), std::mt19937(seed));
  return scene;
}

std::vector<SceneDescription> scenes_that_come_with_it() {
  std::vector<SceneDescription> scenes;
  const auto folder = std::filesystem::path(LIEBENCH_SOURCE_DIR) / "problems" / "scenes";
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    scenes.push_back(read_scene_file(entry.path()));
  return scenes;
}
TEST(ImpliedRows, AreThoseThatGramAndSchmidtLeaveNothingOf) {
  for (const SceneDescription& scene : scenes_that_come_with_it())
    for (const unsigned seed : {0u, 1u, 2u}) {
      const SceneDescription other = seed == 0 ? scene : shuffled(scene, seed);
      EXPECT_EQ(implied_in(other), implied_by_definition(other)) << scene.name << ' ' << seed;
    }
  for (const unsigned seed : {1u, 2u})
    EXPECT_EQ(implied_in(shuffled(four_bar(20), seed)), implied_by_definition(shuffled(four_bar(20), seed)));
}

// Between what round-off leaves and what the least independent row has there is room for any tolerance.
TEST(ImpliedRows, AreTheSameForEveryToleranceAcrossTwelveDecades) {
  for (const SceneDescription& scene : scenes_that_come_with_it()) {
    const auto expected = implied_in(scene);
    for (const double tolerance : {1e-14, 1e-12, 1e-6, 1e-2})
      EXPECT_EQ(implied_in(scene, tolerance), expected) << scene.name << ' ' << tolerance;
  }
}

TEST(ImpliedRows, OfTheLoopsThatComeWithItAreNamedByTheirJoints) {
  using Names = std::vector<std::string>;
  const AssembledScene bricard = assembled_scene("bricard"), squeezer = assembled_scene("andrews_squeezer");
  EXPECT_EQ(number_of(bricard.implied), 1);
  EXPECT_EQ(bricard.redundant_joints, Names({"P5"}));
  EXPECT_EQ(number_of(squeezer.implied), 9);
  EXPECT_EQ(squeezer.redundant_joints, Names({"P 3", "P 4", "P 6"}));
}

// Each window closes one plane loop more: 15 rows, of which three are redundant, those that keep it in its plane.
TEST(ImpliedRows, OfWindowsAreThreeAWindowHoweverMany) {
  for (const int n : {1, 100, 1000}) {
    const SceneDescription scene = four_bar(n);
    const auto implied = implied_in(scene);
    ASSERT_EQ(implied.size(), std::size_t(15 * n + 5));
    EXPECT_EQ(number_of(implied), 3 * n);
    EXPECT_EQ(number_of(implied_in(shuffled(scene, 3))), 3 * n);
  }
  const AssembledScene assembled = assemble(four_bar(100), "four_bar");
  EXPECT_EQ(number_of(assembled.implied), 300);
  // The joint that closes its loop, the last of a window.
  ASSERT_EQ(assembled.redundant_joints.size(), 100u);
  for (std::size_t i = 0; i < 100; ++i)
    EXPECT_EQ(assembled.redundant_joints[i], "A " + std::to_string(i + 1));
}

TEST(ImpliedRows, OfTwoJointsThatSayTheSameAreThoseOfTheLaterOne) {
  const int n = 1000;
  EXPECT_EQ(number_of(implied_in(chain(n))), 0);
  for (const std::size_t place : {0u, 300u, 700u, 1000u}) {
    SceneDescription scene = chain(n);
    const JointDescription twin = scene.joints[500];
    scene.joints.insert(scene.joints.begin() + std::ptrdiff_t(place), twin);
    const auto implied = implied_in(scene);
    // Three rows a joint; before its twin it has moved that to place 501.
    const std::size_t later = 3 * std::max<std::size_t>(place, 501);
    EXPECT_EQ(number_of(implied), 3);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(implied[later + i]) << place << ' ' << i;
  }
}

// Point masses in an uneven net of n^2, each tied to its neighbours: 2 n (n - 1) strings, all independent, in an order in which the
// factor would fill; and some strings twice.
TEST(ImpliedRows, OfANetInAnyOrderAreAsManyAsTheStringsThatAreThereTwice) {
  const int n = 60;
  SceneDescription net;
  net.name = "net";
  const auto tie = [&](int a, int b) {
    JointDescription string;
    string.name = std::to_string(net.joints.size());
    string.kind = JointKind::distance;
    string.a = a;
    string.b = b;
    string.length = 1.0;
    net.joints.push_back(string);
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      BodyDescription knot;
      knot.name = std::to_string(n * i + j);
      knot.kind = BodyKind::r3;
      knot.position = {i + 0.1 * std::sin(3.0 * j), j + 0.1 * std::cos(5.0 * i),
                       0.3 * std::sin(7.0 * i * i + 2.0 * i * j + 3.0 * j)};
      net.bodies.push_back(knot);
      if (i > 0) tie(n * (i - 1) + j, n * i + j);
      if (j > 0) tie(n * i + j - 1, n * i + j);
    }
  EXPECT_EQ(number_of(implied_in(net)), 0);
  for (std::size_t i = 0; i < 50; ++i) net.joints.push_back(net.joints[100 * i]);
  EXPECT_EQ(number_of(implied_in(shuffled(net, 5))), 50);
}

TEST(ImpliedRows, OfASceneWithoutJointsAreNone) {
  SceneDescription scene = chain(3);
  scene.joints.clear();
  EXPECT_TRUE(implied_in(scene).empty());
}

// Ceres leaves a gap of some 1e-9 of a rod that it moved by centimetres.
TEST(ImpliedRows, OfASceneThatWasClosedFirstAreThoseOfItsClosedPose) {
  const auto file = std::filesystem::path(LIEBENCH_SOURCE_DIR) / "problems" / "scenes" / "bricard.json";
  for (const double shift : {1e-6, 1e-3, 0.05}) {
    SceneDescription apart = read_scene_file(file);
    apart.bodies[2].position += Eigen::Vector3d(shift, -shift, 0.5 * shift);
    const AssembledScene scene = assemble(apart, "bricard");
    EXPECT_TRUE(scene.moved());
    EXPECT_EQ(number_of(scene.implied), 1) << shift;
    EXPECT_LE(scene.gap_after, 1e-13) << shift;
  }
}

// The spatial slider-crank with axes of its universal joint that are in one plane with the conrod at the beginning.
TEST(ImpliedRows, ThatOthersImplyInASingularPlaceAloneAreRefused) {
  const auto folder = std::filesystem::path(LIEBENCH_SOURCE_DIR) / "problems" / "scenes";
  SceneDescription crank = read_scene_file(folder / "slider_crank.json");
  JointDescription& universal = crank.joints[2];
  universal.axis_a = Eigen::Vector3d(2.0, -1.0, 0.0).normalized();
  universal.axis_b = Eigen::Vector3d::UnitZ();
  crank.bodies[1].angular_velocity = {1.6941176470588235, -0.8470588235294118, 0.7058823529411765};
  try {
    assemble(crank, "crank.json");
    FAIL() << "it has two degrees of freedom there, and one beside";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("singular place"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("\"guide\""), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace liebench
