#include "harness/stability/case.h"

#include <gtest/gtest.h>

#include <array>

namespace liebench {
namespace {

TEST(StabilityVerdict, SaysOnWhichSideOfTheTheoryAGradeIs) {
  using enum Grade;
  EXPECT_EQ(verdict(survived, survived, survived), Verdict::passed);
  EXPECT_EQ(verdict(degraded, degraded, degraded), Verdict::degraded);
  EXPECT_EQ(verdict(failed, failed, failed), Verdict::failed_as_expected);
  EXPECT_EQ(verdict(degraded, survived, survived), Verdict::failed_unexpectedly);
  EXPECT_EQ(verdict(failed, degraded, degraded), Verdict::failed_unexpectedly);
  EXPECT_EQ(verdict(survived, failed, failed), Verdict::passed_unexpectedly);
  EXPECT_EQ(verdict(degraded, failed, failed), Verdict::passed_unexpectedly);
}

TEST(StabilityVerdict, BetweenTwoGradesThatTheoryAllowsNothingSurprises) {
  using enum Grade;
  for (const Grade found : {survived, degraded, failed})
    EXPECT_FALSE(surprise(verdict(found, survived, failed)));
  EXPECT_TRUE(surprise(verdict(failed, survived, degraded)));
  EXPECT_TRUE(surprise(verdict(survived, degraded, failed)));
}

TEST(StabilityVerdict, TheWorstOfSeveralIsTheOneThatAUserMustKnow) {
  constexpr std::array order{Verdict::passed, Verdict::degraded, Verdict::failed_as_expected,
                             Verdict::passed_unexpectedly, Verdict::failed_unexpectedly};
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = 0; j < order.size(); ++j)
      EXPECT_EQ(worst(order[i], order[j]), order[std::max(i, j)]);
}

TEST(StabilityVerdict, ARunThatIsCalledOkWithANaNHasFailed) {
  const Finding finding = finding_of({.outcome = Outcome::ok, .failure = {}, .reached = 7, .finite = false});
  EXPECT_EQ(finding.grade, Grade::failed);
  EXPECT_EQ(finding.outcome, Outcome::non_finite);
}

}  // namespace
}  // namespace liebench
