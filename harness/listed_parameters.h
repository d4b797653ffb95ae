#pragma once

#include <algorithm>
#include <cstddef>

#include "harness/listed_system.h"
#include "problems/list.h"

namespace liebench::detail {

// The parameters of a listed system from their numbers.
template <template <class> class System>
auto parameters_of(const ParameterNumbers& numbers) {
  typename System<double>::Parameters parameters;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    std::copy(numbers[i].begin(), numbers[i].end(),
              System<double>::parameter_list[i].numbers(parameters).begin());
  return parameters;
}

}  // namespace liebench::detail
