#include "plots/text.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace liebench {
namespace {

using Lines = std::vector<std::string>;

TEST(FittedTextTest, StaysOnOneLineWhereItFits) {
  const FittedText text = fit("error of λ at t_{end} in N", 172);
  EXPECT_EQ(text.lines, Lines{"error of λ at t_{end} in N"});
  EXPECT_EQ(text.size, font_size);
}

TEST(FittedTextTest, BreaksBehindACommaElseInTheMiddle) {
  EXPECT_EQ(fit("max error of λ in N, over all steps", 172).lines,
            (Lines{"max error of λ in N,", "over all steps"}));
  EXPECT_EQ(fit("residual of the constraint after one step", 172).lines,
            (Lines{"residual of the", "constraint after one step"}));
  // A comma that leaves a line too long is no place to break.
  EXPECT_EQ(fit("max, relative error of the rotation in rad", 172).lines,
            (Lines{"max, relative error", "of the rotation in rad"}));
}

TEST(FittedTextTest, FortyFiveLettersNeedNoSmallerFont) {
  const FittedText text = fit("relative error of the multiplier λ, last step", 172);
  EXPECT_EQ(text.lines.size(), 2U);
  EXPECT_EQ(text.size, font_size);
}

TEST(FittedTextTest, DoesNotBreakWhatBracesHoldTogether) {
  const FittedText text = fit("{/:Italic a b c d e f g h i j k l} m", 100);
  EXPECT_EQ(text.lines, (Lines{"{/:Italic a b c d e f g h i j k l}", "m"}));
  // These braces are letters.
  EXPECT_EQ(fit("abcdefgh\\{ ijklmnop\\}", 80).lines, (Lines{"abcdefgh\\{", "ijklmnop\\}"}));
}

TEST(FittedTextTest, ShrinksWhatTwoLinesDoNotHold) {
  const FittedText text = fit("Donaudampfschifffahrtsgesellschaft in m", 172);
  EXPECT_EQ(text.lines, (Lines{"Donaudampfschifffahrtsgesellschaft", "in m"}));
  EXPECT_LT(text.size, font_size);
  EXPECT_GT(text.size, 8);
}

}  // namespace
}  // namespace liebench
