#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/method_laws.h"

namespace liebench {

// The law of time reversal on a formulation on which not every listed method runs (tests/support/listed_methods.h).
template <class Method, MechanicalSystem S>
void expect_time_reversal(const OptionValues& values = {}) {
  ASSERT_TRUE(is_symmetric<Method>(values));
  std::vector<BrokenLaw> broken;
  const auto maker = [&](const S& system) {
    return make_stepper<Method, S>(Method::options(values), system);
  };
  MethodLaws<S>::time_reversal(method_case<Method, S>(values, maker), broken);
  for (const BrokenLaw& each : broken) ADD_FAILURE() << text(std::string(Method::name), each);
}

}  // namespace liebench
