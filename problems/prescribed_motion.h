#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "groups/decimal.h"

namespace liebench {

// A prescribed coordinate of a joint as a function of time:
//
//   c(t) = sum_i polynomial_i t^i + sum_j amplitude_j sin(angular_frequency_j t + phase_j)
//
// in m or rad, with its first two derivatives, which the hidden constraints need.
template <class T>
struct PrescribedMotion {
  struct Sine {
    T amplitude, angular_frequency, phase;
  };
  std::vector<T> polynomial;
  std::vector<Sine> sines;

  bool moves() const { return polynomial.size() > 1 || !sines.empty(); }

  template <class U>
  PrescribedMotion<U> cast() const {
    PrescribedMotion<U> result;
    for (const T& c : polynomial) result.polynomial.push_back(decimal<U>(c));
    for (const Sine& s : sines)
      result.sines.push_back({decimal<U>(s.amplitude), decimal<U>(s.angular_frequency), decimal<U>(s.phase)});
    return result;
  }

  // c, c' and c'' at t.
  std::array<T, 3> at(const T& t) const {
    using std::cos;
    using std::sin;
    std::array<T, 3> c{T(0.0), T(0.0), T(0.0)};
    for (std::size_t i = polynomial.size(); i-- > 0;) {
      c[2] = c[2] * t + c[1] * T(2.0);
      c[1] = c[1] * t + c[0];
      c[0] = c[0] * t + polynomial[i];
    }
    for (const Sine& s : sines) {
      const T angle = s.angular_frequency * t + s.phase;
      const T sine = s.amplitude * sin(angle), cosine = s.amplitude * cos(angle);
      c[0] += sine;
      c[1] += s.angular_frequency * cosine;
      c[2] -= s.angular_frequency * s.angular_frequency * sine;
    }
    return c;
  }
};

}  // namespace liebench
