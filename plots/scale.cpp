#include "plots/scale.h"

#include <cmath>

namespace liebench {

bool on_axis(double value, bool logarithmic) {
  return std::isfinite(value) && (!logarithmic || value > 0);
}

double to_axis(double value, bool logarithmic) {
  return logarithmic ? std::log10(value) : value;
}

double from_axis(double value, bool logarithmic) {
  return logarithmic ? std::pow(10.0, value) : value;
}

double Positions::operator()(double value) const {
  return (to_axis(value, logarithmic) - lower) / span * length;
}

Positions Scale::positions() const {
  const double lower = to_axis(range.lower, logarithmic);
  return {lower, to_axis(range.upper, logarithmic) - lower, logarithmic, length};
}

double Scale::position(double value) const {
  return positions()(value);
}

double Scale::value(double position) const {
  const double lower = to_axis(range.lower, logarithmic);
  return from_axis(lower + position / length * (to_axis(range.upper, logarithmic) - lower), logarithmic);
}

double Scale::points_per_unit() const {
  return length / (to_axis(range.upper, logarithmic) - to_axis(range.lower, logarithmic));
}

}  // namespace liebench
