#include "tests/integrators/shared_steppers.h"
#include "tests/support/method_laws.h"

namespace liebench {

template StepperMaker<BLieDF2nd, HeavyTopR3xSO3<double>>
    make_stepper<BLieDF2nd, HeavyTopR3xSO3<double>, NoAudit>;
template StepperMaker<FaltinsenBdf, HeavyTopR3xSO3<double>>
    make_stepper<FaltinsenBdf, HeavyTopR3xSO3<double>, NoAudit>;

using Formulations = ::testing::Types<HeavyTopR3xSO3<double>>;
INSTANTIATE_TYPED_TEST_SUITE_P(R3xSO3, MethodLaws, Formulations);

}  // namespace liebench
