#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "integrators/option.h"
#include "problems/system.h"

// Methods that choose their steps: start(h, points) gives them the interval from the starting point, of the length h, and
// finished() says that they are at its end; step() takes one step that is accepted.

namespace liebench {

inline constexpr OptionInfo tolerance_option{
    .name = "tolerance",
    .kind = OptionKind::real,
    .fallback = 1e-6,
    .least = 1e-30,
    .most = 1.0,
    .meaning = "of the local error of a step, relative and absolute; the method chooses its steps"};

// Whether a method chooses its steps: it has the option.
template <class Method>
constexpr bool chooses_steps() {
  for (const OptionInfo& option : Method::option_list)
    if (option.name == tolerance_option.name) return true;
  return false;
}

// Weighted root mean square of the increments' errors [Hairer, Norsett & Wanner, Solving ODE I, II.4]: an entry of theta counts
// against the tolerance itself (radians and metres of a step are differences, whose own size says nothing), one of v against
// tolerance (1 + |v_i|).
template <MechanicalSystem S>
double scaled_error(const Velocity<S>& theta_error, const Velocity<S>& v_error, const Velocity<S>& v,
                    double tolerance) {
  double sum = 0.0;
  const Eigen::Index m = v.size();
  for (Eigen::Index i = 0; i < m; ++i) {
    const double of_theta = to_double(theta_error(i)) / tolerance;
    const double of_v = to_double(v_error(i)) / (tolerance * (1.0 + std::abs(to_double(v(i)))));
    sum += of_theta * of_theta + of_v * of_v;
  }
  return std::sqrt(sum / double(2 * m));
}

// The next step of a method whose error estimate is of order h^{order}: by what the error was, within [1/5, 5], and no longer after
// a step that was rejected [Hairer, Norsett & Wanner, II.4].
class StepControl {
 public:
  explicit StepControl(int order) : exponent_(1.0 / order) {}

  // Whether a step of this error (in units of the tolerance) is accepted; factor() then is that of the next step size.
  bool accept(double error) {
    const bool accepted = error <= 1.0;
    const double wanted =
        std::isfinite(error) ? safety * std::pow(std::max(error, 1e-10), -exponent_) : least;
    factor_ = std::clamp(wanted, least, rejected_ || !accepted ? 1.0 : most);
    rejected_ = !accepted;
    return accepted;
  }
  // Of a step that failed.
  void fail() {
    factor_ = least;
    rejected_ = true;
  }
  double factor() const { return factor_; }

 private:
  static constexpr double safety = 0.9, least = 0.2, most = 5.0;
  double exponent_;
  double factor_ = 1.0;
  bool rejected_ = false;
};

}  // namespace liebench
