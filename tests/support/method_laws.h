#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "groups/extended.h"
#include "groups/so3.h"
#include "problems/heavy_top.h"
#include "tests/support/heavy_top_motion.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/method_cases.h"

// Laws of every integrator in every combination of its options on a formulation of the heavy top. A formulation joins with
//
//   #include "tests/support/method_laws.h"
//   using Formulations = ::testing::Types<HeavyTopSE3<double>>;
//   INSTANTIATE_TYPED_TEST_SUITE_P(SE3, MethodLaws, Formulations);
//
// in a file of its own (its steppers take a minute to compile), inside namespace liebench; a method by its line in
// integrators/list.h. The formulation gives its state for a rigid motion: configuration(R), velocity(R, omega),
// acceleration(R, omega, omega_dot), multipliers(R, omega, omega_dot).
//
// Step sizes: an explicit L_6 is stable in the index-3 form for h |v| < 0.110 only (integrators/lie_correction.h), and so all
// methods run with less.

namespace liebench {

// The point of the rigid motion (R, omega, omega') in the formulation S, rounded from extended precision.
template <MechanicalSystem S>
SolutionPoint<S> rigid_motion_point(const HeavyTopParameters& p, double t,
                                    const Eigen::Matrix<Extended, 3, 3>& R,
                                    const Eigen::Matrix<Extended, 3, 1>& omega,
                                    const Eigen::Matrix<Extended, 3, 1>& omega_dot) {
  using E = typename S::template rebind<Extended>;
  const E system(p);
  const auto rounded = [](const auto& v) { return v.template cast<double>().eval(); };
  return {t, E::Group::template cast<double>(system.configuration(R)), rounded(system.velocity(R, omega)),
          rounded(system.acceleration(R, omega, omega_dot)),
          rounded(system.multipliers(R, omega, omega_dot))};
}

// A top that hangs and spins about its own axis, which is a principal one: v and lambda are constant, q = q_0 exp(t v).
inline HeavyTopParameters hanging_top(double spin) {
  HeavyTopParameters p;
  p.mass = 2;
  p.inertia = {{{0.5, 0, 0}, {0, 0.7, 0}, {0, 0, 0.4}}};
  p.center_of_mass = {0, 0, -0.5};
  p.angular_velocity = {0, 0, spin};
  p.orientation = {0.8, 0, 0, 0.6};
  return p;
}

template <MechanicalSystem S>
std::vector<SolutionPoint<S>> hanging_top_points(const HeavyTopParameters& p, double h, int count) {
  const HeavyTopData<Extended> data(p);
  std::vector<SolutionPoint<S>> points;
  for (int j = 0; j < count; ++j) {
    const Extended t = Extended(h) * double(j);
    points.push_back(
        rigid_motion_point<S>(p, to_double(t), data.R0 * SO3<Extended>::exp((data.omega0 * t).eval()),
                              data.omega0, Eigen::Matrix<Extended, 3, 1>::Constant(Extended(0.0))));
  }
  return points;
}

// What a stepper shows, bit for bit.
template <MechanicalSystem S>
std::vector<double> state_of(const AnyStepper<S>& stepper) {
  std::vector<double> state{to_double(stepper.time())};
  const auto append = [&](const auto& v) {
    for (Eigen::Index i = 0; i < v.size(); ++i) state.push_back(to_double(v(i)));
  };
  append(S::Group::stacked(stepper.configuration()));
  append(stepper.velocity());
  append(stepper.multipliers());
  return state;
}

template <class S>
class MethodLaws : public ::testing::Test {
 public:
  static constexpr double eps = std::numeric_limits<double>::epsilon();

  // The first `count` points of `motion`.
  static std::vector<SolutionPoint<S>> points(const S& system, const HeavyTopMotion& motion, double h,
                                              int count) {
    std::vector<SolutionPoint<S>> all;
    for (int j = 0; j < count; ++j) all.push_back(motion.point(system, Extended(h) * double(j)));
    return all;
  }

  // Round-off of `steps` steps: increments are known to eps |q| / h where a constraint or a logarithm gives them, the
  // velocity to some of those (the coefficients of a method add up to less than 14 for six steps), lambda to what
  // M v' = M v / h makes of it.
  struct RoundOff {
    double q, v, lambda;
    RoundOff(double speed, double mass, double h, int steps)
        : q(0), v(64 * eps * (speed + 1 / h) * std::sqrt(double(steps))), lambda(0) {
      q = steps * (h * v + 16 * eps);
      lambda = 8 * (1 + mass) * v / h;
    }
  };
};
TYPED_TEST_SUITE_P(MethodLaws);

TYPED_TEST_P(MethodLaws, ConstantVelocityGivesTheExponentialExactly) {
  using S = TypeParam;
  const HeavyTopParameters p = hanging_top(3);
  const S system(p);
  constexpr double h = 1.0 / 64;  // h |v| = 0.047
  constexpr int steps = 96;
  const auto exact = hanging_top_points<S>(p, h, steps + 1);
  const typename TestFixture::RoundOff tolerance(3, p.mass, h, steps);
  for (const MethodCase<S>& method : every_method<S>()) {
    const auto stepper = method.stepper(system);
    const auto count = std::size_t(stepper->starting_points());
    ASSERT_EQ(stepper->start(h, std::span(exact).first(count)).outcome, Outcome::ok) << method.text();
    for (int n = stepper->steps(); n <= steps; ++n) {
      ASSERT_EQ(stepper->step().outcome, Outcome::ok) << method.text() << ", step " << n;
      const SolutionPoint<S>& point = exact[std::size_t(n)];
      ASSERT_LE(S::Group::separation(point.q, stepper->configuration()).norm(), tolerance.q)
          << method.text() << ", step " << n;
      ASSERT_LE((stepper->velocity() - point.v).norm(), tolerance.v) << method.text() << ", step " << n;
      ASSERT_LE((stepper->multipliers() - point.lambda).norm(), tolerance.lambda)
          << method.text() << ", step " << n;
    }
  }
}

// The same top in a frame that is turned: attitude and gravity by the rotation with quaternion g.
inline HeavyTopParameters turned(HeavyTopParameters p, const Eigen::Quaterniond& g) {
  const Eigen::Quaterniond q(p.orientation[0], p.orientation[1], p.orientation[2], p.orientation[3]);
  const Eigen::Quaterniond product = g * q.normalized();
  p.orientation = {product.w(), product.x(), product.y(), product.z()};
  const Eigen::Vector3d gravity = g * Eigen::Vector3d(p.gravity[0], p.gravity[1], p.gravity[2]);
  p.gravity = {gravity(0), gravity(1), gravity(2)};
  return p;
}

// Turned motions have turned errors: their norms, and lambda, which all formulations have in a frame that turns with the
// body or by a rotation of it, are the same.
template <MechanicalSystem S>
std::vector<std::array<double, 3>> errors_of_steps(AnyStepper<S>& stepper,
                                                   std::span<const SolutionPoint<S>> exact, double h,
                                                   const std::string& text) {
  std::vector<std::array<double, 3>> errors;
  EXPECT_EQ(stepper.start(h, exact.first(std::size_t(stepper.starting_points()))).outcome, Outcome::ok)
      << text;
  for (std::size_t n = std::size_t(stepper.steps()); n < exact.size(); ++n) {
    EXPECT_EQ(stepper.step().outcome, Outcome::ok) << text << ", step " << n;
    errors.push_back({S::Group::separation(exact[n].q, stepper.configuration()).norm(),
                      (stepper.velocity() - exact[n].v).norm(),
                      (stepper.multipliers() - exact[n].lambda).norm()});
  }
  return errors;
}

TYPED_TEST_P(MethodLaws, TurningTheInertialFrameTurnsTheSolution) {
  using S = TypeParam;
  const HeavyTopParameters p = unsymmetric_top(1);
  constexpr double h = 1.0 / 128;
  constexpr int steps = 48;
  const Eigen::Vector3d vertical = Eigen::Vector3d(p.gravity[0], p.gravity[1], p.gravity[2]).normalized();
  const Eigen::Quaterniond about_the_vertical(Eigen::AngleAxisd(1.1, vertical));
  const Eigen::Quaterniond about_any_axis = Eigen::Quaterniond(0.3, -0.7, 0.2, 0.6).normalized();
  const S system(p);
  const auto exact = TestFixture::points(system, HeavyTopMotion(p, 0.5), h, steps + 1);
  const double speed = exact[0].v.norm();
  ASSERT_LT(h * speed, 0.1);
  const typename TestFixture::RoundOff tolerance(speed, p.mass, h, steps);
  for (const Eigen::Quaterniond& g : {about_the_vertical, about_any_axis}) {
    const HeavyTopParameters other = turned(p, g);
    const S other_system(other);
    const auto other_exact = TestFixture::points(other_system, HeavyTopMotion(other, 0.5), h, steps + 1);
    for (const MethodCase<S>& method : every_method<S>()) {
      const std::string text = method.text();
      const auto stepper = method.stepper(system), other_stepper = method.stepper(other_system);
      const auto errors = errors_of_steps<S>(*stepper, exact, h, text);
      const auto other_errors = errors_of_steps<S>(*other_stepper, other_exact, h, text);
      ASSERT_EQ(errors.size(), other_errors.size());
      for (std::size_t n = 0; n < errors.size(); ++n) {
        ASSERT_NEAR(errors[n][0], other_errors[n][0], tolerance.q) << text << ", step " << n;
        ASSERT_NEAR(errors[n][1], other_errors[n][1], tolerance.v) << text << ", step " << n;
        ASSERT_NEAR(errors[n][2], other_errors[n][2], tolerance.lambda) << text << ", step " << n;
      }
    }
  }
}

TYPED_TEST_P(MethodLaws, TheSameBitsTwiceAndWithAnAudit) {
  using S = TypeParam;
  const HeavyTopParameters p = unsymmetric_top(1);
  const S system(p);
  constexpr double h = 1.0 / 128;
  constexpr int steps = 60;
  const auto exact = TestFixture::points(system, HeavyTopMotion(p, 0.2), h, 8);
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
  const auto methods = every_method<S>();
  const auto counting = every_method<C>();
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

TYPED_TEST_P(MethodLaws, AStepThatTurnsByPiOrMoreIsRotationTooLarge) {
  using S = TypeParam;
  // 4.5 rad a step.
  const HeavyTopParameters p = hanging_top(45);
  const S system(p);
  constexpr double h = 0.1;
  const auto exact = hanging_top_points<S>(p, h, 8);
  for (const MethodCase<S>& method : every_method<S>()) {
    const auto stepper = method.stepper(system);
    Outcome outcome =
        stepper->start(h, std::span(exact).first(std::size_t(stepper->starting_points()))).outcome;
    if (outcome == Outcome::ok) {
      const auto before = state_of(*stepper);
      outcome = stepper->step().outcome;
      // A step that failed is not taken.
      EXPECT_EQ(state_of(*stepper), before) << method.text();
    }
    EXPECT_EQ(name(outcome), name(Outcome::rotation_too_large)) << method.text();
  }
}

TYPED_TEST_P(MethodLaws, ForcesThatAreNoNumbersAreNonFinite) {
  using S = TypeParam;
  const HeavyTopParameters p = slow_top();
  constexpr double h = 1.0 / 128;
  const auto exact = TestFixture::points(S(p), HeavyTopMotion(p, 0.2), h, 8);
  for (const double broken :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    HeavyTopParameters no_number = p;
    no_number.gravity[1] = broken;
    const S system(no_number);
    for (const MethodCase<S>& method : every_method<S>()) {
      const auto stepper = method.stepper(system);
      Outcome outcome =
          stepper->start(h, std::span(exact).first(std::size_t(stepper->starting_points()))).outcome;
      if (outcome == Outcome::ok) {
        const double before = stepper->time();
        outcome = stepper->step().outcome;
        EXPECT_EQ(stepper->time(), before) << method.text();
      }
      EXPECT_EQ(name(outcome), name(Outcome::non_finite)) << method.text();
    }
  }
}

REGISTER_TYPED_TEST_SUITE_P(MethodLaws, ConstantVelocityGivesTheExponentialExactly,
                            TurningTheInertialFrameTurnsTheSolution, TheSameBitsTwiceAndWithAnAudit,
                            AStepThatTurnsByPiOrMoreIsRotationTooLarge, ForcesThatAreNoNumbersAreNonFinite);

}  // namespace liebench
