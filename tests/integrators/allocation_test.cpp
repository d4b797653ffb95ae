#include "tests/support/allocation_counter.h"
// clang-format off: the counter comes before Eigen
#include "integrators/bliedf2nd.h"
// clang-format on

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "groups/extended.h"
#include "problems/heavy_top.h"
#include "tests/support/any_stepper.h"
#include "tests/support/heavy_top_motion.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/method_cases.h"

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

template <class S>
void expect_no_allocation(const S& system, AnyStepper<S>& stepper, const HeavyTopMotion& motion,
                          const std::string& text) {
  using T = typename S::Scalar;
  const T h(0.005);  // h |v| = 0.02
  std::vector<SolutionPoint<S>> points;
  for (int j = 0; j < stepper.starting_points(); ++j)
    points.push_back(motion.point(system, Extended(h) * double(j)));
  Outcome outcome = Outcome::ok;
  unsigned long allocations = 0;
  {
    const AllocationCounter counter;
    outcome = stepper.start(h, points).outcome;
    // Refreshed factorizations and the rare paths of the stopping rule are among 300 steps.
    for (int n = 0; n < 300 && outcome == Outcome::ok; ++n) outcome = stepper.step().outcome;
    allocations = counter.count();
  }
  EXPECT_EQ(outcome, Outcome::ok) << S::formulation << ", " << text;
  EXPECT_EQ(allocations, 0u) << S::formulation << ", " << text;
}

template <class S>
void expect_no_allocation_of_any_method() {
  const HeavyTopParameters p = slow_top();
  const S system(p);
  const HeavyTopMotion motion(p, 0.2);
  for (const MethodCase<S>& method : every_method<S>())
    expect_no_allocation(system, *method.stepper(system), motion, method.text());
}

TEST(EveryMethod, AllocatesNothingInDouble) {
  expect_no_allocation_of_any_method<HeavyTopSO3<double>>();
  expect_no_allocation_of_any_method<HeavyTopR3xSO3<double>>();
}

// All closures and forms are instantiated in double; the scalar is another matter.
template <int k, class S>
void expect_no_allocation_of_bliedf2nd() {
  const HeavyTopParameters p = slow_top();
  const S system(p);
  const HeavyTopMotion motion(p, 0.2);
  for (const bool modified : {false, true}) {
    HeldStepper stepper(BLieDF2nd::Stepper<S>(
        system, BLieDF2nd::Options{.k = k, .modified_start = modified && S::constraints > 0}));
    expect_no_allocation<S>(system, stepper, motion, "BLieDF2nd");
  }
}

TEST(BLieDF2nd, AllocatesNothingInExtendedPrecision) {
  const auto check = []<class S>(const S*) {
    expect_no_allocation_of_bliedf2nd<1, S>();
    expect_no_allocation_of_bliedf2nd<2, S>();
    expect_no_allocation_of_bliedf2nd<3, S>();
    expect_no_allocation_of_bliedf2nd<4, S>();
  };
  check(static_cast<const HeavyTopSO3<Extended>*>(nullptr));
  check(static_cast<const HeavyTopR3xSO3<Extended>*>(nullptr));
}

}  // namespace
}  // namespace liebench
