#pragma once

#include <type_traits>

#include "groups/flattened.h"
#include "problems/system.h"

namespace liebench {

// Whether the kernel and the steps inline all that they call: in double and of fixed size, where small matrices in registers pay.
// Not under AddressSanitizer, whose checks would make one function of it that takes minutes to compile.
template <MechanicalSystem S>
inline constexpr bool inlines_all =
    DenseSystem<S>&& std::is_same_v<typename S::Scalar, double> && !detail::sanitized;

// step() with all that it calls inlined, where that pays, but for what is noinline (the solve() of the kernel): what is
// passed through memory stalls the processor.
template <MechanicalSystem S, class Step>
auto inlined_step(const Step& step) {
  if constexpr (inlines_all<S>) {
    return detail::flattened(step);
  } else {
    return step();
  }
}

}  // namespace liebench
