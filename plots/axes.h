#pragma once

#include <string>
#include <vector>

#include "plots/figure.h"
#include "plots/scale.h"

namespace liebench {

/// The axes of all panels, with ranges that show all of the data.
std::vector<Axes> axes_of(const Figure& figure, PlotArea area);

/// Tick marks of a logarithmic axis: labels no denser than `spacing` points, small ticks between.
std::string logarithmic_ticks(const Scale& scale, double spacing);

}  // namespace liebench
