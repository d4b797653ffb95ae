#include <fmt/format.h>

#include <optional>
#include <stdexcept>
#include <tuple>

#include "harness/instances/heavy_top_steppers.h"
#include "harness/instances/linear_oscillator_steppers.h"
#include "harness/instances/scene_steppers.h"
#include "harness/run_method.h"
#include "integrators/any_stepper.h"
#include "problems/list.h"

// What of the runs knows the whole list of methods: the only file of these that a new method compiles again.

namespace liebench {

template StepperMaker<HeavyTopSO3<double>> new_stepper;
template StepperMaker<HeavyTopS3<double>> new_stepper;
template StepperMaker<HeavyTopR3xSO3<double>> new_stepper;
template StepperMaker<HeavyTopR3xS3<double>> new_stepper;
template StepperMaker<HeavyTopSE3<double>> new_stepper;
template StepperMaker<HeavyTopS3R3<double>> new_stepper;
template StepperMaker<HeavyTopUDQ<double>> new_stepper;
template StepperMaker<LinearOscillator<double>> new_stepper;
template StepperMaker<SmallScene> new_stepper;
template StepperMaker<Scene> new_stepper;
template StepperMaker<RunTimeSystem<Extended>> new_stepper;
template StepperMaker<RunTimeSystem<Counted>> new_stepper;

namespace {

template <template <class> class... Systems>
auto new_steppers(SystemList<Systems...>) {
  return std::tuple{&new_stepper<Systems<double>>...};
}
[[gnu::used]] const auto of_listed_problems = new_steppers(ListedSystems{});

}  // namespace

namespace detail {

MethodOptions options_of(const RunRequest& request) {
  std::optional<MethodOptions> options;
  [&]<class... Methods>(IntegratorList<Methods...>) {
    const auto attempt = [&]<class Method>(IntegratorList<Method>) {
      if (Method::name == request.integrator) options = Method::options(request.options);
    };
    (attempt(IntegratorList<Methods>{}), ...);
  }(Integrators{});
  if (!options)
    throw std::logic_error(fmt::format("integrator \"{}\" is not in the list", request.integrator));
  return *options;
}

}  // namespace detail

}  // namespace liebench
