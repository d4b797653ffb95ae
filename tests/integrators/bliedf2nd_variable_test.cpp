#include "integrators/bliedf2nd_variable.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/hanging_top.h"
#include "tests/support/heavy_top_motion.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/small_systems.h"
#include "tests/support/spinning_up.h"
#include "tests/support/steppers.h"

namespace liebench::bliedf2nd_variable_test {
namespace {

using Method = BLieDF2ndVariable;

// Every step of a run is held against the equations of the method, written down anew from positions and velocities:
// BDF by the derivatives of Lagrange's polynomials instead of differences.
template <class S, Form form>
void expect_the_equations_in_every_step(double tolerance, double end) {
  using G = typename S::Group;
  using V = Velocity<S>;
  const HeavyTopParameters p = slow_top();
  const S system(p);
  const auto first = HeavyTopMotion(p, 0.1).point(system, Extended(0.0));
  Method::Stepper<S, form, NoAudit> stepper(system, {.tolerance = tolerance});
  ASSERT_EQ(stepper.start(Extended(end), std::array{first}).outcome, Outcome::ok);
  // Newest first.
  std::vector<Extended> t{first.t};
  std::vector<Configuration<S>> q{first.q};
  std::vector<V> v{first.v};
  std::array<int, 5> orders{};
  while (!stepper.finished()) {
    ASSERT_EQ(stepper.step().outcome, Outcome::ok);
    const auto k = std::size_t(stepper.order());
    ++orders[k];
    t.insert(t.begin(), stepper.time());
    q.insert(q.begin(), stepper.configuration());
    v.insert(v.begin(), stepper.velocity());
    const auto h = [&](std::size_t i) { return Extended(t[i - 1] - t[i]); };
    // alpha_j is the derivative at t[0] of the polynomial that is 1 at t[j] and 0 at the others.
    std::array<Extended, 5> alpha;
    alpha[0] = Extended(0.0);
    for (std::size_t j = 1; j <= k; ++j) {
      alpha[j] = Extended(1.0) / (t[j] - t[0]);
      for (std::size_t m = 1; m <= k; ++m)
        if (m != j) alpha[j] = alpha[j] * (t[0] - t[m]) / (t[j] - t[m]);
      alpha[0] = alpha[0] - alpha[j];
    }
    const V zero = zero_velocity(system);
    V acceleration = zero, kinematic = -v[0];
    Extended sum(0.0), S_0(0.0), S_1(0.0);
    for (std::size_t j = 0; j <= k; ++j) acceleration += alpha[j] * v[j];
    for (std::size_t i = 1; i <= k; ++i) {
      sum = sum + alpha[i - 1];
      const Extended gamma = h(i) * sum;
      kinematic += sum * G::log(G::compose(G::inverse(q[i]), q[i - 1]));
      S_0 = S_0 + gamma * h(i) * h(i);
      S_1 = S_1 + gamma * h(i) * h(i) * ((t[i] + t[i - 1]) / Extended(2.0) - t[0]);
    }
    const auto slope = [&](std::size_t i) -> V {
      return i < v.size() ? V((v[i - 1] - v[i]) / h(i)) : first.acceleration;
    };
    V a = slope(2), b = zero;
    if (k >= 3) {
      const auto middle = [&](std::size_t i) { return Extended((t[i] + t[i - 1]) / Extended(2.0)); };
      b = (slope(2) - slope(4)) / Extended(middle(2) - middle(4));
      a = slope(2) + (t[0] - middle(2)) * b;
    }
    kinematic -= (S_0 * G::commutator(v[1], a) + S_1 * G::commutator(v[1], b)) / Extended(12.0);

    // Round-off of 1e-31 in q, over h^2 in v'.
    const double step = to_double(h(1)), round_off = 1e-29 * (1.0 + 1.0 / step);
    V r = system.momentum(q[0], acceleration) + system.force(t[0], q[0], v[0]);
    if constexpr (S::constraints != 0) {
      const auto B = system.constraint_gradient(q[1]);
      ASSERT_LE(to_double(system.constraint(q[0]).norm()), 1e-28) << t.size();
      r += system.constraint_force(q[0], stepper.multipliers());
      if constexpr (form == Form::stabilized_index2) {
        ASSERT_LE(to_double((system.constraint_gradient(q[0]) * v[0]).norm()), round_off) << t.size();
        // gamma_1 B(q_n)^T eta is what is left.
        const Eigen::Matrix<double, 3, 3> BBt = (B * B.transpose()).template cast<double>();
        Multipliers<S> y = Multipliers<S>::Constant(Extended(0.0));
        for (int pass = 0; pass < 4; ++pass)
          y += BBt.inverse().template cast<Extended>() * (B * V(kinematic - B.transpose() * y));
        kinematic -= B.transpose() * y;
      }
    }
    ASSERT_LE(to_double(kinematic.norm()), 20.0 * round_off) << t.size() << ", order " << k;
    ASSERT_LE(to_double(r.norm()), 20.0 * 15.0 * round_off / step) << t.size() << ", order " << k;
  }
  EXPECT_EQ(to_double(stepper.time()), end);
  for (std::size_t k = 1; k <= 4; ++k) EXPECT_GT(orders[k], 0) << k;
}

TEST(BLieDF2ndVariable, FulfilsItsEquationsInEveryStep) {
  expect_the_equations_in_every_step<HeavyTopSO3<Extended>, Form::index3>(1e-8, 0.5);
}
TEST(BLieDF2ndVariable, FulfilsItsEquationsWithAConstraint) {
  expect_the_equations_in_every_step<HeavyTopR3xSO3<Extended>, Form::index3>(1e-8, 0.5);
  expect_the_equations_in_every_step<HeavyTopR3xSO3<Extended>, Form::stabilized_index2>(1e-8, 0.5);
}

struct Course {
  Outcome outcome = Outcome::ok;
  int steps = 0;
  double time = 0.0, q = 0.0, v = 0.0, lambda = 0.0;  // the end, and the errors there
};

// Of the slow top, from `begin` to `end`.
template <class S>
Course run(const Method::Options& options, double begin = 0.0, double end = 1.0) {
  using T = typename S::Scalar;
  const HeavyTopParameters p = slow_top();
  static const HeavyTopMotion motion(p, 1.0);
  const S system(p);
  const auto stepper = make_stepper<Method, S>(options, system);
  const std::array points{motion.point(system, Extended(begin))};
  Course course{.outcome = stepper->start(T(end - begin), points).outcome};
  while (course.outcome == Outcome::ok && !stepper->finished()) {
    course.outcome = stepper->step().outcome;
    ++course.steps;
  }
  const auto exact = motion.point(system, Extended(end));
  course.time = to_double(stepper->time());
  course.q = S::Group::separation(exact.q, stepper->configuration()).norm();
  course.v = to_double((stepper->velocity() - exact.v).norm());
  course.lambda = to_double((stepper->multipliers() - exact.lambda).norm());
  return course;
}

// What a step size within a factor of 1.2 (bias) times 1.2 (worthwhile) below the one that the tolerance allows
// leaves open.
constexpr double step_margin = 1.2 * 1.2;

// A hundredth of the tolerance: 100^{1/(k+1)} times the steps, each with an error a hundredth as large.
template <class S>
void expect_error_in_proportion_to_tolerance(Form form) {
  constexpr int k = 4;
  const double times_steps = std::pow(100.0, 1.0 / (k + 1));
  Course before;
  for (const double tolerance : {1e-5, 1e-7, 1e-9, 1e-11}) {
    const Course course = run<S>({.tolerance = tolerance, .form = form});
    const std::string text = std::to_string(int(form)) + ' ' + std::to_string(tolerance);
    ASSERT_EQ(course.outcome, Outcome::ok) << text;
    EXPECT_EQ(course.time, 1.0);
    // A local error of the tolerance in each step, which a second of this motion does not multiply by ten; the velocity
    // is 4.3 rad/s.
    EXPECT_LE(course.q, 10.0 * tolerance * course.steps) << text;
    EXPECT_LE(course.v, 10.0 * tolerance * (1.0 + 4.3) * course.steps) << text;
    if (before.steps > 0) {
      const double ratio = double(course.steps) / before.steps;
      EXPECT_LE(ratio, times_steps * step_margin) << text;
      EXPECT_GE(ratio, times_steps / step_margin) << text;
      const double expected = std::log10(100.0 / times_steps), margin = (k + 1) * std::log10(step_margin);
      EXPECT_NEAR(std::log10(before.q / course.q), expected, margin) << text;
      EXPECT_NEAR(std::log10(before.v / course.v), expected, margin) << text;
    }
    before = course;
  }
}

TEST(BLieDF2ndVariable, HasAnErrorInProportionToItsTolerance) {
  expect_error_in_proportion_to_tolerance<HeavyTopSO3<double>>(Form::index3);
  expect_error_in_proportion_to_tolerance<HeavyTopR3xSO3<double>>(Form::index3);
  expect_error_in_proportion_to_tolerance<HeavyTopR3xSO3<double>>(Form::stabilized_index2);
}

// The multipliers: an error of v over a step in the index-3 form, O(h^{k-1}) where steps change; of the order of the
// method in the other.
TEST(BLieDF2ndVariable, HasMultipliersOfTheOrderOfItsForm) {
  using S = HeavyTopR3xSO3<double>;
  for (const Form form : {Form::index3, Form::stabilized_index2}) {
    const double exponent = form == Form::index3 ? 3.0 / 5 : 4.0 / 5;
    const Course coarse = run<S>({.tolerance = 1e-5, .form = form});
    const Course fine = run<S>({.tolerance = 1e-10, .form = form});
    EXPECT_GE(std::log10(coarse.lambda / fine.lambda), 5.0 * exponent - 5.0 * std::log10(step_margin))
        << int(form);
  }
}

TEST(BLieDF2ndVariable, TakesStepsOfTheHighestOrderThatItMay) {
  using S = HeavyTopSO3<double>;
  for (int k = 1; k <= 4; ++k) {
    const Course coarse = run<S>({.tolerance = 1e-5, .max_order = k});
    const Course fine = run<S>({.tolerance = 1e-7, .max_order = k});
    ASSERT_EQ(fine.outcome, Outcome::ok);
    const double expected = std::pow(100.0, 1.0 / (k + 1));
    EXPECT_LE(double(fine.steps) / coarse.steps, expected * step_margin) << k;
    EXPECT_GE(double(fine.steps) / coarse.steps, expected / step_margin) << k;
  }
}

TEST(BLieDF2ndVariable, EndsWithTheOrderFour) {
  const HeavyTopParameters p = slow_top();
  const HeavyTopSO3<double> system(p);
  Method::Stepper<HeavyTopSO3<double>, Form::index3, NoAudit> stepper(system, {.tolerance = 1e-8});
  const std::array points{HeavyTopMotion(p, 0.1).point(system, Extended(0.0))};
  ASSERT_EQ(stepper.start(1.0, points).outcome, Outcome::ok);
  ASSERT_EQ(stepper.step().outcome, Outcome::ok);
  EXPECT_EQ(stepper.order(), 1);
  int before = 1, raised = 0;
  while (!stepper.finished()) {
    ASSERT_EQ(stepper.step().outcome, Outcome::ok);
    EXPECT_LE(stepper.order(), before + 1);
    raised += stepper.order() > before ? 1 : 0;
    before = stepper.order();
  }
  EXPECT_EQ(before, 4);
  EXPECT_GE(raised, 3);
}

template <class S, class C>
void expect_the_same_bits_in_an_audit(Form form) {
  const HeavyTopParameters p = slow_top();
  const HeavyTopMotion motion(p, 1.0);
  const Method::Options options{.tolerance = 1e-8, .form = form};
  const auto stepper = make_stepper<Method, S>(options, S(p));
  const auto audited = make_stepper<Method, C>(options, C(p));
  const std::array points{motion.point(S(p), Extended(0.0))};
  const auto counted = [](const auto& x) { return x.template cast<Counted>().eval(); };
  const std::array counted_points{SolutionPoint<C>{points[0].t, S::Group::template cast<Counted>(points[0].q),
                                                   counted(points[0].v), counted(points[0].acceleration),
                                                   counted(points[0].lambda)}};
  ASSERT_EQ(stepper->start(1.0, points).outcome, Outcome::ok);
  ASSERT_EQ(audited->start(Counted(1.0), counted_points).outcome, Outcome::ok);
  std::uint64_t steps = 0;
  while (!stepper->finished()) {
    ASSERT_EQ(stepper->step().outcome, Outcome::ok);
    ASSERT_EQ(audited->step().outcome, Outcome::ok);
    ASSERT_EQ(state_of(*stepper), state_of(*audited)) << ++steps;
  }
  EXPECT_TRUE(audited->finished());
  // Each step asks for an iteration, and a rejected one, too.
  EXPECT_GE(audited->audit().iterations, steps + audited->audit().rejections);
  EXPECT_GE(audited->audit().rejections, 1u);
}

TEST(BLieDF2ndVariable, TakesTheSameStepsInAnAudit) {
  expect_the_same_bits_in_an_audit<HeavyTopSO3<double>, CountedSO3>(Form::index3);
  for (const Form form : {Form::index3, Form::stabilized_index2})
    expect_the_same_bits_in_an_audit<HeavyTopR3xSO3<double>, CountedR3xSO3>(form);
}

TEST(BLieDF2ndVariable, GoesBackwardsToo) {
  const Course so3 = run<HeavyTopSO3<double>>({.tolerance = 1e-9}, 0.5, 0.0);
  ASSERT_EQ(so3.outcome, Outcome::ok);
  EXPECT_EQ(so3.time, 0.0);
  EXPECT_LE(so3.q, 10.0 * 1e-9 * so3.steps);
  for (const Form form : {Form::index3, Form::stabilized_index2}) {
    const Course free = run<HeavyTopR3xSO3<double>>({.tolerance = 1e-9, .form = form}, 0.5, 0.0);
    ASSERT_EQ(free.outcome, Outcome::ok);
    EXPECT_LE(free.q, 10.0 * 1e-9 * free.steps);
  }
}

template <class S>
void expect_a_constant_velocity_exactly(Form form) {
  constexpr double spin = 3.0, length = 20.0, tolerance = 1e-4;
  const HeavyTopParameters p = hanging_top(spin);
  const S system(p);
  const auto stepper = make_stepper<Method, S>({.tolerance = tolerance, .form = form}, system);
  ASSERT_EQ(stepper->start(length, hanging_top_points<S>(p, 0.0, 1)).outcome, Outcome::ok);
  const double eps = std::numeric_limits<double>::epsilon();
  double before = 0.0, first = 0.0, longest = 0.0;
  int steps = 0;
  while (!stepper->finished()) {
    ASSERT_EQ(stepper->step().outcome, Outcome::ok);
    const double t = stepper->time();
    if (++steps == 1) first = t;
    // Nothing is ever rejected.
    ASSERT_GE(t - before, longest * (1.0 - 1e-9)) << steps;
    longest = t - before;
    before = t;
    // The velocity is known to some eps |q| / h of the first, the shortest, step.
    const double of_v = 64.0 * eps * (spin + 1.0 / first) * std::sqrt(double(steps));
    const auto exact = hanging_top_points<S>(p, t, 2)[1];
    ASSERT_LE((stepper->velocity() - exact.v).norm(), of_v) << steps;
    ASSERT_LE(S::Group::separation(exact.q, stepper->configuration()).norm(), of_v * (1.0 + t)) << steps;
  }
  // Steps grow by 2 at most, and up to a turn of 0.9 pi.
  EXPECT_LT(first, 2e-3);
  EXPECT_LE(spin * longest, 0.91 * std::numbers::pi);
  EXPECT_GE(spin * longest, 0.9 * std::numbers::pi / 2.0);
  EXPECT_LE(steps, 60);
}

TEST(BLieDF2ndVariable, FollowsAConstantVelocityExactlyInStepsUpToHalfATurn) {
  expect_a_constant_velocity_exactly<HeavyTopSO3<double>>(Form::index3);
  expect_a_constant_velocity_exactly<HeavyTopR3xSO3<double>>(Form::index3);
  expect_a_constant_velocity_exactly<HeavyTopR3xSO3<double>>(Form::stabilized_index2);
}

TEST(BLieDF2ndVariable, FollowsARotationThatGrowsFasterInShorterSteps) {
  // Omega = 2 + t / 2 about one axis: the turn limits the step.
  using S = SpinningUp<double>;
  const auto stepper = make_stepper<Method, S>({.tolerance = 1e-3}, S());
  const std::array points{spinning_up_point(0.0)};
  ASSERT_EQ(stepper->start(40.0, points).outcome, Outcome::ok);
  double before = 0.0, longest_turn = 0.0;
  while (!stepper->finished()) {
    ASSERT_EQ(stepper->step().outcome, Outcome::ok);
    const double t = stepper->time();
    longest_turn = std::max(longest_turn, (t - before) * (2.0 + 0.25 * (t + before)));
    before = t;
  }
  EXPECT_LT(longest_turn, std::numbers::pi);
  EXPECT_GT(longest_turn, 1.0);
  EXPECT_LE((stepper->velocity() - spinning_up_point(40.0).v).norm(), 1e-9);
}

// A particle under a constant pull runs into a spring of 1000 N/m: the steps before it are too long there. Without
// commutators.
TEST(BLieDF2ndVariable, RejectsStepsIntoAWallAndCountsThem) {
  using S = Audited<Particle<double, Unconstrained>>;
  const S system{Particle<double, Unconstrained>(1.0, ParticleForce::spring_behind_a_wall)};
  const auto stepper = held_stepper<Method, S>({.tolerance = 1e-7}, system);
  std::vector<SolutionPoint<S>> points(1);
  ASSERT_EQ(stepper->start_itself(3.0, points).outcome, Outcome::ok);
  double shortest = 1.0, longest_before_the_wall = 0.0, before = 0.0;
  while (!stepper->finished()) {
    ASSERT_EQ(stepper->step().outcome, Outcome::ok);
    const double h = stepper->time() - before;
    before = stepper->time();
    if (stepper->configuration()(1) < 1.0)
      longest_before_the_wall = std::max(longest_before_the_wall, h);
    else if (stepper->configuration()(1) > 1.5)
      shortest = std::min(shortest, h);
  }
  EXPECT_GE(stepper->audit().rejections, 1u);
  EXPECT_LT(shortest, 0.2 * longest_before_the_wall);
  // y = t + t^2 / 2 up to 3/2 at t = 1, then y = 3/2 + 1/1000 + 2 sin(w s) / w - cos(w s) / 1000 with s = t - 1 and
  // w^2 = 1000 /s^2; back at the wall with y' = -2, and free again.
  const double w = std::sqrt(1000.0);
  const double phase = std::atan2(-1e-3, 2.0 / w);
  const double out = 1.0 + (std::numbers::pi - 2.0 * phase) / w;
  const double s = 3.0 - out;
  EXPECT_NEAR(stepper->configuration()(1), 1.5 - 2.0 * s + 0.5 * s * s, 1e-3);
}

TEST(BLieDF2ndVariable, ReportsForcesThatAreNoNumbersAndStaysWhereItIs) {
  HeavyTopParameters p = slow_top();
  const std::array points{HeavyTopMotion(p, 0.2).point(HeavyTopSO3<double>(p), Extended(0.0))};
  p.gravity[1] = std::numeric_limits<double>::quiet_NaN();
  const auto stepper = make_stepper<Method, HeavyTopSO3<double>>({}, HeavyTopSO3<double>(p));
  ASSERT_EQ(stepper->start(0.1, points).outcome, Outcome::ok);
  const auto before = state_of(*stepper);
  EXPECT_EQ(stepper->step().outcome, Outcome::non_finite);
  EXPECT_EQ(state_of(*stepper), before);
  EXPECT_FALSE(stepper->finished());
}

TEST(BLieDF2ndVariable, ReportsStepsInWhichNoTimePasses) {
  // The first step would be of 1e-17 s at t = 1/2 s.
  const Course course = run<HeavyTopSO3<double>>({.tolerance = 1e-30}, 0.5, 1.0);
  EXPECT_EQ(course.outcome, Outcome::step_limit);
  EXPECT_EQ(course.time, 0.5);
}

}  // namespace
}  // namespace liebench::bliedf2nd_variable_test
