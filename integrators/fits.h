#pragma once

#include "integrators/option.h"
#include "problems/system.h"

namespace liebench {

// The systems that a method integrates.
enum class Fits { every_system, without_constraints, with_constraints };

constexpr bool fits(Fits method, bool constrained) {
  return method == Fits::every_system || (method == Fits::with_constraints) == constrained;
}

// Whether a system of the type S may be one of them: of a size known at run time it is known at run time only.
template <class Method, MechanicalSystem S>
constexpr bool may_fit() {
  return S::constraints == run_time_size || fits(Method::fits, S::constraints != 0);
}

// Expected orders of convergence of the global error. Of lambda: that of the end of an interval; docs/theory.md, "Expected orders",
// has the transient phase.
struct ConvergenceOrders {
  int q, v, lambda;
  // Of a method that chooses its steps: the power of h that its error estimate has, and, where it raises its order, that of its first
  // steps; docs/theory.md, "Errors by tolerance".
  int estimate = 0;
  int first_steps = 0;
};

constexpr ConvergenceOrders same_order(int p) {
  return {p, p, p};
}

// Whether a one-step method declares that it is symmetric with these options: so many steps of -h lead back from where as many of h
// have led, but for round-off, where the forces on v are gyroscopic ones. It is not where it says nothing.
template <class Method>
bool is_symmetric(const OptionValues& values) {
  if constexpr (requires { Method::symmetric(values); })
    return Method::symmetric(values);
  else
    return false;
}

// Which constraints hold to round-off at the end of every step.
struct KeptConstraints {
  bool position;  // Phi(t, q) = 0
  bool velocity;  // B(q) v + Phi_t = 0, the hidden one
};

}  // namespace liebench
