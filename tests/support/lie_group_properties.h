#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "groups/extended.h"
#include "groups/lie_group.h"
#include "tests/support/any_group.h"
#include "tests/support/lie_group_samples.h"

// Property tests of a Lie group of the concept of groups/lie_group.h: the axioms, exp and log, ad, the tangent operator against
// analysis, differences and Jets, and what keeps an element in the group. A new group joins with
//
//   const bool tested = test_lie_group<SE3<double>>("SE3") && test_lie_group<SE3<Extended>>("SE3Extended");
//
// and, where it has delicate places or several representations of an element, with a specialisation of LieGroupExamples
// (lie_group_examples.h). Scalars: double and Extended. Of the group's other scalars the suite asks for
// ceres::Jet<double, m> and for double.

namespace liebench {

template <class T>
struct Property {
  std::string_view name;
  void (*check)(const GroupSamples<T>& samples);
};

// The axioms and the Lie algebra; exp, log, distances and casts; the tangent operator and what elements represent. Compiled once
// for a scalar.
template <class T>
std::vector<Property<T>> group_properties();
template <class T>
std::vector<Property<T>> exponential_properties();
template <class T>
std::vector<Property<T>> tangent_properties();

template <class T>
class PropertyTest final : public ::testing::Test {
 public:
  PropertyTest(const AnyGroup<T>& group, const Property<T>& property)
      : samples_(group), property_(property) {}
  void TestBody() override { property_.check(samples_); }

 private:
  GroupSamples<T> samples_;
  Property<T> property_;
};

template <class T>
bool test_group(const std::string& name, const AnyGroup<T>& group) {
  for (const auto& properties : {group_properties<T>(), exponential_properties<T>(), tangent_properties<T>()})
    for (const Property<T>& property : properties)
      ::testing::RegisterTest((name + "/LieGroupProperties").c_str(), std::string(property.name).c_str(),
                              nullptr, nullptr, __FILE__, __LINE__, [&group, property]() -> ::testing::Test* {
                                return new PropertyTest<T>(group, property);
                              });
  return true;
}

// True, so that a namespace's constant can call it.
template <LieGroup G>
bool test_lie_group(const std::string& name) {
  return test_group(name, any_group<G>());
}

}  // namespace liebench
