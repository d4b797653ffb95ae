#include "tests/integrators/shared_steppers.h"
#include "tests/support/method_laws.h"

namespace liebench {

template StepperMaker<BLieDF2nd, HeavyTopSO3<double>> make_stepper<BLieDF2nd, HeavyTopSO3<double>, NoAudit>;
template StepperMaker<FaltinsenBdf, HeavyTopSO3<double>>
    make_stepper<FaltinsenBdf, HeavyTopSO3<double>, NoAudit>;

using Formulations = ::testing::Types<HeavyTopSO3<double>>;
INSTANTIATE_TYPED_TEST_SUITE_P(SO3, MethodLaws, Formulations);

}  // namespace liebench
