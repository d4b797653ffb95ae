#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace liebench {

// A law that every method obeys, with what it declares of itself (integrators/fits.h).
struct Law {
  std::string_view name;
  std::string_view statement;
  std::string_view suspects;  // where a method that breaks it is wrong, as a rule
  bool operator==(const Law& other) const { return name == other.name; }
};

namespace laws {

inline constexpr Law constant_velocity{
    "constant velocity", "where v is constant, q_n = q_0 o exp(n h v~) to round-off, and lambda is constant",
    "the map from the increment to the group, a difference formula whose weights do not add up, T(v) v = v"};
inline constexpr Law inertial_frame{"inertial frame",
                                    "a solution in a frame that is turned is the solution, turned",
                                    "a product in the wrong order (q' = DL_q(e) v~: increments stand on the "
                                    "right of q), spatial and body frame mixed"};
inline constexpr Law time_reversal{
    "time reversal",
    "a one-step method comes back to its start by as many steps of -h if, and only if, it is declared "
    "symmetric",
    "forces or coordinates of one end of the step alone; the flag `symmetric`"};
inline constexpr Law order{"order", "errors of q, v and lambda fall with the orders that the method declares",
                           "the sign or the size of a commutator (L_k), a tangent operator (T for T^{-1}, or "
                           "its argument's sign), a tableau; "
                           "`orders`"};
inline constexpr Law constraints{
    "constraints", "the constraints that the method declares to keep hold to round-off in every step",
    "a constraint that is not solved for, the hidden one B(q) v = 0 above all; the option `form`, or "
    "`kept_constraints`"};
inline constexpr Law large_rotation{"large rotation",
                                    "a step that turns by pi or more is rotation_too_large, and is not taken",
                                    "an increment that nobody asks for its angle (outcome_of_turn)"};
inline constexpr Law no_number{"no number",
                               "forces that are NaN or infinite are non_finite, and the step is not taken",
                               "a state that is taken over before it is tested"};

}  // namespace laws

// A law that is broken, by one case of it.
struct BrokenLaw {
  Law law;
  std::string expected, measured;
};

inline std::string text(const std::string& method, const BrokenLaw& broken) {
  return method + " breaks the law of " + std::string(broken.law.name) + ": " +
         std::string(broken.law.statement) + ".\n  expected: " + broken.expected +
         "\n  measured: " + broken.measured + "\n  look at: " + std::string(broken.law.suspects);
}

// An order, with two decimals.
inline std::string order_text(double order) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.2f", order);
  return buffer;
}

// Three digits.
inline std::string number_text(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3g", x);
  return buffer;
}

}  // namespace liebench
