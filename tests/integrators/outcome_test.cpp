#include "integrators/outcome.h"

#include <gtest/gtest.h>

#include <set>
#include <string_view>

namespace liebench::outcome_test {
namespace {

TEST(Outcome, EveryOutcomeHasItsOwnName) {
  std::set<std::string_view> names;
  const int last = int(Outcome::step_limit);
  for (int i = 0; i <= last; ++i) {
    const std::string_view text = name(static_cast<Outcome>(i));
    EXPECT_NE(text, "unknown") << i;
    names.insert(text);
  }
  EXPECT_EQ(names.size(), std::size_t(last + 1));
}

TEST(Outcome, AStepIsFineUnlessItSaysOtherwise) {
  EXPECT_EQ(StepResult{}.outcome, Outcome::ok);
  EXPECT_EQ(name(Outcome::ok), "ok");
}

}  // namespace
}  // namespace liebench::outcome_test
