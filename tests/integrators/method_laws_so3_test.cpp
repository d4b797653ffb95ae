#include "tests/support/listed_methods.h"

namespace liebench::method_laws_so3_test {

using Formulations = ::testing::Types<HeavyTopSO3<double>, ExtendedSO3>;
INSTANTIATE_TYPED_TEST_SUITE_P(SO3, ListedMethods, Formulations);
using InDouble = ::testing::Types<HeavyTopSO3<double>>;
INSTANTIATE_TYPED_TEST_SUITE_P(SO3, ListedMethodsInDouble, InDouble);
using InExtendedPrecision = ::testing::Types<ExtendedSO3>;
INSTANTIATE_TYPED_TEST_SUITE_P(SO3, ListedMethodsInExtendedPrecision, InExtendedPrecision);

}  // namespace liebench::method_laws_so3_test
