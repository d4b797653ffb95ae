#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/support/allocation_counter.h"
#include "tests/support/heavy_top_motion.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/method_cases.h"
#include "tests/support/steppers.h"

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

// `length`: of a step, or of the interval of a method that chooses its steps.
template <class S>
void expect_no_allocation(const S& system, AnyStepper<S>& stepper, const HeavyTopMotion& motion,
                          double length, const std::string& text) {
  using T = typename S::Scalar;
  const T h(length);
  std::vector<SolutionPoint<S>> points;
  for (int j = 0; j < stepper.starting_points(); ++j)
    points.push_back(motion.point(system, Extended(h) * double(j)));
  Outcome outcome = Outcome::ok;
  unsigned long allocations = 0;
  {
    const AllocationCounter counter;
    outcome = stepper.start(h, points).outcome;
    // Refreshed factorizations and the rare paths of the stopping rule are among 300 steps.
    if (outcome == Outcome::ok) outcome = stepper.advance(300).outcome;
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
  for (const MethodCase<S>& method : every_method_of_fixed_steps<S>())
    expect_no_allocation(system, *method.stepper(system), motion, 0.005, method.text());  // h |v| = 0.02
  for (const Form form : {Form::index3, Form::stabilized_index2})
    expect_no_allocation(system,
                         *make_stepper<BLieDF2ndVariable, S>({.tolerance = 1e-8, .form = form}, system),
                         motion, 1.0, "bliedf2nd_variable");
  if constexpr (may_fit<RkmkVariable, S>())
    expect_no_allocation(system, *make_stepper<RkmkVariable, S>({.tolerance = 1e-13}, system), motion, 3.0,
                         "rkmk_variable");
}

// Those of the program, where it runs and where it times. What is not in double is vectors of run-time size, which allocate.
TEST(EveryMethod, AllocatesNothingInDouble) {
  expect_no_allocation_of_any_method<HeavyTopSO3<double>>();
  expect_no_allocation_of_any_method<HeavyTopR3xSO3<double>>();
}

}  // namespace
}  // namespace liebench
