#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "groups/extended.h"
#include "integrators/run_time_system.h"
#include "integrators/starting_values.h"

namespace liebench {

// The motion of any system in extended precision: the Runge-Kutta-Munthe-Kaas method of order 6 on the index-1 form with
// projections (integrators/self_start.h), another method than those under test, with N and 2 N steps; the finer one is kept, the
// difference of both is the error estimate. Between its steps polynomials of degree 9 in local canonical coordinates.
class IntegratedReference {
 public:
  using System = RunTimeSystem<Extended>;
  using Point = SolutionPoint<System>;

  struct Options {
    // The largest entry of v with p = q o exp(v~).
    std::function<double(const System::Vector& q, const System::Vector& p)> separation;
    std::uint64_t most_steps = 40000;  // a step of 2 N would be one more
    // Differences of velocities are taken relative to this and the velocity together, SI units; 0: to the largest of the motion.
    double speed = 0.0;
    bool chaotic = false;  // trajectories may part
    std::string advice;    // what one may do where they do
  };

  // N grows until the estimate is below 1e-17 or the steps are too many. Throws std::runtime_error where a step fails or, unless
  // the motion is chaotic, the trajectories of N and 2 N steps do not agree to 1 %, with the time up to which they do.
  IntegratedReference(const System& system, double duration, const Options& options);
  // What payload() gave for the same system and duration; nothing where the text is something else.
  static std::optional<IntegratedReference> restored(const System& system, double duration,
                                                     std::string_view payload);

  // The solution at t in [0, duration].
  Point at(const Extended& t) const;
  double error_estimate() const { return error_estimate_; }
  // Up to when the trajectories of N and 2 N steps agree to 1 %, s; of a motion that is not chaotic the whole duration.
  double agreement_time() const { return agreement_time_; }
  static constexpr double agreement = 1e-2;
  std::string method() const;
  // All that is kept of it, in the bytes of this machine.
  std::string payload() const;

 private:
  struct Node {
    System::Vector q, v, lambda;
  };
  IntegratedReference(const System& system, double duration) : system_(system), duration_(duration) {}
  void integrate(const Options& options);
  // Of steps + 1 nodes; empty where it stops and may.
  std::vector<Node> trajectory(std::uint64_t steps, bool may_stop) const;

  System system_;
  double duration_;
  Extended spacing_;
  std::vector<Node> nodes_;
  double error_estimate_ = 0.0;
  double agreement_time_ = 0.0;
};

}  // namespace liebench
