#include "harness/methods.h"

#include <gtest/gtest.h>

#include <set>

#include "harness/errors.h"

namespace liebench {
namespace {

TEST(Methods, HaveNamesOfTheirOwnAndSayWhatTheyAre) {
  std::set<std::string_view> names;
  for (const MethodInfo& method : methods()) {
    EXPECT_TRUE(names.insert(method.name).second) << method.name;
    EXPECT_FALSE(method.summary.empty()) << method.name;
    for (const OptionInfo& option : method.options) {
      EXPECT_FALSE(option.meaning.empty()) << method.name << " " << option.name;
      EXPECT_NE(option.name, "name") << "the key of the method's own name";
    }
  }
  EXPECT_TRUE(names.contains("bliedf2nd"));
}

TEST(Methods, EveryDefaultIsAValueThatTheOptionAllows) {
  for (const MethodInfo& method : methods()) {
    OptionValues values;
    for (const OptionInfo& option : method.options) values.set(option.name, option_default(option));
    const Json json = options_to_json(method, values);
    for (const OptionInfo& option : method.options) {
      const std::string name(option.name);
      EXPECT_EQ(option_value(option, JsonView(json, "")[name]), option_default(option))
          << method.name << " " << name;
    }
  }
}

TEST(Methods, OptionsInJsonKeepTheOrderOfTheList) {
  for (const MethodInfo& method : methods()) {
    OptionValues values;
    for (const OptionInfo& option : method.options) values.set(option.name, option_default(option));
    std::vector<std::string> expected, actual;
    for (const OptionInfo& option : method.options) expected.emplace_back(option.name);
    const Json json = options_to_json(method, values);
    for (const auto& item : json.items()) actual.push_back(item.key());
    EXPECT_EQ(actual, expected) << method.name;
  }
}

TEST(OptionValue, LiesInItsRangeEndsIncluded) {
  const OptionInfo k{
      .name = "k", .kind = OptionKind::integer, .fallback = 2, .least = 1, .most = 4, .meaning = "m"};
  const OptionInfo rho{
      .name = "rho_inf", .kind = OptionKind::real, .fallback = 0.9, .least = 0, .most = 1, .meaning = "m"};
  const auto value = [](const OptionInfo& info, const Json& json) {
    return option_value(info, JsonView(json, "/o"));
  };
  EXPECT_EQ(value(k, 1), OptionValue(1));
  EXPECT_EQ(value(k, 4), OptionValue(4));
  EXPECT_THROW(value(k, 0), InputError);
  EXPECT_THROW(value(k, 5), InputError);
  EXPECT_THROW(value(k, 1.5), InputError);
  EXPECT_EQ(value(rho, 0), OptionValue(0.0));
  EXPECT_EQ(value(rho, 1), OptionValue(1.0));
  EXPECT_THROW(value(rho, -1e-300), InputError);
  EXPECT_THROW(value(rho, 1.0000000000000002), InputError);
  EXPECT_EQ(allowed_values(k), "an integer from 1 to 4");
  EXPECT_EQ(allowed_values(rho), "a number from 0 to 1");
}

TEST(OptionValue, OfAChoiceIsOneOfItsWords) {
  const OptionInfo form{.name = "form",
                        .kind = OptionKind::choice,
                        .fallback = 1,
                        .choices = {"index3", "stabilized_index2"},
                        .meaning = "m"};
  const Json good = "stabilized_index2", empty = "", bad = "index2";
  EXPECT_EQ(option_value(form, JsonView(good, "/o")), OptionValue(std::string("stabilized_index2")));
  EXPECT_EQ(option_default(form), OptionValue(std::string("stabilized_index2")));
  EXPECT_THROW(option_value(form, JsonView(bad, "/o")), InputError);
  EXPECT_THROW(option_value(form, JsonView(empty, "/o")), InputError)
      << "an unused place of the list of words";
  EXPECT_EQ(allowed_values(form), "\"index3\" or \"stabilized_index2\"");
}

}  // namespace
}  // namespace liebench
