#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace liebench {

// Of at least one value; of an even number the mean of the middle two.
inline double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return values.size() % 2 == 1 ? *middle : (*std::max_element(values.begin(), middle) + *middle) / 2;
}

}  // namespace liebench
