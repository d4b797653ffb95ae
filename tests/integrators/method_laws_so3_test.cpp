#include "tests/support/method_laws.h"

namespace liebench::method_laws_so3_test {

using Formulations = ::testing::Types<HeavyTopSO3<double>>;
INSTANTIATE_TYPED_TEST_SUITE_P(SO3, MethodLaws, Formulations);

}  // namespace liebench::method_laws_so3_test
