#pragma once

#include <vector>

namespace liebench {

// How a deviation grows in time: |d(t)| ~ t^p of its largest value so far, fitted in logarithms over the last nine tenths of the run.
struct GrowthLaw {
  double exponent = 0.0;  // p; 0 where it does not grow
  double largest = 0.0;
};

// Deviations at equidistant times, the first at the first of them; a deviation below `floor` counts as floor.
GrowthLaw growth_law(const std::vector<double>& deviations, double floor);

}  // namespace liebench
