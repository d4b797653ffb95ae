#include "tests/support/method_laws.h"

namespace liebench::method_laws_r3xso3_test {

using Formulations = ::testing::Types<HeavyTopR3xSO3<double>>;
INSTANTIATE_TYPED_TEST_SUITE_P(R3xSO3, MethodLaws, Formulations);

}  // namespace liebench::method_laws_r3xso3_test
