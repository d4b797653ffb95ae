#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "harness/instances/run_time_scenes.h"
#include "harness/instances/scene_steppers.h"
#include "integrators/half_explicit.h"
#include "problems/audited_system.h"
#include "problems/heavy_top.h"
#include "problems/scene_examples.h"
#include "tests/support/sample_scenes.h"
#include "tests/support/steppers.h"

// Half-explicit methods on scenes: constraints that move, chains, the storage of a scene.

namespace liebench::half_explicit_scenes_test {
namespace {

using Options = HalfExplicit::Options;
using Tableau = HalfExplicit::Tableau;
constexpr std::array all_tableaus{Tableau::herk3, Tableau::herk4, Tableau::hedop5};
constexpr double eps = 2.3e-16;

std::vector<Options> all_options() {
  std::vector<Options> all;
  for (const Tableau tableau : all_tableaus)
    for (const bool projection : {false, true}) all.push_back({tableau, projection});
  return all;
}

std::string text(const Options& options) {
  return std::to_string(int(options.tableau)) + (options.projection ? " projected" : "");
}

template <MechanicalSystem S>
std::unique_ptr<AnyStepper<S>> started(const Options& options, const S& system, double h) {
  using T = typename S::Scalar;
  auto stepper = make_stepper<HalfExplicit, S>(options, system);
  std::array<SolutionPoint<S>, 1> points;
  EXPECT_EQ(stepper->start_itself(T(h), points).outcome, Outcome::ok);
  return stepper;
}

// Two links in a row: the first turns about a fixed axis by a prescribed angle, the second hangs on it.
SceneDescription driven_links() {
  SceneDescription scene;
  for (int i = 0; i < 2; ++i) {
    BodyDescription link;
    link.name = i == 0 ? "crank" : "rod";
    link.kind = i == 0 ? BodyKind::r3xso3 : BodyKind::se3;
    link.mass = 1.5 + i;
    link.inertia = Eigen::Vector3d(0.02, 0.3, 0.25).asDiagonal();
    link.position = {0.5 + i, 0.0, 0.0};
    // The crank turns by 0.7 rad/s at t = 0, and the rod with it.
    link.velocity = {0.0, 0.7 * (0.5 + i), 0.0};
    link.angular_velocity = {0.0, 0.0, 0.7};
    scene.bodies.push_back(link);
    JointDescription joint;
    joint.name = i == 0 ? "drive" : "joint";
    joint.kind = i == 0 ? JointKind::revolute : JointKind::spherical;
    joint.a = i - 1;
    joint.b = i;
    joint.point_a = {i == 0 ? 0.0 : 0.5, 0.0, 0.0};
    joint.point_b = {-0.5, 0.0, 0.0};
    if (i == 0) joint.motion = PrescribedMotion<double>{{0.0, 0.5}, {{0.1, 2.0, 0.0}}};
    scene.joints.push_back(joint);
    std::get<std::vector<Placed<UniformGravity<double>>>>(scene.effects)
        .push_back({UniformGravity<double>{link.mass, {0.0, 0.4, -9.81}}, i, -1});
  }
  return scene;
}

TEST(HalfExplicitOnScenes, KeepsConstraintsThatMove) {
  const Scene system(make_scene_model<double>(driven_links()));
  for (const Options& options : all_options()) {
    const auto stepper = started(options, system, 1.0 / 256);
    double phi = 0.0;
    for (int n = 0; n < 128; ++n) {
      ASSERT_EQ(stepper->step().outcome, Outcome::ok) << text(options) << ", step " << n;
      const auto& q = stepper->configuration();
      const auto& v = stepper->velocity();
      ASSERT_LE(system.constraint_rate(stepper->time(), q, v).norm(), 64 * eps * (1 + v.norm()))
          << text(options) << ", step " << n;
      phi = std::max(phi, system.constraint(stepper->time(), q).norm());
    }
    EXPECT_LE(phi, options.projection ? 16 * eps : 1e-5) << text(options);
  }
}

TEST(HalfExplicitOnScenes, StorageAndCountingChangeNoBit) {
  const SceneDescription scene = driven_links();
  const auto model = make_scene_model<double>(scene);
  for (const Options& options : all_options()) {
    const auto small = started(options, SmallScene(model), 0.01);
    const auto large = started(options, Scene(model), 0.01);
    const auto counted = started(options, run_time_scene<Counted>(scene), 0.01);
    for (int n = 0; n < 30; ++n) {
      ASSERT_EQ(small->step().outcome, Outcome::ok);
      ASSERT_EQ(large->step().outcome, Outcome::ok);
      ASSERT_EQ(counted->step().outcome, Outcome::ok);
      ASSERT_EQ(small->configuration(), large->configuration()) << text(options);
      ASSERT_EQ(small->multipliers(), large->multipliers()) << text(options);
      ASSERT_EQ(small->configuration(), counted->configuration().cast<double>()) << text(options);
      ASSERT_EQ(small->velocity(), counted->velocity().cast<double>()) << text(options);
      ASSERT_EQ(small->multipliers(), counted->multipliers().cast<double>()) << text(options);
    }
  }
}

// In extended precision: another matrix, the same method. Where positions drift the constraints of both are not the
// same, and so neither are their forces: on the subgroup they do not.
TEST(HalfExplicitOnScenes, OneTopOnASphericalJointIsTheHeavyTop) {
  HeavyTopParameters p;
  p.angular_velocity = {0.0, 15.0, -0.461538};
  using S = HeavyTopSE3<Extended>;
  const S top(p);
  const auto scene = run_time_scene<Extended>(heavy_top_scene(BodyKind::se3, p));
  constexpr double h = 0x1p-9;
  for (const Tableau tableau : {Tableau::herk4, Tableau::hedop5}) {
    const auto expected = started({tableau}, top, h);
    const auto actual = started({tableau}, scene, h);
    ASSERT_EQ(expected->advance(40).outcome, Outcome::ok);
    ASSERT_EQ(actual->advance(40).outcome, Outcome::ok);
    const Eigen::Matrix<Extended, Eigen::Dynamic, 1> q = S::Group::stacked(expected->configuration());
    // Round-off of 5e-32 |v| / h in v' and so in 40 v.
    EXPECT_LE(to_double((actual->configuration() - q).norm()), 1e-28) << int(tableau);
    EXPECT_LE(to_double((actual->velocity() - expected->velocity()).norm()), 1e-26) << int(tableau);
    // The force at the tip, in the inertial frame and in that of the body.
    EXPECT_NEAR(to_double(actual->multipliers().norm()), to_double(expected->multipliers().norm()), 1e-13);
  }
}

TEST(HalfExplicitOnScenes, AChainOfManyLinksIsSolvedBySparseMatrices) {
  const Scene system(make_scene_model<double>(chain(20)));
  for (const Options& options : all_options()) {
    const auto stepper = started(options, system, 1e-3);
    ASSERT_EQ(stepper->advance(20).outcome, Outcome::ok) << text(options);
    const auto& q = stepper->configuration();
    const auto& v = stepper->velocity();
    EXPECT_LE(system.constraint_rate(0.0, q, v).norm(), 1e3 * eps * (1 + v.norm())) << text(options);
    const double energy =
        system.energy(q, v) - system.energy(system.initial_configuration(), system.initial_velocity());
    EXPECT_LE(std::abs(energy), 1e-6) << text(options);
  }
}

}  // namespace
}  // namespace liebench::half_explicit_scenes_test
