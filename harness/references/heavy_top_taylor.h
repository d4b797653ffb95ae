#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "groups/extended.h"
#include "problems/heavy_top_parameters.h"

namespace liebench {

// The motion of the heavy top as a piecewise polynomial in time with values in (unit quaternion, Omega), in
// double-double.
//
// Piece i is the Taylor polynomial about its node t_i in s = (t - t_i) / width_i, width_i a power of two.
// Coefficients of degree below `exact_degrees` are double-doubles; above, the terms are below 2e-17 of the
// sum, so that doubles hold them to the same absolute accuracy at a fraction of the cost.
class HeavyTopTrajectory {
 public:
  static constexpr std::size_t degree = 22;
  static constexpr std::size_t exact_degrees = 13;
  static constexpr std::size_t components = 7;  // quaternion w, x, y, z and Omega 1, 2, 3

  struct Piece {
    double begin = 0;          // first time that this piece answers for
    double node = 0;           // t_i
    double inverse_width = 1;  // 1 / width_i
    std::array<std::array<Extended, components>, exact_degrees> low;
    std::array<std::array<double, components>, degree + 1 - exact_degrees> high;
  };

  using Values = std::array<Extended, components>;

  HeavyTopTrajectory() = default;
  HeavyTopTrajectory(std::vector<Piece> pieces, double end);

  // The quaternion (w, x, y, z; of length 1 to rounding) and Omega (body frame [rad/s]) at t.
  // Throws std::out_of_range unless 0 <= t <= end(). Safe to call from several threads.
  Values at(const Extended& t) const;

  double end() const { return end_; }
  std::span<const Piece> pieces() const { return pieces_; }

  // The largest jump between neighbouring pieces where they meet, of the quaternion and of Omega /
  // omega_scale: truncation and rounding of the stored polynomials, seen without any other witness.
  // omega_scale [rad/s] > 0.
  double largest_jump(double omega_scale) const;

 private:
  static Values evaluate(const Piece& piece, const Extended& t);

  std::vector<double> begins_;  // of the pieces, once more: a search through them stays in the cache
  std::vector<Piece> pieces_;
  double end_ = 0;
};

// Integrates the heavy top over [0, end] by its Taylor series, in 50-digit arithmetic, on
//
//   p' = 1/2 p (0, Omega),   Gamma' = Gamma x Omega,   J_fix Omega' = (J_fix Omega) x Omega + m X x Gamma,
//
// p the unit quaternion of R and Gamma = R^T gamma: all quadratic, so that the coefficients follow from
// Cauchy products (Moore 1966; Jorba & Zou 2005). Order 34; the step is the largest at which the terms of the
// last two orders stay below 1e-40, and the stored polynomials of two neighbouring nodes meet with a
// truncation below 1e-33.
//
// Throws std::invalid_argument for bad parameters (see HeavyTopWideData) or an `end` that is not positive and
// finite; std::runtime_error when 10^6 steps do not reach the end.
HeavyTopTrajectory heavy_top_by_taylor(const HeavyTopParameters& parameters, double end);

}  // namespace liebench
