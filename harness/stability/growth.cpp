#include "harness/stability/growth.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace liebench {

GrowthLaw growth_law(const std::vector<double>& deviations, double floor) {
  GrowthLaw law;
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    law.largest = std::max(law.largest, deviations[i]);
    if (10 * (i + 1) < deviations.size()) continue;
    const double x = std::log(double(i + 1)), y = std::log(std::max(law.largest, floor));
    n += 1.0;
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  if (n > 1.0) law.exponent = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  return law;
}

}  // namespace liebench
