#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "integrators/commutator_free.h"
#include "integrators/crouch_grossman.h"
#include "integrators/rkmk.h"
#include "integrators/runge_kutta_tableau.h"
#include "tests/support/observed_order.h"
#include "tests/support/rooted_trees.h"
#include "tests/support/small_systems.h"
#include "tests/support/steppers.h"

namespace liebench::explicit_methods_test {
namespace {

// --- tableaus ---------------------------------------------------------------------------------------------------------------

TEST(ExplicitTableaus, FulfilTheConditionsOfTheirOrder) {
  ASSERT_EQ(trees_up_to(6).size(), 37u);
  expect_order(classical_four, "rk4");
  expect_order(dormand_prince_five, "dopri5");
  expect_order(butcher_six, "butcher6");
  expect_order(crouch_grossman_three, "crouch_grossman");
}

TEST(CrouchGrossman, FulfilsTheFurtherConditionOfOrderThree) {
  // sum b_i^2 c_i + 2 sum_{i<j} b_i c_i b_j = 1/3, where factors of a product do not commute [Owren & Marthinsen 1999].
  const auto& t = crouch_grossman_three;
  Extended sum(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const Extended b = value_of<Extended>(t.b[i]), c = value_of<Extended>(t.c[i]);
    sum += b * b * c;
    for (std::size_t j = i + 1; j < 3; ++j) sum += Extended(2.0) * b * c * value_of<Extended>(t.b[j]);
  }
  EXPECT_LE(std::abs(to_double(sum - Extended(1.0) / 3.0)), 1e-31);
}

// --- linear spaces: the classical methods -----------------------------------------------------------------------------------

// A textbook loop: k_i = f(t + c_i h, y + h sum a_ij k_j) for y = (q, v).
template <std::size_t s, int n>
void textbook_step(const ExplicitTableau<s>& tableau, const Oscillators<double, n>& system, double t,
                   double h, Eigen::Matrix<double, n, 1>& q, Eigen::Matrix<double, n, 1>& v) {
  using Vector = Eigen::Matrix<double, n, 1>;
  std::array<Vector, s> dq, dv;
  const auto weight = [](const Fraction& f) { return double(f.numerator) / double(f.denominator); };
  for (std::size_t i = 0; i < s; ++i) {
    Vector Q = q, V = v;
    for (std::size_t j = 0; j < i; ++j) {
      Q += h * weight(tableau.a[i][j]) * dq[j];
      V += h * weight(tableau.a[i][j]) * dv[j];
    }
    dq[i] = V;
    dv[i] = -system.mass_matrix(Q).inverse() * system.force(t + weight(tableau.c[i]) * h, Q, V);
  }
  for (std::size_t i = 0; i < s; ++i) {
    q += h * weight(tableau.b[i]) * dq[i];
    v += h * weight(tableau.b[i]) * dv[i];
  }
}

template <class Method, std::size_t s>
void expect_the_classical_method(const typename Method::Options& options, const ExplicitTableau<s>& tableau) {
  using S = Oscillators<double, 2>;
  const S system;
  constexpr double h = 1.0 / 16;
  Eigen::Vector2d q = system.initial_configuration(), v = system.initial_velocity();
  const auto stepper = make_stepper<Method, S>(options, system);
  const std::array points{SolutionPoint<S>{0.0, q, v, Eigen::Vector2d::Zero(), {}}};
  ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
  for (int step = 0; step < 64; ++step) {
    textbook_step(tableau, system, step * h, h, q, v);
    ASSERT_EQ(stepper->step().outcome, Outcome::ok);
    ASSERT_LE((stepper->configuration() - q).norm(), 1e-14) << step;
    ASSERT_LE((stepper->velocity() - v).norm(), 1e-14) << step;
  }
}

TEST(ExplicitMethods, AreTheClassicalOnesInALinearSpace) {
  expect_the_classical_method<Rkmk>({Rkmk::Tableau::rk4}, classical_four);
  expect_the_classical_method<Rkmk>({Rkmk::Tableau::dopri5}, dormand_prince_five);
  expect_the_classical_method<Rkmk>({Rkmk::Tableau::butcher6}, butcher_six);
  expect_the_classical_method<CommutatorFree>({}, classical_four);
  expect_the_classical_method<CrouchGrossman>({}, crouch_grossman_three);
}

// --- rotations --------------------------------------------------------------------------------------------------------------

template <class Method>
void expect_order_on_rotations(const typename Method::Options& options, int order) {
  const Errors so3 = observed_orders<Method, ExtendedSO3>(options);
  EXPECT_NEAR(so3.q, order, order_tolerance) << Method::name;
  EXPECT_NEAR(so3.v, order, order_tolerance) << Method::name;
}

TEST(ExplicitMethods, HaveTheirOrdersOnRotations) {
  expect_order_on_rotations<Rkmk>({Rkmk::Tableau::rk4}, 4);
  expect_order_on_rotations<Rkmk>({Rkmk::Tableau::dopri5}, 5);
  expect_order_on_rotations<Rkmk>({Rkmk::Tableau::butcher6}, 6);
  expect_order_on_rotations<CommutatorFree>({}, 4);
  expect_order_on_rotations<CrouchGrossman>({}, 3);
}

TEST(ExplicitMethods, DoNotFitAConstrainedProblem) {
  const HeavyTopParameters p = slow_top();
  EXPECT_EQ(any_stepper<HeavyTopR3xSO3<double>>(Rkmk::Options{}, HeavyTopR3xSO3<double>(p)), nullptr);
  EXPECT_NE(any_stepper<HeavyTopSO3<double>>(Rkmk::Options{}, HeavyTopSO3<double>(p)), nullptr);
}

}  // namespace
}  // namespace liebench::explicit_methods_test
