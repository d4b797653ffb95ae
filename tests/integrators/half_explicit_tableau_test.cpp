#include "integrators/half_explicit_tableau.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>

#include "groups/extended.h"
#include "tests/support/rooted_trees.h"

namespace liebench::half_explicit_tableau_test {
namespace {

constexpr double eps = 2.3e-16;

// The new value as a Runge-Kutta method of its own, of so many stages.
template <std::size_t stages, std::size_t s>
ExplicitTableau<stages> explicit_part(const HalfExplicitTableau<s>& tableau) {
  EXPECT_EQ(tableau.end, stages);
  ExplicitTableau<stages> part{};
  part.order = tableau.orders.q;
  for (std::size_t i = 0; i < stages; ++i) {
    part.c[i] = tableau.c[i];
    part.b[i] = tableau.a[stages][i];
    for (std::size_t j = 0; j < i; ++j) part.a[i][j] = tableau.a[i][j];
  }
  return part;
}

TEST(HalfExplicitTableaus, FulfilTheConditionsOfTheirOrder) {
  expect_order(explicit_part<3>(herk_three), "herk3");
  expect_order(explicit_part<4>(herk_four), "herk4");
  expect_order(explicit_part<6>(hedop_five), "hedop5");
}

// sum_j w_j c_j^power
template <std::size_t s>
Extended moment(const HalfExplicitTableau<s>& tableau, const std::array<Fraction, s>& weights, int power) {
  Extended sum(0.0);
  for (std::size_t j = 0; j < s; ++j) {
    Extended term = value_of<Extended>(weights[j]);
    for (int k = 0; k < power; ++k) term *= value_of<Extended>(tableau.c[j]);
    sum += term;
  }
  return sum;
}

template <std::size_t s>
void expect_consistent_rows(const HalfExplicitTableau<s>& tableau, const char* name) {
  const auto expect_near = [&](const Extended& actual, const Extended& expected, std::size_t row) {
    EXPECT_LE(std::abs(to_double(actual - expected)), 1e-30) << name << ", row " << row;
  };
  for (std::size_t i = 0; i <= s; ++i) {
    const Extended c = value_of<Extended>(tableau.c[i]);
    expect_near(moment(tableau, tableau.a[i], 0), c, i);
    // The first of them is the explicit stage, of order 1.
    if (i >= 2) expect_near(moment(tableau, tableau.a[i], 1), c * c / 2.0, i);
    for (std::size_t j = i; j < s; ++j) EXPECT_TRUE(tableau.a[i][j].is_zero()) << name << ", row " << i;
    // What v'_i and its multipliers follow from.
    EXPECT_TRUE(i < 2 || !tableau.a[i][i - 1].is_zero()) << name << ", row " << i;
  }
  // lambda is that of the end of the step, to order 2.
  expect_near(moment(tableau, tableau.d, 0), Extended(1.0), s + 1);
  expect_near(moment(tableau, tableau.d, 1), Extended(1.0), s + 1);
  EXPECT_TRUE(tableau.d[0].is_zero());
}

TEST(HalfExplicitTableaus, HaveRowsOfStageOrderTwo) {
  expect_consistent_rows(herk_three, "herk3");
  expect_consistent_rows(herk_four, "herk4");
  expect_consistent_rows(hedop_five, "hedop5");
}

TEST(HalfExplicitTableaus, HaveTheirLastRowsToFullPrecision) {
  // (3 - sqrt(3)) / 6 is a root of c^2 - c + 1/6.
  const Extended c = value_of<Extended>(herk_four.c[5]);
  EXPECT_LE(std::abs(to_double(c * c - c + Extended(1.0) / 6.0)), 1e-31);
  EXPECT_NEAR(value_of<double>(herk_four.c[5]), to_double(c), eps);
  // That of HEDOP5 has stage order 3.
  const Extended end = value_of<Extended>(hedop_five.c[7]);
  EXPECT_LE(std::abs(to_double(moment(hedop_five, hedop_five.a[7], 2) - end * end * end / 3.0)), 1e-30);
}

}  // namespace
}  // namespace liebench::half_explicit_tableau_test
