#include "tests/support/allocation_counter.h"
// clang-format off: the counter comes before Eigen
#include "integrators/bliedf2nd.h"
// clang-format on

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

#include "groups/extended.h"
#include "problems/heavy_top.h"
#include "tests/support/heavy_top_motion.h"
#include "tests/support/heavy_top_samples.h"

namespace liebench {
namespace {

TEST(AllocationCounter, SeesOperatorNewAndTheMatricesOfEigen) {
  const AllocationCounter counter;
  EXPECT_EQ(counter.count(), 0u);
  const auto number = std::make_unique<int>(7);
  EXPECT_EQ(counter.count(), 1u);
  const std::vector<double> numbers(100, double(*number));
  EXPECT_EQ(counter.count(), 2u);
  const Eigen::MatrixXd matrix = Eigen::MatrixXd::Constant(10, 10, numbers[0]);
  EXPECT_EQ(counter.count(), 3u);
  EXPECT_EQ(matrix(0, 0), 7.0);
}

template <int k, class S>
void expect_no_allocation(const BLieDF2nd::Options& options) {
  using T = typename S::Scalar;
  const HeavyTopParameters p = slow_top();
  const S system(p);
  const HeavyTopMotion motion(p, 0.2);
  const T h(0.01);
  std::array<SolutionPoint<S>, k + 1> points;
  for (int j = 0; j <= k; ++j) points[std::size_t(j)] = motion.point(system, Extended(h) * double(j));
  BLieDF2nd::Stepper<k, S> stepper(system, options);
  Outcome outcome = Outcome::ok;
  unsigned long allocations = 0;
  {
    const AllocationCounter counter;
    outcome = stepper.start(h, points).outcome;
    // Refreshed factorizations and the rare paths of the stopping rule are among 300 steps.
    for (int n = 0; n < 300 && outcome == Outcome::ok; ++n) outcome = stepper.step().outcome;
    allocations = counter.count();
  }
  EXPECT_EQ(outcome, Outcome::ok);
  EXPECT_EQ(allocations, 0u) << "k = " << k << ", " << S::formulation;
}

template <class S>
void expect_no_allocation_of_any_method() {
  for (const bool modified : {false, true}) {
    expect_no_allocation<1, S>({.k = 1, .modified_start = modified});
    expect_no_allocation<2, S>({.k = 2, .modified_start = modified});
    expect_no_allocation<3, S>({.k = 3, .modified_start = modified});
    expect_no_allocation<4, S>({.k = 4, .modified_start = modified});
  }
}

TEST(BLieDF2nd, AllocatesNothingInDouble) {
  expect_no_allocation_of_any_method<HeavyTopSO3<double>>();
  expect_no_allocation_of_any_method<HeavyTopR3xSO3<double>>();
}

TEST(BLieDF2nd, AllocatesNothingInExtendedPrecision) {
  expect_no_allocation_of_any_method<HeavyTopSO3<Extended>>();
  expect_no_allocation_of_any_method<HeavyTopR3xSO3<Extended>>();
}

}  // namespace
}  // namespace liebench
