#include "tests/support/listed_methods.h"

namespace liebench::method_laws_r3xso3_test {

using Formulations = ::testing::Types<HeavyTopR3xSO3<double>, ExtendedR3xSO3>;
INSTANTIATE_TYPED_TEST_SUITE_P(R3xSO3, ListedMethods, Formulations);
INSTANTIATE_TYPED_TEST_SUITE_P(R3xSO3, ListedMethodsWithConstraints, Formulations);
using InDouble = ::testing::Types<HeavyTopR3xSO3<double>>;
INSTANTIATE_TYPED_TEST_SUITE_P(R3xSO3, ListedMethodsInDouble, InDouble);
using InExtendedPrecision = ::testing::Types<ExtendedR3xSO3>;
INSTANTIATE_TYPED_TEST_SUITE_P(R3xSO3, ListedMethodsInExtendedPrecision, InExtendedPrecision);

}  // namespace liebench::method_laws_r3xso3_test
