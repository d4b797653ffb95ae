#include <gtest/gtest.h>
#include <malloc.h>

#include <Eigen/Core>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "groups/flattened.h"
#include "harness/instances/heavy_top_steppers.h"
#include "harness/instances/run_time_scenes.h"
#include "harness/instances/scene_steppers.h"
#include "problems/heavy_top.h"
#include "problems/scene_examples.h"
#include "tests/support/sample_scenes.h"

namespace liebench::scene_stepper_test {
namespace {

// One of each kind of closure and Newton matrix.
std::vector<MethodOptions> some_methods() {
  std::vector<MethodOptions> methods;
  for (const Form form : {Form::index3, Form::stabilized_index2}) {
    const bool modified = form == Form::index3;
    methods.emplace_back(BLieDF2nd::Options{.k = 3, .modified_start = modified, .form = form});
    methods.emplace_back(BLieDF2nd::Options{
        .k = 5, .correction = Correction::implicit_term, .modified_start = modified, .form = form});
    methods.emplace_back(GeneralizedAlpha::Options{.modified_start = modified, .form = form});
    methods.emplace_back(FaltinsenBdf::Options{.k = 3, .modified_start = modified, .form = form});
    methods.emplace_back(FaltinsenBdf::Options{
        .k = 4, .variant = FaltinsenBdf::Variant::bch, .modified_start = modified, .form = form});
    methods.emplace_back(CentredBdf::Options{.k = 4, .modified_start = modified, .form = form});
  }
  methods.emplace_back(Rattlie::Options{});
  methods.emplace_back(Shakelie::Options{});
  return methods;
}

template <class S>
std::unique_ptr<AnyStepper<S>> after(const MethodOptions& options, const S& system, double h, int steps) {
  using T = typename S::Scalar;
  auto stepper = any_stepper(options, system);
  std::vector<SolutionPoint<S>> points(std::size_t(stepper->starting_points()));
  EXPECT_EQ(stepper->start_itself(T(h), points).outcome, Outcome::ok);
  EXPECT_EQ(stepper->advance(std::uint64_t(steps)).outcome, Outcome::ok);
  return stepper;
}

// In extended precision, 40 steps of the slow top from the same points: round-off of 1e-32 grows by 1 / h^2 in the index-3 form.
// (Their own starts differ by the error of the starting method, for off the constraint the constraint forces of both are not
// the same; so does that of generalized-alpha from given points.)
template <template <class> class System>
void expect_heavy_top(BodyKind kind) {
  HeavyTopParameters p;
  p.angular_velocity = {0.0, 15.0, -0.461538};
  const Audited<System<Extended>> top{System<Extended>(p)};
  using Top = std::remove_cvref_t<decltype(top)>;
  const auto scene = run_time_scene<Extended>(heavy_top_scene(kind, p));
  const Extended h(0x1p-9);
  int number = 0;
  for (const MethodOptions& options : some_methods()) {
    ++number;
    if (options.of<GeneralizedAlpha>() != nullptr) continue;
    const auto expected = any_stepper(options, top);
    const auto actual = any_stepper(options, scene);
    std::vector<SolutionPoint<Top>> points(std::size_t(expected->starting_points()));
    ASSERT_EQ(expected->start_itself(h, points).outcome, Outcome::ok);
    std::vector<SolutionPoint<RunTimeSystem<Extended>>> same;
    for (const auto& point : points)
      same.push_back({point.t, System<Extended>::Group::stacked(point.q), point.v, point.acceleration,
                      zero_multipliers(scene)});
    ASSERT_EQ(actual->start(h, same).outcome, Outcome::ok);
    ASSERT_EQ(expected->advance(40).outcome, Outcome::ok);
    ASSERT_EQ(actual->advance(40).outcome, Outcome::ok);
    const auto q = System<Extended>::Group::stacked(expected->configuration());
    EXPECT_LE(to_double((actual->configuration() - q).norm()), 1e-24) << int(kind) << ' ' << number;
    EXPECT_LE(to_double((actual->velocity() - expected->velocity()).norm()), 1e-22)
        << int(kind) << ' ' << number;
    // The force at the tip, in the inertial frame and in that of the body.
    EXPECT_NEAR(to_double(actual->multipliers().norm()), to_double(expected->multipliers().norm()), 1e-14);
  }
}

TEST(SceneStepper, OneTopOnASphericalJointIsTheHeavyTop) {
  expect_heavy_top<HeavyTopR3xSO3>(BodyKind::r3xso3);
  expect_heavy_top<HeavyTopR3xS3>(BodyKind::r3xs3);
  expect_heavy_top<HeavyTopSE3>(BodyKind::se3);
  expect_heavy_top<HeavyTopUDQ>(BodyKind::udq);
}

// Two rods on a spherical and a revolute joint, with a spring: every method in double, without and with the heap, and counted.
SceneDescription two_rods() {
  SceneDescription scene = two_bodies(BodyKind::r3xso3, BodyKind::se3);
  const std::array<Eigen::Vector3d, 2> places{Eigen::Vector3d(0.5, 0.0, 0.0), Eigen::Vector3d(1.5, 0.0, 0.0)};
  for (std::size_t i = 0; i < 2; ++i) {
    scene.bodies[i].position = places[i];
    scene.bodies[i].orientation = {1.0, 0.0, 0.0, 0.0};
    scene.bodies[i].velocity.setZero();
    scene.bodies[i].angular_velocity.setZero();
  }
  JointDescription pin, hinge;
  pin.name = "pin";
  pin.b = 0;
  pin.point_b = {-0.5, 0.0, 0.0};
  hinge.name = "hinge";
  hinge.kind = JointKind::revolute;
  hinge.a = 0;
  hinge.b = 1;
  hinge.point_a = {0.5, 0.0, 0.0};
  hinge.point_b = {-0.5, 0.0, 0.0};
  hinge.axis_a = hinge.axis_b = {0.0, 1.0, 0.0};
  hinge.across_a = hinge.across_b = {1.0, 0.0, 0.0};
  scene.joints = {pin, hinge};
  for (int i = 0; i < 2; ++i)
    std::get<std::vector<Placed<UniformGravity<double>>>>(scene.effects)
        .push_back({UniformGravity<double>{1.0, {0.3, 0.0, -9.81}}, i, -1});
  return scene;
}

template <class A, class B>
void expect_same_bits(const A& a, const B& b, const std::string& text) {
  ASSERT_EQ(a.size(), b.size());
  for (Eigen::Index i = 0; i < a.size(); ++i) EXPECT_EQ(to_double(a(i)), to_double(b(i))) << text << ' ' << i;
}

TEST(SceneStepper, StorageAndCountingChangeNoBit) {
  const SceneDescription scene = two_rods();
  const auto model = make_scene_model<double>(scene);
  auto methods = some_methods();
  // In a hundredth of a second, in steps of their own.
  for (const Form form : {Form::index3, Form::stabilized_index2})
    methods.emplace_back(BLieDF2ndVariable::Options{.tolerance = 1e-6, .form = form});
  int number = 0;
  for (const MethodOptions& options : methods) {
    const auto small = after(options, SmallScene(model), 0.01, 30);
    const auto large = after(options, Scene(model), 0.01, 30);
    const auto counted = after(options, run_time_scene<Counted>(scene), 0.01, 30);
    const std::string text = std::to_string(++number);
    expect_same_bits(small->configuration(), large->configuration(), text);
    expect_same_bits(small->configuration(), counted->configuration(), text + " counted");
    expect_same_bits(small->multipliers(), counted->multipliers(), text + " counted");
  }
}

TEST(SceneStepper, EnergyOfTheDoublePendulumIsKeptToTheOrderOfTheMethod) {
  const Scene system(make_scene_model<double>(two_rods()));
  const double before = system.energy(system.initial_configuration(), system.initial_velocity());
  std::vector<double> drifts;
  for (const double h : {0.002, 0.001}) {
    const auto stepper = after(BLieDF2nd::Options{.k = 4, .form = Form::stabilized_index2}, system, h,
                               int(std::lround(0.5 / h)));
    drifts.push_back(std::abs(system.energy(stepper->configuration(), stepper->velocity()) - before));
    EXPECT_LE(system.constraint(0.0, stepper->configuration()).norm(), 1e-14);
  }
  // Order 4, or better where the leading term is small.
  EXPECT_LE(drifts[1], drifts[0] / 12.0);
  EXPECT_LE(drifts[1], 1e-6);
}

// Floating point operations of a step: those of ten bodies ten times, of a hundred a hundred times, but for iterations more.
TEST(SceneStepper, AChainCostsInProportionToItsBodies) {
  if (detail::sanitized) GTEST_SKIP() << "too long under sanitizers";
  const auto flops = [](int bodies) {
    constexpr int steps = 20;
    const auto stepper =
        after(BLieDF2nd::Options{.k = 3}, run_time_scene<Counted>(chain(bodies)), 1e-3, steps);
    const Operations before = Counted::operations();
    EXPECT_EQ(stepper->advance(steps).outcome, Outcome::ok);
    return double((Counted::operations() - before).total());
  };
  EXPECT_LE(std::log10(flops(1000) / flops(10)) / 2.0, 1.1);
}

TEST(SceneStepper, AChainTakesLessThan20kBABody) {
  if (detail::sanitized) GTEST_SKIP() << "the sanitizer's allocator does not say what is in use";
  const auto in_use = [] {
    const struct mallinfo2 info = mallinfo2();
    return double(info.uordblks + info.hblkhd);
  };
  constexpr int bodies = 1000;
  const SceneDescription description = chain(bodies);
  const double before = in_use();
  const auto stepper =
      after(BLieDF2nd::Options{.k = 3}, Scene(make_scene_model<double>(description)), 1e-3, 2);
  EXPECT_LE(in_use() - before, 20e3 * bodies);
}

}  // namespace
}  // namespace liebench::scene_stepper_test
