#include "harness/step_operations.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "harness/problems.h"

namespace liebench {
namespace {

TEST(StepOperations, KnowEveryFormulation) {
  for (const FormulationInfo& info : heavy_top_info().formulations)
    for (const char* form : {"index3", "stabilized_index2"}) {
      const StepOperations operations = step_operations(info.name, form);
      EXPECT_GT(operations.residual.total(), 0u) << info.name;
      EXPECT_GT(operations.jacobian.total(), operations.residual.total()) << info.name;
    }
  EXPECT_THROW(step_operations("SO2", "index3"), std::invalid_argument);
}

// n (n - 1) multiplications and additions each, n multiplications by inverse pivots.
TEST(StepOperations, ABackSubstitutionTakesWhatItsSizeSays) {
  const auto expected = [](std::uint64_t n) { return 2 * n * (n - 1) + n; };
  EXPECT_EQ(step_operations("SO3", "").solve.total(), expected(3));
  EXPECT_EQ(step_operations("R3xSO3", "index3").solve.total(), expected(9));
  EXPECT_EQ(step_operations("UDQ", "stabilized_index2").solve.total(), expected(12));
}

TEST(StepOperations, TheStabilizedFormCostsMore) {
  for (const char* name : {"R3xSO3", "R3xS3", "SE3", "S3|xR3", "UDQ"}) {
    const StepOperations plain = step_operations(name, "index3"),
                         stabilized = step_operations(name, "stabilized_index2");
    EXPECT_GT(stabilized.residual.total(), plain.residual.total()) << name;
    EXPECT_GT(stabilized.factorization.total(), plain.factorization.total()) << name;
  }
}

TEST(StepOperations, AreTheSameEveryTime) {
  EXPECT_EQ(step_operations("SE3", "index3").residual.total(),
            step_operations("SE3", "index3").residual.total());
}

}  // namespace
}  // namespace liebench
