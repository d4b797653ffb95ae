#include "harness/step_operations.h"

#include <fmt/format.h>

#include <stdexcept>

#include "integrators/dense_lu.h"
#include "integrators/step_equation.h"
#include "problems/heavy_top.h"

namespace liebench {

namespace {

template <class Work>
Operations operations_of(const Work& work) {
  const Operations before = Counted::operations();
  work();
  return Counted::operations() - before;
}

// At the initial state, with a step of 1e-4 s: below the angle where exp and T take sines and square roots.
template <template <class> class System, Form form>
StepOperations count() {
  using S = System<Counted>;
  using Equation = StepEquation<S, form>;
  using Lu = DenseLu<Counted, Equation::n>;
  const S system{HeavyTopParameters{}};
  const Counted h = 1e-4;
  const Velocity<S> v = system.initial_velocity();
  const AffineClosure<S> closure{.base_increment = v,
                                 .velocity = v,
                                 .velocity_slope = 1.5,
                                 .velocity_change = Counted(0.0) * v,
                                 .acceleration_slope = 2.25,
                                 .scaled_acceleration = Counted(0.0) * v};
  const Configuration<S> q_n = system.initial_configuration();
  typename Equation::Unknowns z = Equation::Unknowns::Constant(Counted(1e-3));
  typename Equation::Point point;
  StepOperations operations;
  typename Equation::Unknowns r;
  operations.residual = operations_of([&] {
    Equation::evaluate(system, h, q_n, closure, z, point);
    Equation::residual(system, 0.0, h, point, z, r);
  });
  typename Lu::Matrix J;
  operations.jacobian = operations_of([&] {
    Equation::jacobian(system, 0.0, h, q_n, point, z, ClosureDerivatives<Counted>{1.5, 2.25}, J);
  });
  Lu lu;
  operations.factorization = operations_of([&] { lu.factorize(J); });
  operations.solve = operations_of([&] { r = lu.solve(r); });
  return operations;
}

template <template <class> class System>
StepOperations count(std::string_view form) {
  if constexpr (System<double>::constraints > 0)
    if (form == "stabilized_index2") return count<System, Form::stabilized_index2>();
  return count<System, Form::index3>();
}

}  // namespace

StepOperations step_operations(std::string_view formulation, std::string_view form) {
  if (formulation == HeavyTopSO3<double>::formulation) return count<HeavyTopSO3>(form);
  if (formulation == HeavyTopS3<double>::formulation) return count<HeavyTopS3>(form);
  if (formulation == HeavyTopR3xSO3<double>::formulation) return count<HeavyTopR3xSO3>(form);
  if (formulation == HeavyTopR3xS3<double>::formulation) return count<HeavyTopR3xS3>(form);
  if (formulation == HeavyTopSE3<double>::formulation) return count<HeavyTopSE3>(form);
  if (formulation == HeavyTopS3R3<double>::formulation) return count<HeavyTopS3R3>(form);
  if (formulation == HeavyTopUDQ<double>::formulation) return count<HeavyTopUDQ>(form);
  throw std::invalid_argument(fmt::format("no formulation of the heavy top is named \"{}\"", formulation));
}

}  // namespace liebench
