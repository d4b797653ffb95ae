#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "groups/extended.h"
#include "harness/references/heavy_top_taylor.h"
#include "harness/references/reference_cache.h"
#include "problems/heavy_top_parameters.h"

namespace liebench {

struct HeavyTopState {
  Eigen::Matrix<Extended, 4, 1> orientation;  // unit quaternion (w, x, y, z) of R
  Eigen::Matrix<Extended, 3, 3> R;            // body to inertial frame
  Eigen::Matrix<Extended, 3, 1> omega;        // body frame [rad/s]
  Eigen::Matrix<Extended, 3, 1> omega_dot;    // body frame [rad/s^2], by the equations of motion
  Extended t;                                 // [s]
};

// The motion of the heavy top, any inertia and any initial state, to about 31 digits over [0, t_end +
// margin].
//
// It comes from heavy_top_by_taylor and has two witnesses: heavy_top_by_extrapolation always,
// HeavyTopClosedForm where it holds. The initial state and the parameters are the shortest decimals of their
// doubles (groups/decimal.h); a run in double starts from the doubles themselves, a distance of 1e-16 that is
// the run's own error.
class HeavyTopReference {
 public:
  // [s] beyond t_end: a few steps of the largest step size that a study of a fast motion has use for.
  static constexpr double default_margin = 0.05;

  // Computes it: about 1 s on one core for the fast top and t_end = 2 s.
  // Throws std::invalid_argument for bad parameters (not finite, a zero quaternion, an inertia about the tip
  // that is not symmetric positive definite), for a t_end that is not positive and finite, for a negative
  // margin; std::runtime_error when the witnesses disagree by more than 1e-25 (a chaotic motion over a long
  // time).
  HeavyTopReference(const HeavyTopParameters& parameters, double t_end, double margin = default_margin);

  // The same from the cache, or computed and put there.
  static HeavyTopReference load_or_build(const HeavyTopParameters& parameters, double t_end,
                                         const ReferenceCache& cache, const MessageCallback& message = {},
                                         double margin = default_margin);

  // The state at t. Safe to call from several threads; about 1 us, and a tenth of it where this thread has asked for the same
  // time not long ago: runs of many methods on one grid do.
  // Throws std::out_of_range unless 0 <= t <= t_end() + margin().
  HeavyTopState at(const Extended& t) const;

  // Of R (Frobenius norm, relative) and of Omega (2-norm, relative to the largest |Omega| of the times looked
  // at, or to the frequency of the body as a pendulum where that is more): the largest difference between the
  // stored solution and a witness at eight times and at both ends, or between two of its pieces where they
  // meet, plus 1e-31 for the rounding of the stored coefficients and of their evaluation.
  double error_estimate() const { return error_estimate_; }

  // One sentence: the method and its witnesses.
  const std::string& method() const { return method_; }

  const HeavyTopParameters& parameters() const { return parameters_; }
  double t_end() const { return t_end_; }
  double margin() const { return margin_; }

 private:
  struct Prepared {};
  HeavyTopReference(Prepared, const HeavyTopParameters& parameters, double t_end, double margin);

  HeavyTopState computed_at(const Extended& t) const;
  void compute();
  std::string to_payload() const;
  void from_payload(const std::string& payload);

  std::uint64_t identity_;  // of this solution: copies share it
  HeavyTopParameters parameters_;
  double t_end_ = 0;
  double margin_ = 0;
  Eigen::Matrix<Extended, 3, 3> inertia_;          // J_fix
  Eigen::Matrix<Extended, 3, 3> inertia_inverse_;  // J_fix^{-1}
  Eigen::Matrix<Extended, 3, 1> first_moment_;     // m X
  Eigen::Matrix<Extended, 3, 1> gravity_;          // inertial frame
  HeavyTopTrajectory trajectory_;
  double error_estimate_ = 0;
  std::string method_;
};

}  // namespace liebench
