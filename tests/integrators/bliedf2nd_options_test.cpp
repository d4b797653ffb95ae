#include <gtest/gtest.h>

#include <string>

#include "integrators/bliedf2nd.h"
#include "problems/heavy_top.h"
#include "tests/support/steppers.h"

namespace liebench::bliedf2nd_options_test {
namespace {

constexpr int most_steps = 6;

TEST(BLieDF2nd, OptionListHasTheDefaultsOfTheOptions) {
  const BLieDF2nd::Options defaults;
  for (const OptionInfo& info : BLieDF2nd::option_list) {
    if (info.name == "k") {
      EXPECT_EQ(info.fallback, defaults.k);
      EXPECT_EQ(info.least, 1);
      EXPECT_EQ(info.most, most_steps);
    }
    if (info.name == "correction") {
      EXPECT_EQ(info.fallback != 0, defaults.correction == Correction::explicit_term);
    }
    if (info.name == "modified_start") {
      EXPECT_EQ(info.fallback != 0, defaults.modified_start);
    }
    EXPECT_FALSE(info.meaning.empty()) << info.name;
  }
}

TEST(BLieDF2nd, OptionsSelectTheStepper) {
  const HeavyTopSO3<double> system{HeavyTopParameters{}};
  const auto with = [](int k, const OptionValue& correction) {
    OptionValues values;
    values.set("k", k);
    values.set("correction", correction);
    values.set("modified_start", true);
    values.set("form", std::string("stabilized_index2"));
    return BLieDF2nd::options(values);
  };
  for (int k = 1; k <= most_steps; ++k) {
    const BLieDF2nd::Options options = with(k, false);
    EXPECT_EQ(options.k, k);
    EXPECT_EQ(options.correction, Correction::none);
    EXPECT_EQ(with(k, true).correction, Correction::explicit_term);
    EXPECT_EQ(with(k, std::string("implicit")).correction, Correction::implicit_term);
    EXPECT_TRUE(options.modified_start);
    EXPECT_EQ(options.form, Form::stabilized_index2);
    EXPECT_EQ((make_stepper<BLieDF2nd, HeavyTopSO3<double>>(options, system)->steps()), k);
  }
}

TEST(BLieDF2nd, OptionsThatMeanNothingWithoutConstraintsMayBeAbsent) {
  OptionValues values;
  values.set("k", 3);
  values.set("correction", true);
  const BLieDF2nd::Options options = BLieDF2nd::options(values);
  EXPECT_FALSE(options.modified_start);
  EXPECT_EQ(options.form, Form::index3);
}

}  // namespace
}  // namespace liebench::bliedf2nd_options_test
