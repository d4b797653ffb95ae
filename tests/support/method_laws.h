#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "integrators/consistent_projection.h"
#include "tests/support/broken_law.h"
#include "tests/support/hanging_top.h"
#include "tests/support/heavy_top_motion.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/method_cases.h"

// The laws of broken_law.h on a formulation of the heavy top, for one method with one combination of its options:
//
//   broken_laws<HeavyTopSO3<Extended>>(method)   those that it breaks, of which there should be none
//
// Every listed method is checked by tests/support/listed_methods.h, wrong ones, planted, by
// tests/integrators/wrong_methods_test.cpp.
//
// Step sizes: an explicit L_6 is stable in the index-3 form for h |v| < 0.112 only (integrators/lie_correction.h), and so all
// methods run with less.

namespace liebench {

// The points of a motion, each computed once, for all methods that are compared with it.
template <MechanicalSystem S>
class KnownMotion {
 public:
  using T = typename S::Scalar;
  KnownMotion(const HeavyTopParameters& p, double end) : system_(p), motion_(p, end) {}
  const S& system() const { return system_; }
  const SolutionPoint<S>& at(const T& t) {
    const auto place = points_.find(t);
    return place != points_.end() ? place->second
                                  : points_.emplace(t, motion_.point(system_, Extended(t))).first->second;
  }

 private:
  S system_;
  HeavyTopMotion motion_;
  std::map<T, SolutionPoint<S>> points_;
};

template <MechanicalSystem S>
class MethodLaws {
 public:
  using T = typename S::Scalar;
  using Method = MethodCase<S>;
  using Broken = std::vector<BrokenLaw>;
  static constexpr bool extended = ScalarTraits<T>::extended;
  // Round-off; in extended precision the accuracy of HeavyTopMotion.
  static constexpr double eps = extended ? 1e-28 : std::numeric_limits<double>::epsilon();

  static void constant_velocity(const Method& method, Broken& broken) {
    const HeavyTopParameters p = hanging_top(3);
    constexpr double h = 1.0 / 64, length = 1.5;  // h |v| = 0.047
    follow(
        laws::constant_velocity, method, S(p), h, length,
        [&](const T& t) { return hanging_top_point<S>(p, t); }, broken,
        [&](const AnyStepper<S>& stepper, const SolutionPoint<S>& exact, double first, int n) -> std::string {
          const RoundOff tolerance(3, p.mass, first, n);
          if (const auto d = distance(stepper, exact); !tolerance.covers(d))
            return "off by " + text_of(d) + " at t = " + number_text(to_double(stepper.time())) + " s";
          return {};
        },
        "the exact motion, to " + text_of(RoundOff(3, p.mass, h, int(length / h)).all()));
  }

  // Turned motions have turned errors: their norms, and lambda, which all formulations have in a frame that turns with the
  // body or by a rotation of it, are the same.
  static void inertial_frame(const Method& method, Broken& broken) {
    // A tolerance weighs every entry of v by its size, and those of a centre of mass are in the inertial frame.
    if (method.chooses_steps && S::constraints > 0) return;
    constexpr double h = 1.0 / 128, length = 0.375;
    static std::array motions{KnownMotion<S>(top_to_turn(), 0.5),
                              KnownMotion<S>(turned(top_to_turn(), turns()[0]), 0.5),
                              KnownMotion<S>(turned(top_to_turn(), turns()[1]), 0.5)};
    std::array<std::vector<std::array<double, 3>>, 3> errors;
    double speed = 0.0, shortest = h;
    for (std::size_t i = 0; i < 3; ++i) {
      KnownMotion<S>& motion = motions[i];
      speed = size(motion.at(T(0.0)).v);
      const bool whole = follow(
          laws::inertial_frame, method, motion.system(), h, length, [&](const T& t) { return motion.at(t); },
          broken,
          [&](const AnyStepper<S>& stepper, const SolutionPoint<S>& exact, double first, int) -> std::string {
            errors[i].push_back(distance(stepper, exact));
            shortest = first;
            return {};
          },
          "steps that end well");
      if (!whole) return;
      if (errors[i].size() != errors[0].size())
        return add(broken, laws::inertial_frame, std::to_string(errors[0].size()) + " steps in all frames",
                   std::to_string(errors[i].size()) + " in one that is turned");
    }
    for (std::size_t i = 1; i < 3; ++i)
      for (std::size_t n = 0; n < errors[0].size(); ++n) {
        std::array<double, 3> d{};
        for (std::size_t j = 0; j < 3; ++j) d[j] = std::abs(errors[i][n][j] - errors[0][n][j]);
        // Errors are doubles.
        std::array<double, 3> left = d;
        for (std::size_t j = 0; j < 3; ++j)
          left[j] -= 4 * std::numeric_limits<double>::epsilon() * errors[0][n][j];
        if (const RoundOff tolerance(speed, top_to_turn().mass, shortest, int(n) + 1);
            !tolerance.covers(left))
          return add(broken, laws::inertial_frame,
                     "the same errors in a frame that is turned, to " + text_of(tolerance.all()),
                     "differences of " + text_of(d) + " after " + std::to_string(n + 1) + " steps");
      }
  }

  // Of a symmetric method what is left is the round-off of every step, eps (|v| + |q| / h) in v (increments are known to
  // eps |q| / h where a constraint gives them), through a matrix of condition below a hundred. One that is not is off by its local
  // errors, which in double may be no more than that.
  static void time_reversal(const Method& method, Broken& broken) {
    if (method.chooses_steps || !(method.symmetric || extended)) return;
    constexpr double h = 1.0 / 64;
    constexpr int steps = 32;
    static KnownMotion<S> motion(unsymmetric_top(2), 0.1);
    const S& system = motion.system();
    const std::vector points{motion.at(T(0.0))};
    const auto forth = method.stepper(system), back = method.stepper(system);
    if (forth->starting_points() != 1) return;
    const auto fails = [&](const StepResult& result) {
      if (result.outcome == Outcome::ok) return false;
      add(broken, laws::time_reversal, "steps that end well", std::string(name(result.outcome)));
      return true;
    };
    if (fails(forth->start(T(h), points)) || fails(forth->advance(steps))) return;
    NoAudit unused;
    const auto consistent =
        consistent_dynamics(system, forth->time(), forth->configuration(), forth->velocity(), unused);
    const std::vector<SolutionPoint<S>> end{{forth->time(), forth->configuration(), forth->velocity(),
                                             consistent->acceleration, forth->multipliers()}};
    if (fails(back->start(T(-h), end)) || fails(back->advance(steps))) return;
    const double tolerance = 100 * eps * (size(points[0].v) + 1 / h) * steps;
    const double q = S::Group::separation(points[0].q, back->configuration()).norm();
    const double v = size(back->velocity() - points[0].v);
    const bool comes_back = q <= tolerance && v <= tolerance;
    if (comes_back == method.symmetric) return;
    const std::string seen = "q off by " + number_text(q) + ", v by " + number_text(v) + " after " +
                             std::to_string(steps) + " steps forth and back";
    if (method.symmetric)
      add(broken, laws::time_reversal, "back to " + number_text(tolerance) + ", declared symmetric", seen);
    else
      add(broken, laws::time_reversal, "not back to " + number_text(tolerance) + ", not declared symmetric",
          seen);
  }

  // The slow top over 1/2 s with twice as many steps, the largest errors of its second half (by then the transient phase of the
  // index-3 form is over, and no error is next to a zero by chance): log2 of their ratio. Where the error is C h^p (1 + c h + ...),
  // the order seen is p + c h log2(e) / 2: within 0.1 of p for 1024 and 2048 steps and c up to 285 /s = 65 |Omega|. (The largest
  // seen, in lambda of BLieDF2nd without L_k, is 40 |Omega|.) From order 7 on as many steps as leave the errors above the
  // round-off of so few steps, 1e-29: those are symmetric methods, whose error is C h^p (1 + c h^2 + ...), for c up to 1 |Omega|^2.
  static void order(const Method& method, Broken& broken) requires extended {
    // The options that apply to failing steps change no other, to the last bit.
    if (method.chooses_steps || method.options.boolean_or(safeguard_option.name, false)) return;
    std::optional<std::array<double, 3>> coarse, fine;
    int steps = method.orders.q > 6 ? 8 : 1024;
    for (; steps <= 2048; steps *= 2) {
      const auto errors = errors_in(method, steps, broken);
      if (!errors) return;
      if (std::min((*errors)[0], (*errors)[1]) < 1e-29) break;
      coarse = std::exchange(fine, errors);
    }
    steps /= 2;
    if (!coarse) {
      // Above order 16 there is nothing to be seen but that.
      if (fine && (*fine)[0] > 1e-25)
        add(broken, laws::order, "an error below 1e-25 of q", number_text((*fine)[0]) + " with 8 steps");
      return;
    }
    const std::array declared{method.orders.q, method.orders.v, method.orders.lambda};
    constexpr std::array names{"q", "v", "lambda"};
    std::string expected, measured;
    for (std::size_t j = 0; j < (S::constraints > 0 ? 3u : 2u); ++j) {
      const double order = std::log2((*coarse)[j] / (*fine)[j]);
      if (std::abs(order - declared[j]) <= 0.1) continue;
      const std::string separator = expected.empty() ? "" : ", ";
      expected += separator + "order " + std::to_string(declared[j]) + " of " + names[j];
      measured += separator + "order " + order_text(order) + " of " + names[j] + " (errors of " +
                  number_text((*coarse)[j]) + " and " + number_text((*fine)[j]) + ")";
    }
    if (!expected.empty())
      add(broken, laws::order, expected,
          measured + " in " + std::to_string(steps / 2) + " and " + std::to_string(steps) +
              " steps of the slow top over 1/2 s");
  }

  // Phi is solved for to eps |x|, and grows by as much a step where products of rotations add up; B v to that of v.
  static void constraints(const Method& method, Broken& broken) requires(S::constraints > 0) {
    constexpr double h = 1.0 / 128, length = 0.375;
    static KnownMotion<S> motion(unsymmetric_top(2), 0.5);
    const double speed = size(motion.at(T(0.0)).v);
    follow(
        laws::constraints, method, motion.system(), h, length, [&](const T& t) { return motion.at(t); },
        broken,
        [&](const AnyStepper<S>& stepper, const SolutionPoint<S>&, double first, int n) -> std::string {
          const S& system = motion.system();
          const auto& q = stepper.configuration();
          const double phi = size(constraint_at(system, stepper.time(), q));
          const double rate = size(constraint_rate(system, stepper.time(), q, stepper.velocity()));
          const RoundOff tolerance(speed, 1.0, first, n);
          const std::string at = " at t = " + number_text(to_double(stepper.time())) + " s";
          if (method.kept.position && !(phi <= 32 * n * eps)) return "|Phi(q)| = " + number_text(phi) + at;
          if (method.kept.velocity && !(rate <= tolerance.v)) return "|B(q) v| = " + number_text(rate) + at;
          return {};
        },
        std::string(method.kept.position ? "Phi(q) = 0" : "") +
            (method.kept.position && method.kept.velocity ? " and " : "") +
            (method.kept.velocity ? "B(q) v = 0, the hidden constraint," : "") + " to round-off");
  }

  static void large_rotation(const Method& method, Broken& broken) {
    if (method.chooses_steps) return;
    const HeavyTopParameters p = hanging_top(45);  // 4.5 rad a step
    expect_first_step(
        laws::large_rotation, method, S(p), 0.1, 0.1, [&](const T& t) { return hanging_top_point<S>(p, t); },
        Outcome::rotation_too_large, broken);
  }

  static void no_number(const Method& method, Broken& broken) {
    static KnownMotion<S> motion(slow_top(), 0.2);
    for (const double value :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      HeavyTopParameters p = slow_top();
      p.gravity[1] = value;
      expect_first_step(
          laws::no_number, method, S(p), 1.0 / 128, 0.1, [&](const T& t) { return motion.at(t); },
          Outcome::non_finite, broken);
    }
  }

  // What differs from the exact values is round-off of `steps` steps: increments are known to eps |q| / h where a constraint or a
  // logarithm gives them, the velocity to some of those (the coefficients of a method add up to less than 14 for six steps), lambda
  // to what M v' = M v / h makes of it.
  struct RoundOff {
    double q, v, lambda;
    RoundOff(double speed, double mass, double h, int steps)
        : q(0), v(64 * eps * (speed + 1 / h) * std::sqrt(double(steps))), lambda(0) {
      q = steps * (h * v + 16 * eps);
      lambda = 8 * (1 + mass) * v / h;
    }
    std::array<double, 3> all() const { return {q, v, lambda}; }
    bool covers(const std::array<double, 3>& d) const { return d[0] <= q && d[1] <= v && d[2] <= lambda; }
  };

 private:
  static void add(Broken& broken, const Law& law, const std::string& expected, const std::string& measured) {
    broken.push_back({law, expected, measured});
  }
  template <class Vector>
  static double size(const Vector& v) {
    return to_double(T(v.norm()));
  }
  static std::array<double, 3> distance(const AnyStepper<S>& stepper, const SolutionPoint<S>& exact) {
    return {S::Group::separation(exact.q, stepper.configuration()).norm(), size(stepper.velocity() - exact.v),
            size(stepper.multipliers() - exact.lambda)};
  }
  static std::string text_of(const std::array<double, 3>& d) {
    return number_text(d[0]) + " in q, " + number_text(d[1]) + " in v" +
           (S::constraints > 0 ? ", " + number_text(d[2]) + " in lambda" : "");
  }

  // h for a method of fixed steps, the interval for one that chooses them.
  template <class Exact>
  static StepResult begin(const Method& method, AnyStepper<S>& stepper, double h, double length,
                          const Exact& exact) {
    std::vector<SolutionPoint<S>> points;
    for (int j = 0; j < stepper.starting_points(); ++j) points.push_back(exact(T(h * j)));
    return stepper.start(T(method.chooses_steps ? length : h), points);
  }

  // Steps over the interval; judge(stepper, exact point, first step size, steps so far) says what is wrong with one, and then that is it.
  template <class Exact, class Judge>
  static bool follow(const Law& law, const Method& method, const S& system, double h, double length,
                     const Exact& exact, Broken& broken, const Judge& judge, const std::string& expected) {
    const auto stepper = method.stepper(system);
    StepResult result = begin(method, *stepper, h, length, exact);
    double first = method.chooses_steps ? 0.0 : h;
    const int last = method.chooses_steps ? std::numeric_limits<int>::max() : int(length / h);
    int n = stepper->steps() - 1;
    while (result.outcome == Outcome::ok && n < last && !stepper->finished()) {
      result = stepper->step();
      if (result.outcome != Outcome::ok) break;
      ++n;
      if (first == 0.0) first = to_double(stepper->time());
      if (const std::string wrong = judge(*stepper, exact(stepper->time()), first, n); !wrong.empty()) {
        add(broken, law, expected, wrong);
        return false;
      }
    }
    if (result.outcome == Outcome::ok) return true;
    add(broken, law, expected,
        "step " + std::to_string(n + 1) + " ends with " + std::string(name(result.outcome)));
    return false;
  }

  // The largest errors in q, v and lambda from 1/4 s to 1/2 s.
  static std::optional<std::array<double, 3>> errors_in(const Method& method, int steps, Broken& broken) {
    static KnownMotion<S> motion(slow_top(), 0.6);
    std::array<double, 3> largest{};
    const auto stepper = method.stepper(motion.system());
    const double h = 0.5 / steps;
    StepResult result = begin(method, *stepper, h, 0.5, [&](const T& t) { return motion.at(t); });
    int n = stepper->steps();
    for (; result.outcome == Outcome::ok && n <= steps; ++n) {
      result = stepper->step();
      if (result.outcome != Outcome::ok) break;
      if (2 * n < steps) continue;
      const auto d = distance(*stepper, motion.at(T(h * n)));
      for (std::size_t j = 0; j < 3; ++j) largest[j] = std::max(largest[j], d[j]);
    }
    if (result.outcome == Outcome::ok) return largest;
    add(broken, laws::order, "steps that end well",
        "step " + std::to_string(n) + " of " + std::to_string(steps) + " ends with " +
            std::string(name(result.outcome)));
    return std::nullopt;
  }

  // How the start or the first step ends; a step that failed is not taken.
  template <class Exact>
  static void expect_first_step(const Law& law, const Method& method, const S& system, double h,
                                double length, const Exact& exact, Outcome expected, Broken& broken) {
    const auto stepper = method.stepper(system);
    Outcome outcome = begin(method, *stepper, h, length, exact).outcome;
    if (outcome == Outcome::ok) {
      const auto before = state_of(*stepper);
      outcome = stepper->step().outcome;
      if (outcome != Outcome::ok && !same_bits(before, state_of(*stepper)))
        add(broken, law, "the state from before the step that failed", "another state");
    }
    if (outcome != expected) add(broken, law, std::string(name(expected)), std::string(name(outcome)));
  }

  // A NaN is what it was, too.
  static bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
      return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
    });
  }

  // Short decimals, whose products with the second of turns() below are exact: in extended precision parameters are decimals.
  static HeavyTopParameters top_to_turn() {
    HeavyTopParameters p = unsymmetric_top(1);
    if (extended) p.orientation = {0.75, -0.25, 0.5, 0.125};
    return p;
  }
  // About the vertical, and about no axis of the problem; in extended precision cyclic ones, which round nothing.
  static std::array<Eigen::Quaterniond, 2> turns() {
    if (extended) return {Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5), Eigen::Quaterniond(0.5, -0.5, -0.5, -0.5)};
    const auto& g = top_to_turn().gravity;
    return {Eigen::Quaterniond(Eigen::AngleAxisd(1.1, Eigen::Vector3d(g[0], g[1], g[2]).normalized())),
            Eigen::Quaterniond(0.3, -0.7, 0.2, 0.6).normalized()};
  }
  // The same top in a frame that is turned: attitude and gravity by the rotation with quaternion g.
  static HeavyTopParameters turned(HeavyTopParameters p, const Eigen::Quaterniond& g) {
    const Eigen::Quaterniond product =
        g * Eigen::Quaterniond(p.orientation[0], p.orientation[1], p.orientation[2], p.orientation[3]);
    p.orientation = {product.w(), product.x(), product.y(), product.z()};
    const Eigen::Vector3d gravity =
        g.toRotationMatrix() * Eigen::Vector3d(p.gravity[0], p.gravity[1], p.gravity[2]);
    p.gravity = {gravity(0), gravity(1), gravity(2)};
    return p;
  }
};

// The laws that a method breaks; that of its order in extended precision only, where it can be seen.
template <MechanicalSystem S>
std::vector<BrokenLaw> broken_laws(const MethodCase<S>& method) {
  using Laws = MethodLaws<S>;
  std::vector<BrokenLaw> broken;
  Laws::constant_velocity(method, broken);
  Laws::inertial_frame(method, broken);
  Laws::time_reversal(method, broken);
  if constexpr (Laws::extended) Laws::order(method, broken);
  if constexpr (S::constraints > 0) Laws::constraints(method, broken);
  Laws::large_rotation(method, broken);
  Laws::no_number(method, broken);
  return broken;
}

}  // namespace liebench
