#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "integrators/radau.h"
#include "integrators/radau_coefficients.h"
#include "integrators/radau_equation.h"
#include "integrators/radau_matrix.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/observed_order.h"
#include "tests/support/small_systems.h"
#include "tests/support/steppers.h"

namespace liebench::radau_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

// --- coefficients: B(5), C(3), D(2) [Hairer & Wanner, Solving ODE II, IV.5] ----------------------------------------------------------

// Sums of three terms below 8.
constexpr double extended_round_off = 1e-30;

using Weights = RadauCoefficients<Extended>::Row;
using Values = std::array<Extended, 3>;

Values powers_of(const Values& x, int k) {
  Values values{Extended(1.0), Extended(1.0), Extended(1.0)};
  for (int i = 0; i < k; ++i)
    for (std::size_t j = 0; j < 3; ++j) values[j] *= x[j];
  return values;
}
Extended sum(const Weights& w, const Values& x) {
  return w[0] * x[0] + w[1] * x[1] + w[2] * x[2];
}
void expect_equal(const Extended& x, const Extended& y) {
  EXPECT_LE(std::abs(to_double(x - y)), extended_round_off);
}

TEST(RadauCoefficients, FulfilTheSimplifyingAssumptions) {
  const RadauCoefficients<Extended> g;
  // Stiffly accurate: b is the last row.
  const Weights b = g.a[2];
  for (int k = 1; k <= 5; ++k) expect_equal(sum(b, powers_of(g.c, k - 1)), Extended(1.0) / double(k));
  EXPECT_GE(std::abs(to_double(sum(b, powers_of(g.c, 5)) - Extended(1.0) / 6.0)), 1e-4);
  for (std::size_t i = 0; i < 3; ++i) {
    for (int k = 1; k <= 3; ++k)
      expect_equal(sum(g.a[i], powers_of(g.c, k - 1)), powers_of(g.c, k)[i] / double(k));
    for (int k = 1; k <= 2; ++k) {
      const Values c = powers_of(g.c, k - 1);
      const Values column{g.a[0][i], g.a[1][i], g.a[2][i]};
      const Extended adjoint = b[0] * c[0] * column[0] + b[1] * c[1] * column[1] + b[2] * c[2] * column[2];
      expect_equal(adjoint, b[i] * (Extended(1.0) - powers_of(g.c, k)[i]) / double(k));
    }
    for (std::size_t j = 0; j < 3; ++j)
      expect_equal(sum(g.inverse[i], {g.a[0][j], g.a[1][j], g.a[2][j]}), Extended(i == j ? 1.0 : 0.0));
  }
}

TEST(RadauCoefficients, ContinueTheCollocationPolynomials) {
  const RadauCoefficients<Extended> g;
  for (std::size_t i = 0; i < 3; ++i) {
    const Values next{Extended(1.0) + g.c[i], Extended(0.0), Extended(0.0)};
    for (int k = 0; k <= 2; ++k) expect_equal(sum(g.next_value[i], powers_of(g.c, k)), powers_of(next, k)[0]);
    for (int k = 1; k <= 3; ++k)
      expect_equal(sum(g.next_change[i], powers_of(g.c, k)), powers_of(next, k)[0] - Extended(1.0));
  }
}

// --- linear spaces: the classical method ------------------------------------------------------------------------------------

// y_i = y_n + h sum_j a_ij f(t_n + c_j h, y_j) for y = (q, v), by plain fixed-point iteration; y_{n+1} = y_3.
TEST(Radau, IsTheClassicalMethodInALinearSpace) {
  using S = Oscillators<double, 2>;
  using State = Eigen::Vector4d;
  const S system;
  const RadauCoefficients<double> g;
  constexpr double h = 1.0 / 16;
  const auto slope = [&](double t, const State& y) -> State {
    const Eigen::Vector2d q = y.head<2>(), v = y.tail<2>();
    State f;
    f << v, -system.mass_matrix(q).inverse() * system.force(t, q, v);
    return f;
  };
  State y;
  y << system.initial_configuration(), system.initial_velocity();
  const State first = slope(0.0, y);
  const auto stepper = make_stepper<Radau, S>({}, system);
  const std::array points{SolutionPoint<S>{0.0, y.head<2>(), y.tail<2>(), first.tail<2>(), {}}};
  ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
  for (int step = 0; step < 64; ++step) {
    std::array<State, 3> stages{y, y, y};
    for (int sweep = 0; sweep < 60; ++sweep) {
      std::array<State, 3> f;
      for (std::size_t j = 0; j < 3; ++j) f[j] = slope((step + g.c[j]) * h, stages[j]);
      for (std::size_t i = 0; i < 3; ++i)
        stages[i] = y + h * (g.a[i][0] * f[0] + g.a[i][1] * f[1] + g.a[i][2] * f[2]);
    }
    y = stages[2];
    ASSERT_EQ(stepper->step().outcome, Outcome::ok);
    // W_i enters by the inverse of a, whose entries are up to 7.6: that many eps in each step.
    ASSERT_LE((stepper->configuration() - y.head<2>()).norm(), 8 * eps * (step + 1)) << step;
    ASSERT_LE((stepper->velocity() - y.tail<2>()).norm(), 8 * eps * (step + 1)) << step;
  }
}

// --- orders -----------------------------------------------------------------------------------------------------------------

TEST(Radau, HasOrderFiveOnRotations) {
  const Errors order = observed_orders<Radau, ExtendedSO3>({});
  EXPECT_NEAR(order.q, 5, order_tolerance);
  EXPECT_NEAR(order.v, 5, order_tolerance);
}

// Index 3: v loses two orders and lambda three [Hairer, Lubich & Roche 1989, theorem 6.4], at the end as in all steps, for every step has
// its own errors of v and lambda: stage values of order 3 and 2.
TEST(Radau, HasItsOrdersOnTheConstrainedTop) {
  struct Expected {
    Form form;
    int q, v, lambda;
  };
  for (const Expected& expected :
       {Expected{Form::index3, 5, 3, 2}, Expected{Form::stabilized_index2, 5, 5, 3}}) {
    const Errors order = observed_orders<Radau, ExtendedR3xSO3>({expected.form});
    EXPECT_NEAR(order.q, expected.q, order_tolerance) << int(expected.form);
    EXPECT_NEAR(order.v, expected.v, order_tolerance) << int(expected.form);
    EXPECT_NEAR(order.lambda, expected.lambda, order_tolerance) << int(expected.form);
    EXPECT_NEAR(order.largest_q, expected.q, order_tolerance) << int(expected.form);
    EXPECT_NEAR(order.largest_v, expected.v, order_tolerance) << int(expected.form);
    EXPECT_NEAR(order.largest_lambda, expected.lambda, order_tolerance) << int(expected.form);
  }
}

TEST(Radau, SaysItsOrders) {
  OptionValues values;
  EXPECT_EQ(Radau::orders(values).v, 5);
  values.set("form", std::string("index3"));
  EXPECT_EQ(Radau::orders(values).v, 3);
  EXPECT_EQ(Radau::orders(values).lambda, 2);
  values.set("form", std::string("stabilized_index2"));
  EXPECT_EQ(Radau::orders(values).v, 5);
  EXPECT_EQ(Radau::orders(values).lambda, 3);
}

// --- constraints ------------------------------------------------------------------------------------------------------------

TEST(Radau, KeepsTheConstraintAndTheHiddenOneInTheStabilizedForm) {
  using S = HeavyTopR3xSO3<double>;
  const HeavyTopParameters p = unsymmetric_top(5);
  const S system(p);
  const std::array points{HeavyTopMotion(p, 0.1).point(system, Extended(0.0))};
  const double size = std::max(1.0, points[0].q.first.norm()), speed = points[0].v.norm();
  for (const Form form : {Form::index3, Form::stabilized_index2}) {
    const auto stepper = make_stepper<Radau, S>({form}, system);
    ASSERT_EQ(stepper->start(1.0 / 128, points).outcome, Outcome::ok);
    double hidden = 0.0;
    for (int step = 0; step < 128; ++step) {
      ASSERT_EQ(stepper->step().outcome, Outcome::ok);
      EXPECT_LE(system.constraint(stepper->configuration()).norm(), 64 * eps * size) << step;
      hidden = std::max(hidden,
                        (system.constraint_gradient(stepper->configuration()) * stepper->velocity()).norm());
    }
    if (form == Form::stabilized_index2)
      EXPECT_LE(hidden, 64 * eps * speed * size);
    else
      EXPECT_GE(hidden, 1e-8 * speed);
  }
}

// --- the Newton matrix ------------------------------------------------------------------------------------------------------

// On a top that turns about a fixed axis all Theta_i are along all K_i, where the matrix is that of the derivatives: its solution of
// central differences of the residual is the direction of the difference, but for their error of width^2 and eps / width times the
// condition of the matrix, below 1e5.
template <class S, Form form>
void expect_derivative(const HeavyTopParameters& p, const SolutionPoint<S>& point) {
  using Equation = RadauEquation<S, form>;
  using Unknowns = typename Equation::Unknowns;
  const S system(p);
  const RadauCoefficients<double> coefficients;
  const typename Equation::Start start{coefficients, point.v};
  constexpr double h = 0.1, width = 1e-5;
  Unknowns z = Unknowns::Zero();
  if constexpr (S::constraints != 0)
    for (int i = 0; i < 3; ++i) Equation::lambda_part(z, system, i) = h * point.lambda;
  typename Equation::Point at;
  Equation::evaluate(system, h, point.q, start, z, at);
  DenseRadauMatrix<S, form> matrix(system);
  ASSERT_EQ(matrix.factorize(system, h, h, point.q, start, at, z), Outcome::ok);
  RandomNumbers random(7);
  for (int trial = 0; trial < 4; ++trial) {
    const Unknowns direction = random.vector<Equation::n>();
    Unknowns forth, back;
    const Unknowns z_forth = z + width * direction, z_back = z - width * direction;
    Equation::evaluate(system, h, point.q, start, z_forth, at);
    Equation::residual(system, h, h, at, z_forth, forth);
    Equation::evaluate(system, h, point.q, start, z_back, at);
    Equation::residual(system, h, h, at, z_back, back);
    const Unknowns difference = (forth - back) / (2 * width);
    EXPECT_LE((matrix.solve(difference) - direction).norm(), 1e-5 * direction.norm()) << trial;
  }
}

TEST(RadauMatrix, IsTheDerivativeWhereTheAxisOfRotationIsFixed) {
  HeavyTopParameters p;
  p.mass = 2;
  p.inertia = {{{0.5, 0, 0}, {0, 0.7, 0}, {0, 0, 0.4}}};
  p.center_of_mass = {0, 0, -0.5};
  p.angular_velocity = {0, 0, 4};
  p.orientation = {0.8, 0, 0, 0.6};
  const HeavyTopMotion motion(p, 0.1);
  const auto begin = [&]<class S>(const S& system) { return motion.point(system, Extended(0.0)); };
  using Fixed = HeavyTopSO3<double>;
  using Free = HeavyTopR3xSO3<double>;
  using Moving = HeavyTopSE3<double>;
  expect_derivative<Fixed, Form::index3>(p, begin(Fixed(p)));
  expect_derivative<Free, Form::index3>(p, begin(Free(p)));
  expect_derivative<Free, Form::stabilized_index2>(p, begin(Free(p)));
  expect_derivative<Moving, Form::stabilized_index2>(p, begin(Moving(p)));
}

// --- failures ---------------------------------------------------------------------------------------------------------------

template <template <class> class Law>
Outcome outcome_of_a_step(Form form) {
  using S = Particle<double, Law>;
  const S system;
  const auto stepper = make_stepper<Radau, S>({form}, system);
  const Eigen::Vector2d q = system.initial_configuration(), v = system.initial_velocity();
  const std::array points{SolutionPoint<S>{0.0, q, v, Eigen::Vector2d::Zero(), zero_multipliers(system)}};
  EXPECT_EQ(stepper->start(0.1, points).outcome, Outcome::ok);
  const Outcome outcome = stepper->step().outcome;
  EXPECT_EQ(stepper->time(), 0.0);
  EXPECT_EQ(stepper->configuration(), q);
  EXPECT_EQ(stepper->velocity(), v);
  return outcome;
}

TEST(Radau, FailsWhereTheConstraintsDependOnEachOtherOrContradict) {
  for (const Form form : {Form::index3, Form::stabilized_index2}) {
    EXPECT_EQ(outcome_of_a_step<RedundantConstraint>(form), Outcome::singular_matrix);
    EXPECT_NE(outcome_of_a_step<ImpossibleConstraint>(form), Outcome::ok);
  }
}

}  // namespace
}  // namespace liebench::radau_test
