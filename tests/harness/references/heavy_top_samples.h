#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <string_view>

#include "harness/references/heavy_top_wide.h"
#include "problems/heavy_top_parameters.h"

// Data and comparisons that the tests of the heavy top's references share.

namespace liebench {

// A number agrees with a printed one if it is within one unit of the last printed digit (rounded or cut off).
inline void expect_printed(const Wide& value, std::string_view printed) {
  const std::size_t point = printed.find('.');
  const int decimals = point == std::string_view::npos ? 0 : static_cast<int>(printed.size() - point - 1);
  EXPECT_LE(abs(value - Wide(std::string(printed))), pow(Wide(10), -decimals))
      << value.str(40) << " is not " << printed;
}

// The largest difference of an entry of R or of Omega / |Omega|.
inline double difference(const HeavyTopWitness& a, const HeavyTopWitness& b) {
  double largest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      largest = std::max(largest, std::abs(Wide(a.R[i][j] - b.R[i][j]).convert_to<double>()));
    }
    largest = std::max(largest, std::abs(Wide(a.omega[i] - b.omega[i]).convert_to<double>()) / norm(b.omega));
  }
  return largest;
}

// No symmetry whatsoever, all products of inertia present.
inline HeavyTopParameters unsymmetric_top() {
  HeavyTopParameters p;
  p.mass = 3;
  p.inertia = {{{0.3, 0.02, -0.05}, {0.02, 0.5, 0.01}, {-0.05, 0.01, 0.4}}};
  p.center_of_mass = {0.3, 0.8, -0.2};
  p.gravity = {1.5, -2.5, -9.3};
  p.angular_velocity = {1.3, 11.7, -4.1};
  p.orientation = {0.3, -0.5, 0.7, 0.2};
  return p;
}

// Lagrange's top with an oblique axis, gravity and start.
inline HeavyTopParameters oblique_top() {
  HeavyTopParameters p;
  p.center_of_mass = {0.6, 0, -0.8};
  p.inertia = {{{0.25, 0, 0}, {0, 0.25, 0}, {0, 0, 0.25}}};
  p.gravity = {1, -2, 5};
  p.angular_velocity = {-1, 4, 9};
  p.orientation = {0.3, -0.5, 0.7, 0.2};
  return p;
}

// the design notes, section 7.3; J_fix = diag(2, 2, 1).
inline HeavyTopParameters kovalevskaya_top() {
  HeavyTopParameters p;
  p.mass = 1;
  p.inertia = {{{2, 0, 0}, {0, 1, 0}, {0, 0, 0}}};
  p.center_of_mass = {1, 0, 0};
  p.gravity = {0, 0, -1};
  p.angular_velocity = {0.5, 1, 2};
  return p;
}

// the design notes, section 7.2: Euler's top started beside its unstable middle axis.
inline HeavyTopParameters free_body() {
  HeavyTopParameters p;
  p.inertia = {{{1, 0, 0}, {0, 2, 0}, {0, 0, 3}}};
  p.center_of_mass = {0, 0, 0};
  p.angular_velocity = {0.01, 5, 0.01};
  return p;
}

// 1/2 Omega . J_fix Omega - m X . R^T gamma
inline Wide energy(const HeavyTopParameters& p, const HeavyTopWitness& s) {
  const HeavyTopWideData data(p);
  return dot(s.omega, multiply(data.inertia, s.omega)) / 2 -
         dot(data.first_moment, multiply(transposed(s.R), data.gravity));
}

// R J_fix Omega, inertial frame
inline WideVector angular_momentum(const HeavyTopParameters& p, const HeavyTopWitness& s) {
  return multiply(s.R, multiply(HeavyTopWideData(p).inertia, s.omega));
}

}  // namespace liebench
