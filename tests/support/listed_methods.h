#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "groups/counted.h"
#include "integrators/basic_stepper.h"
#include "tests/support/method_laws.h"

// The laws of tests/support/method_laws.h for every listed method with every combination of its options. A formulation of the heavy
// top joins with
//
//   #include "tests/support/listed_methods.h"
//   using Formulations = ::testing::Types<HeavyTopSE3<double>>;
//   INSTANTIATE_TYPED_TEST_SUITE_P(SE3, ListedMethods, Formulations);
//
// in a file of its own (its steppers take a minute to compile); a method by its line in integrators/list.h.

namespace liebench {

template <MechanicalSystem S>
using LawOfMethods = void(const MethodCase<S>&, std::vector<BrokenLaw>&);

template <MechanicalSystem S>
void expect_of_every_method(LawOfMethods<S>* law) {
  for (const MethodCase<S>& method : every_method<S>()) {
    std::vector<BrokenLaw> broken;
    law(method, broken);
    for (const BrokenLaw& each : broken) ADD_FAILURE() << text(method.text(), each);
  }
}

template <class S>
class ListedMethods : public ::testing::Test {};
TYPED_TEST_SUITE_P(ListedMethods);

TYPED_TEST_P(ListedMethods, FollowAConstantVelocityExactly) {
  expect_of_every_method<TypeParam>(&MethodLaws<TypeParam>::constant_velocity);
}
TYPED_TEST_P(ListedMethods, TurnTheirSolutionWithTheInertialFrame) {
  expect_of_every_method<TypeParam>(&MethodLaws<TypeParam>::inertial_frame);
}
TYPED_TEST_P(ListedMethods, ComeBackInReversedTimeWhereTheyAreSymmetric) {
  expect_of_every_method<TypeParam>(&MethodLaws<TypeParam>::time_reversal);
}
TYPED_TEST_P(ListedMethods, CallAStepThatTurnsByPiOrMoreRotationTooLarge) {
  expect_of_every_method<TypeParam>(&MethodLaws<TypeParam>::large_rotation);
}
TYPED_TEST_P(ListedMethods, CallForcesThatAreNoNumbersNonFinite) {
  expect_of_every_method<TypeParam>(&MethodLaws<TypeParam>::no_number);
}
REGISTER_TYPED_TEST_SUITE_P(ListedMethods, FollowAConstantVelocityExactly,
                            TurnTheirSolutionWithTheInertialFrame,
                            ComeBackInReversedTimeWhereTheyAreSymmetric,
                            CallAStepThatTurnsByPiOrMoreRotationTooLarge,
                            CallForcesThatAreNoNumbersNonFinite);

template <class S>
class ListedMethodsInExtendedPrecision : public ::testing::Test {};
TYPED_TEST_SUITE_P(ListedMethodsInExtendedPrecision);

TYPED_TEST_P(ListedMethodsInExtendedPrecision, HaveTheOrdersThatTheyDeclare) {
  expect_of_every_method<TypeParam>(&MethodLaws<TypeParam>::order);
}
REGISTER_TYPED_TEST_SUITE_P(ListedMethodsInExtendedPrecision, HaveTheOrdersThatTheyDeclare);

template <class S>
class ListedMethodsWithConstraints : public ::testing::Test {};
TYPED_TEST_SUITE_P(ListedMethodsWithConstraints);

TYPED_TEST_P(ListedMethodsWithConstraints, KeepTheConstraintsThatTheyDeclare) {
  expect_of_every_method<TypeParam>(&MethodLaws<TypeParam>::constraints);
}
REGISTER_TYPED_TEST_SUITE_P(ListedMethodsWithConstraints, KeepTheConstraintsThatTheyDeclare);

template <class S>
class ListedMethodsInDouble : public ::testing::Test {};
TYPED_TEST_SUITE_P(ListedMethodsInDouble);

TYPED_TEST_P(ListedMethodsInDouble, TheSameBitsTwiceAndWithAnAudit) {
  using S = TypeParam;
  const HeavyTopParameters p = unsymmetric_top(1);
  const S system(p);
  constexpr double h = 1.0 / 128;
  constexpr int steps = 60;
  const HeavyTopMotion motion(p, 0.2);
  std::vector<SolutionPoint<S>> exact;
  for (int j = 0; j < most_starting_points; ++j)
    exact.push_back(motion.point(system, Extended(h) * double(j)));
  using C = Audited<typename S::template rebind<Counted>>;
  const C counted(p);
  std::vector<SolutionPoint<C>> counted_points;
  for (const SolutionPoint<S>& point : exact)
    counted_points.push_back({point.t, S::Group::template cast<Counted>(point.q),
                              point.v.template cast<Counted>(), point.acceleration.template cast<Counted>(),
                              point.lambda.template cast<Counted>()});
  const auto first = [](const auto& points, const auto& stepper) {
    return std::span(points).first(std::size_t(stepper.starting_points()));
  };
  const auto methods = every_method_of_fixed_steps<S>();
  const auto counting = every_method_of_fixed_steps<C>();
  ASSERT_EQ(methods.size(), counting.size());
  for (std::size_t i = 0; i < methods.size(); ++i) {
    const std::array steppers{methods[i].stepper(system), methods[i].stepper(system)};
    for (const auto& stepper : steppers)
      ASSERT_EQ(stepper->start(h, first(exact, *stepper)).outcome, Outcome::ok) << methods[i].text();
    const auto audited = counting[i].stepper(counted);
    ASSERT_EQ(audited->start(h, first(counted_points, *audited)).outcome, Outcome::ok) << methods[i].text();
    const KernelAudit start = audited->audit();
    EXPECT_EQ(start.factorizations, start.factorizations_start) << methods[i].text();
    for (int n = 1; n <= steps; ++n) {
      for (const auto& stepper : steppers)
        ASSERT_EQ(stepper->step().outcome, Outcome::ok) << methods[i].text() << ", step " << n;
      ASSERT_EQ(audited->step().outcome, Outcome::ok) << methods[i].text() << ", step " << n;
      const auto state = state_of(*steppers[0]);
      ASSERT_EQ(state, state_of(*steppers[1])) << methods[i].text() << ", step " << n;
      ASSERT_EQ(state, state_of(*audited)) << methods[i].text() << ", step " << n;
    }
    const KernelAudit audit = audited->audit();
    EXPECT_EQ(audit.factorizations_start, start.factorizations_start) << methods[i].text();
    EXPECT_GE(audit.solves - start.solves, std::uint64_t(steps)) << methods[i].text();
    if (audit.iterations == 0) continue;  // an explicit method
    // Every iteration is a back-substitution; methods that have momenta, or project, solve for velocities in every
    // step, too.
    const std::uint64_t others = audit.solves - start.solves - audit.iterations;
    EXPECT_EQ(others % std::uint64_t(steps), 0u) << methods[i].text();
    EXPECT_LE(others, std::uint64_t(2 * steps)) << methods[i].text();
    EXPECT_GE(audit.iterations, std::uint64_t(steps)) << methods[i].text();
    EXPECT_GE(audit.factorizations, start.factorizations + 1) << methods[i].text();
  }
}

REGISTER_TYPED_TEST_SUITE_P(ListedMethodsInDouble, TheSameBitsTwiceAndWithAnAudit);

}  // namespace liebench
