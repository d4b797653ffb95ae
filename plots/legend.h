#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "plots/figure.h"
#include "plots/scale.h"
#include "plots/style.h"

namespace liebench {

// In points.
constexpr double legend_row = 15;
constexpr double legend_sample = 28;

struct LegendEntry {
  Look look;
  std::string label;
};

/// Filled column by column.
struct Legend {
  std::vector<LegendEntry> entries = {};
  std::size_t rows = 1;

  double height() const;
  double width() const;
  std::vector<double> column_widths() const;
};

/// The legend of the panels, as wide as it may be.
Legend legend_of(std::span<const Panel> panels, std::span<const Axes> axes, double width,
                 const std::string& failures_text);

}  // namespace liebench
