#pragma once

#include <cmath>
#include <string>
#include <utility>

#include "plots/figure.h"

namespace liebench {

/// error = constant h^order + floor at h = 1e-1 ... 1e-6.
inline Series power_law(std::string label, int style, double constant, double order, double floor = 0) {
  Series series{.label = std::move(label), .style = style};
  for (int step = 0; step <= 15; ++step) {
    const double h = std::pow(10.0, -1 - step / 3.0);
    series.points.push_back({h, constant * std::pow(h, order) + floor});
  }
  return series;
}

inline Panel convergence_panel() {
  Panel panel{.title = "with L_k", .x_label = "step size h in s", .y_label = "max error of λ in N"};
  panel.series = {power_law("k = 2", 0, 1e1, 2), power_law("k = 3", 1, 1e2, 3),
                  power_law("k = 4", 2, 1e3, 4)};
  Series double_precision = power_law("k = 4, double", 2, 1e3, 4, 1e-13);
  double_precision.secondary = true;
  panel.series.push_back(double_precision);
  panel.orders = {{.order = 2}, {.order = 3}, {.order = 4}};
  return panel;
}

inline Figure convergence_figure() {
  Figure figure{.title = "Figure", .rows = 1, .columns = 2};
  figure.panels = {convergence_panel(), convergence_panel()};
  return figure;
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace liebench
