#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "harness/errors.h"
#include "harness/references/scene_reference.h"
#include "problems/scene_examples.h"
#include "problems/scene_model.h"
#include "tests/harness/sample_scenes.h"

// The scenes that come with it: problems/scenes and problems/scene_examples.h.

namespace liebench {
namespace {

using System = SceneSystem<double, Eigen::Dynamic>;

std::filesystem::path scene_file(const std::string& name) {
  return std::filesystem::path(LIEBENCH_SOURCE_DIR) / "problems" / "scenes" / (name + ".json");
}

SceneDescription scene_of(const std::string& name) {
  return read_scene_file(scene_file(name));
}

std::vector<std::filesystem::path> scene_files() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(scene_file("x").parent_path()))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

double largest(const Eigen::VectorXd& v) {
  return v.size() == 0 ? 0.0 : v.cwiseAbs().maxCoeff();
}

// Accelerations at the initial state, of all solutions with redundant constraints the one with the least multipliers.
Eigen::VectorXd initial_accelerations(const System& system) {
  const auto q = system.initial_configuration();
  const auto v = system.initial_velocity();
  const Eigen::Index n = v.size(), l = system.multipliers();
  Eigen::MatrixXd saddle = Eigen::MatrixXd::Zero(n + l, n + l);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::VectorXd e = Eigen::VectorXd::Unit(n, i);
    saddle.col(i) << system.momentum(q, e), system.constraint_product(q, e);
  }
  saddle.topRightCorner(n, l) = saddle.bottomLeftCorner(l, n).transpose();
  Eigen::VectorXd right(n + l);
  right << -system.force(0.0, q, v), -system.constraint_curvature(0.0, q, v);
  return saddle.completeOrthogonalDecomposition().solve(right).head(n);
}

// The angular acceleration of body i on R^3 x SO(3).
Eigen::Vector3d turning_acceleration(const Eigen::VectorXd& a, Eigen::Index i) {
  return a.segment<3>(6 * i + 3);
}

TEST(Scenes, AreCompiledIntoTheProgram) {
  std::vector<std::string> names;
  for (const auto& file : scene_files()) {
    names.push_back("builtin:" + file.stem().string());
    EXPECT_EQ(read_scene_json(names.back()), read_scene_json(file));
  }
  std::vector<std::string> listed = builtin_scenes();
  std::sort(listed.begin(), listed.end());
  EXPECT_EQ(listed, names);
  try {
    read_scene_file("builtin:bricart");
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.place(), "builtin:bricart");
    EXPECT_NE(error.message().find("did you mean \"builtin:bricard\"?"), std::string::npos)
        << error.message();
  }
}

// In 100 and 200 steps its explicit method would end at once: the mount takes 50 microseconds.
TEST(Scenes, WhatIsStiffHasAReference) {
  const SceneReference reference(assemble(read_scene_file("builtin:top_on_stiff_mount"), "mount"), 0.05);
  EXPECT_LT(reference.error_estimate(), 1e-12);
}

TEST(Scenes, AllAreValidByTheSchemaAndAcceptedUnderTheNameOfTheirFile) {
  ASSERT_EQ(scene_files().size(), 16u);
  for (const auto& file : scene_files()) {
    std::ifstream stream(file);
    const std::string text(std::istreambuf_iterator<char>(stream), {});
    EXPECT_EQ(scene_schema().violations(text), "") << file;
    const SceneDescription scene = read_scene_file(file);
    EXPECT_EQ(scene.name, file.stem()) << file;
    EXPECT_NE(scene.summary, "") << file;
  }
}

// The indented blocks of a page that are JSON objects of their own.
std::vector<std::string> examples_of(const std::filesystem::path& page) {
  std::ifstream stream(page);
  std::vector<std::string> examples;
  bool inside = false;
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with("    ")) {
      inside = false;
      continue;
    }
    if (!inside) examples.emplace_back();
    inside = true;
    examples.back() += line + '\n';
  }
  std::erase_if(examples, [](const std::string& text) { return !text.starts_with("    {"); });
  return examples;
}

TEST(Scenes, OfThePageAreAccepted) {
  const auto examples = examples_of(std::filesystem::path(LIEBENCH_SOURCE_DIR) / "docs" / "scenes.md");
  ASSERT_EQ(examples.size(), 3u);
  for (const std::string& text : examples) {
    EXPECT_EQ(scene_schema().violations(text), "") << text;
    const System system(make_scene_model<double>(read_scene(scene_json(text))));
    EXPECT_LT(largest(system.constraint(0.0, system.initial_configuration())), 1e-15) << text;
  }
}

TEST(Scenes, FitTogetherAndMoveAsTheirJointsAllow) {
  for (const auto& file : scene_files()) {
    const System system(make_scene_model<double>(read_scene_file(file)));
    const auto q = system.initial_configuration();
    EXPECT_LT(largest(system.constraint(0.0, q)), 1e-15) << file;
    // The fastest velocity of a point is that of a governor's ball, 6 m/s.
    EXPECT_LT(largest(system.constraint_rate(0.0, q, system.initial_velocity())), 1e-14) << file;
  }
}

TEST(Scenes, TheChainOfThreeIsTheChainOfAnyLength) {
  const SceneDescription file = scene_of("chain_3");
  const System a(make_scene_model<double>(file)), b(make_scene_model<double>(chain(3)));
  EXPECT_EQ(a.initial_configuration(), b.initial_configuration());
  EXPECT_LT(largest(initial_accelerations(a) - initial_accelerations(b)), 1e-11);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(file.bodies[i].name, chain(3).bodies[i].name);
  EXPECT_EQ(chain(100).joints.size(), 100u);
}

TEST(Scenes, TheTwoWindowsAreTheWindowsOfAnyNumber) {
  const SceneDescription file = scene_of("four_bar"), made = four_bar(2);
  const System a(make_scene_model<double>(file)), b(make_scene_model<double>(made));
  EXPECT_EQ(a.initial_configuration(), b.initial_configuration());
  EXPECT_EQ(a.initial_velocity(), b.initial_velocity());
  EXPECT_LT(largest(initial_accelerations(a) - initial_accelerations(b)), 1e-11);
  ASSERT_EQ(file.joints.size(), made.joints.size());
  for (std::size_t i = 0; i < file.joints.size(); ++i) {
    EXPECT_EQ(file.joints[i].name, made.joints[i].name);
    EXPECT_EQ(file.joints[i].point_a, made.joints[i].point_a);
    EXPECT_EQ(file.joints[i].point_b, made.joints[i].point_b);
  }
}

TEST(Scenes, TheWindowsBeginAsTheirPendulum) {
  for (const int n : {1, 2, 10}) {
    const System system(make_scene_model<double>(four_bar(n)));
    const auto q = system.initial_configuration();
    EXPECT_LT(largest(system.constraint(0.0, q)), 1e-15);
    // Upright: no angular acceleration, kinetic energy ((n + 1) / 3 + n) / 2.
    EXPECT_LT(largest(turning_acceleration(initial_accelerations(system), 0)), 1e-11);
    EXPECT_NEAR(system.energy(q, system.initial_velocity()),
                ((n + 1) / 3.0 + n) / 2.0 + 9.81 * ((n + 1) / 2.0 + n), 1e-11);
  }
}

// 661.34616923... of the closed form, about the tip (docs/references.md).
TEST(Scenes, TheHeavyTopBeginsWithItsKnownAcceleration) {
  const System system(make_scene_model<double>(scene_of("heavy_top")));
  const double J = 15.234375, spin = 150.0, p = -4.61538;
  const double expected = ((0.46875 - J) * spin * p - 15.0 * 9.81 - 0.0) / J;
  const Eigen::Vector3d turning = turning_acceleration(initial_accelerations(system), 0);
  EXPECT_NEAR(turning(0), expected, 1e-9);
  EXPECT_NEAR(turning(0), 661.34616923, 1e-6);
  EXPECT_NEAR(turning(1), 0.0, 1e-9);
}

// Constants of the motion: energy, momentum about the vertical, and Kovalevskaya's.
TEST(Scenes, KovalevskayasTopHasItsConstants) {
  const System system(make_scene_model<double>(scene_of("kovalevskaya_top")));
  const auto q = system.initial_configuration();
  const auto v = system.initial_velocity();
  EXPECT_NEAR(system.energy(q, v), 3.25, 1e-15);
  EXPECT_NEAR(system.angular_momentum(q, v), 2.0, 1e-15);
  const Body<double>& body = system.model().bodies[0];
  EXPECT_EQ(body.inertia_of_motion, Eigen::Matrix3d(Eigen::Vector3d(2, 2, 1).asDiagonal()));
  EXPECT_EQ(std::pow(v(0) * v(0) - v(1) * v(1), 2) + std::pow(2.0 * v(0) * v(1), 2), 1.5625);
}

// Mazzia & Magherini, Test set for IVP solvers: beta'' = 14222.44..., Theta'' = -10666.83... relative to it, all others at rest.
TEST(Scenes, AndrewsSqueezerBeginsWithItsPublishedAccelerations) {
  const System system(make_scene_model<double>(scene_of("andrews_squeezer")));
  const Eigen::VectorXd a = initial_accelerations(system);
  const double beta = 14222.4439199541138705911625887, theta = -10666.8329399655854029433719415;
  // Inertias of 1e-7 to 1e-5 beside directions of length one in the matrix: digits are lost.
  EXPECT_NEAR(turning_acceleration(a, 0)(2), beta, 1e-5);
  EXPECT_NEAR(turning_acceleration(a, 1)(2), beta + theta, 1e-5);
  for (Eigen::Index i = 2; i < 7; ++i) EXPECT_NEAR(turning_acceleration(a, i)(2), 0.0, 1e-5) << i;
}

// Its published data are one motion: what a conrod's ends do is what the crank and the slider do there. With other axes of the
// universal joint than x of the slider and (0, 2, -1) of the conrod these velocities may fit, too, but not the rank: with z and
// (2, -1, 0), in one plane with the conrod, the joint does not hold it at the beginning.
TEST(Scenes, TheSliderCrankHasOneDegreeOfFreedomAndItsPublishedVelocities) {
  const SceneDescription scene = scene_of("slider_crank");
  EXPECT_EQ(scene.bodies[1].angular_velocity, Eigen::Vector3d(1.92, -0.96, 0.48));
  const Eigen::Vector3d along(0.2, -0.1, -0.2);
  EXPECT_LT((scene.bodies[1].inertia * along - 4e-4 * along).norm(), 1e-18);
  const System system(make_scene_model<double>(scene));
  Eigen::MatrixXd B(system.multipliers(), 18);
  for (Eigen::Index i = 0; i < 18; ++i)
    B.col(i) = system.constraint_product(system.initial_configuration(), Eigen::VectorXd::Unit(18, i));
  EXPECT_EQ(B.colPivHouseholderQr().rank(), 17);
}

TEST(Scenes, TheSpringsOfTheGovernorAreSlackAtTheBeginning) {
  const SceneDescription scene = scene_of("flyball_governor");
  const auto& springs = std::get<std::vector<Placed<SpringDamper<double>>>>(scene.effects);
  ASSERT_EQ(springs.size(), 2u);
  const System system(make_scene_model<double>(scene));
  const Eigen::VectorXd a = initial_accelerations(system);
  // Then the slider falls freely.
  EXPECT_NEAR(a(6 + 2), -9.81, 1e-7);
}

TEST(Scenes, ASatelliteOfPointMassWouldKeepItsCircle) {
  const SceneDescription scene = scene_of("satellite");
  const BodyDescription& body = scene.bodies[0];
  EXPECT_NEAR(body.velocity.squaredNorm() * body.position.norm(), 3.986004418e14, 1.0);
}

TEST(Scenes, TheTippeTopTouchesThePlane) {
  const SceneDescription scene = scene_of("tippe_top");
  const auto& contacts = std::get<std::vector<Placed<Contact<double>>>>(scene.effects);
  ASSERT_EQ(contacts.size(), 2u);
  const Contact<double>& ball = contacts[0].effect;
  EXPECT_NEAR(scene.bodies[0].position(2) + ball.point(2), ball.radius, 1e-15);
}

}  // namespace
}  // namespace liebench
