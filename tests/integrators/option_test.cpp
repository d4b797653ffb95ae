#include "integrators/option.h"

#include <gtest/gtest.h>

#include <string>

namespace liebench::option_test {
namespace {

TEST(OptionValues, GiveBackWhatWasSet) {
  OptionValues values;
  values.set("k", 3);
  values.set("rho", 0.9);
  values.set("correction", true);
  values.set("form", std::string("index3"));
  EXPECT_EQ(values.integer("k"), 3);
  EXPECT_EQ(values.real("rho"), 0.9);
  EXPECT_TRUE(values.boolean("correction"));
  EXPECT_EQ(values.choice("form"), "index3");
  EXPECT_EQ(values.all().size(), 4u);
}

TEST(OptionValues, KeepTheLastValueSet) {
  OptionValues values;
  values.set("k", 3);
  values.set("k", 4);
  EXPECT_EQ(values.integer("k"), 4);
  EXPECT_EQ(values.all().size(), 1u);
}

}  // namespace
}  // namespace liebench::option_test
