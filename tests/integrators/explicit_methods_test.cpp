#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "integrators/commutator_free.h"
#include "integrators/crouch_grossman.h"
#include "integrators/rkmk.h"
#include "integrators/runge_kutta_tableau.h"
#include "tests/support/observed_order.h"
#include "tests/support/small_systems.h"
#include "tests/support/steppers.h"

namespace liebench::explicit_methods_test {
namespace {

// --- tableaus: the conditions of order of rooted trees [Hairer, Norsett & Wanner, Solving ODE I, II.2] ------------------------

// A rooted tree by its subtrees, which are trees of the list at lower places.
struct Tree {
  std::vector<std::size_t> children;
  int order;
  double density;  // gamma
};

std::vector<Tree> trees_up_to(int order) {
  std::vector<Tree> trees{{{}, 1, 1.0}};
  for (int p = 2; p <= order; ++p) {
    const std::size_t known = trees.size();
    // Subtrees at falling places, so that each set of them comes once.
    std::vector<std::size_t> children;
    const std::function<void(int, std::size_t)> grow = [&](int left, std::size_t end) {
      if (left == 0) {
        double density = p;
        for (const std::size_t child : children) density *= trees[child].density;
        trees.push_back({children, p, density});
        return;
      }
      for (std::size_t child = 0; child < end; ++child) {
        if (trees[child].order > left) continue;
        children.push_back(child);
        grow(left - trees[child].order, child + 1);
        children.pop_back();
      }
    };
    grow(p - 1, known);
  }
  return trees;
}

// sum_i b_i Phi_i(tree) for each of the trees.
template <std::size_t s>
std::vector<Extended> elementary_weights(const ExplicitTableau<s>& tableau, const std::vector<Tree>& trees) {
  std::vector<std::array<Extended, s>> stage_weights;  // of each tree: sum_j a_ij Phi_j
  std::vector<Extended> weights;
  for (const Tree& tree : trees) {
    std::array<Extended, s> phi;
    phi.fill(Extended(1.0));
    for (const std::size_t child : tree.children)
      for (std::size_t i = 0; i < s; ++i) phi[i] *= stage_weights[child][i];
    Extended weight(0.0);
    auto& above = stage_weights.emplace_back();
    above.fill(Extended(0.0));
    for (std::size_t i = 0; i < s; ++i) {
      weight += value_of<Extended>(tableau.b[i]) * phi[i];
      for (std::size_t j = 0; j < i; ++j) above[i] += value_of<Extended>(tableau.a[i][j]) * phi[j];
    }
    weights.push_back(weight);
  }
  return weights;
}

template <std::size_t s>
void expect_order(const ExplicitTableau<s>& tableau, const char* name) {
  const std::vector<Tree> trees = trees_up_to(tableau.order + 1);
  const std::vector<Extended> weights = elementary_weights(tableau, trees);
  bool higher = true;
  for (std::size_t i = 0; i < trees.size(); ++i) {
    const double defect = std::abs(to_double(weights[i] - Extended(1.0) / trees[i].density));
    if (trees[i].order <= tableau.order)
      EXPECT_LE(defect, 1e-29) << name << ", tree " << i << " of order " << trees[i].order;
    else
      higher = higher && defect < 1e-29;
  }
  EXPECT_FALSE(higher) << name << " has a higher order than it says";
  for (std::size_t i = 0; i < s; ++i) {
    Extended c(0.0);
    for (std::size_t j = 0; j < i; ++j) c += value_of<Extended>(tableau.a[i][j]);
    EXPECT_LE(std::abs(to_double(c - value_of<Extended>(tableau.c[i]))), 1e-30) << name << ", stage " << i;
  }
}

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
