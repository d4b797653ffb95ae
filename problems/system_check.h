#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

// What check_system() (problems/check_system.h) finds out about a mechanical system.

namespace liebench {

enum class Law {
  scalars,
  group,
  mass_symmetry,
  mass_definiteness,
  constant_mass,
  mass_blocks,
  momentum,
  constraint_gradient,
  constraint_product,
  constraint_force,
  constraint_rate,
  constraint_curvature,
  gradient_derivative,
  damping,
  stiffness,
  kinetic_energy,
  energy_balance,
  position_constraint,
  velocity_constraint,
  independent_constraints,
  consistent_acceleration,
};

struct LawInfo {
  Law law;
  std::string_view name;
  std::string_view formula;  // the number that is looked at, and what it is to be
  bool initial = false;      // a law of the initial values alone
};

// Every law, in the order of a report; the place of a law is its number.
inline constexpr std::array<LawInfo, 21> laws{{
    {Law::scalars, "scalars", "the same values in double as in the scalar of the differences"},
    {Law::group, "group", "the initial configuration is an element of the group: its defect is 0", true},
    {Law::mass_symmetry, "mass_symmetry", "M_ij = M_ji"},
    {Law::mass_definiteness, "mass_definiteness",
     "the least eigenvalue of M, scaled to a diagonal of 1, is positive"},
    {Law::constant_mass, "constant_mass", "M(q) = M(q_0), where the system says that M is constant"},
    {Law::mass_blocks, "mass_blocks", "M_ij = 0 outside the blocks that the system says M has"},
    {Law::momentum, "momentum", "momentum(q, e_j) = M e_j"},
    {Law::constraint_gradient, "constraint_gradient", "B e_j = D Phi(q) . (q e_j~)"},
    {Law::constraint_product, "constraint_product", "constraint_product(q, e_j) = B e_j"},
    {Law::constraint_force, "constraint_force", "constraint_force(q, e_i) = B^T e_i"},
    {Law::constraint_rate, "constraint_rate", "B v + Phi_t = d Phi / dt"},
    {Law::constraint_curvature, "constraint_curvature", "curvature = d^2 Phi / dt^2 at constant v"},
    {Law::gradient_derivative, "gradient_derivative", "Z e_j = D(B(q) v) . (q e_j~)"},
    {Law::damping, "damping", "C e_j = D_v g . e_j"},
    {Law::stiffness, "stiffness", "K e_j = D_q(M a + g + B^T lambda) . (q e_j~)"},
    {Law::kinetic_energy, "kinetic_energy", "dE/dv_i = (M v)_i"},
    {Law::energy_balance, "energy_balance",
     "dE/dt = v . (M a + g) + the power of the forces without a potential"},
    {Law::position_constraint, "position_constraint", "Phi(t_0, q_0) = 0", true},
    {Law::velocity_constraint, "velocity_constraint", "B v_0 + Phi_t = 0", true},
    {Law::independent_constraints, "independent_constraints",
     "the least singular value of B, its rows of length 1, is positive", true},
    {Law::consistent_acceleration, "consistent_acceleration",
     "d^2 Phi / dt^2 = 0 along the motion that begins with M a = -g - B^T lambda", true},
}};

constexpr const LawInfo& info(Law law) {
  return laws[std::size_t(law)];
}

// Whether the number is to be larger than a bound; others are to be equal to one.
constexpr bool is_bound(Law law) {
  return law == Law::mass_definiteness || law == Law::independent_constraints;
}

// One law at all points: where it holds worst.
struct LawCheck {
  Law law = Law::scalars;
  bool holds = true;
  std::size_t compared = 0;  // numbers
  int point = 0;             // 0: the initial values
  std::string row, column;   // of the entry, by name; empty where the law has none
  double value = 0.0;        // the system's
  double expected = 0.0;     // what the others of its functions make of it
  // |value - expected| may be the sum of these: 64 eps of the largest term and what 64 roundings of q and v change of the number, and
  // what is not known of a difference quotient.
  double round_off = 0.0, difference_error = 0.0;

  double tolerance() const { return round_off + difference_error; }
  double difference() const { return std::abs(value - expected); }
};

struct SystemCheck {
  std::vector<LawCheck> laws;  // those that the system has something to say to
  int points = 0;
  bool extended = false;  // differences were taken in extended precision

  bool holds() const {
    return std::all_of(laws.begin(), laws.end(), [](const LawCheck& c) { return c.holds; });
  }
  // Null where the law does not apply.
  const LawCheck* find(Law law) const {
    const auto found =
        std::find_if(laws.begin(), laws.end(), [&](const LawCheck& c) { return c.law == law; });
    return found == laws.end() ? nullptr : &*found;
  }
};

// What entries of velocities and multipliers are called; "v[3]" and "lambda[1]" where nothing is said.
struct EntryNames {
  std::vector<std::string> velocities{}, multipliers{};

  std::string velocity(std::ptrdiff_t i) const { return name(velocities, "v", i); }
  std::string multiplier(std::ptrdiff_t i) const { return name(multipliers, "lambda", i); }

 private:
  static std::string name(const std::vector<std::string>& names, const char* letter, std::ptrdiff_t i) {
    if (std::size_t(i) < names.size()) return names[std::size_t(i)];
    return std::string(letter) + "[" + std::to_string(i) + "]";
  }
};

struct CheckOptions {
  EntryNames names{};
  int nearby_points = 4;
  // Nearby configurations are q_0 o exp(w~), velocities v_0 + u max(1, |v_0|), with entries of w up to `reach` [m, rad] and of u up to
  // 1; times follow each other by 0.1 s.
  double reach = 0.25;
  double gap = 0.0;  // m or rad: how far constraints may be open where every run begins by closing them
};

namespace detail {

inline std::string text_of(double x, int digits) {
  std::array<char, 40> text;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::general, digits);
  return {text.data(), end.ptr};
}

}  // namespace detail

// "row lambda[0], column v[2]", "v[2]" or "".
inline std::string entry_name(const LawCheck& check) {
  if (check.row.empty()) return check.column;
  if (check.column.empty()) return check.row;
  return "row " + check.row + ", column " + check.column;
}

// "initial values" or "nearby point 2".
inline std::string point_name(const LawCheck& check) {
  return check.point == 0 ? "initial values" : "nearby point " + std::to_string(check.point);
}

// The law, the entry and both numbers in a line: in all digits where nine do not tell them apart.
inline std::string message(const LawCheck& check) {
  const std::string entry = entry_name(check);
  const bool alike = detail::text_of(check.value, 9) == detail::text_of(check.expected, 9);
  const int digits = !check.holds && alike ? 17 : 9;
  std::string text(info(check.law).name);
  text += check.holds ? " holds" : " fails";
  if (!entry.empty()) text += " in " + entry;
  text += ", " + point_name(check) + ": " + detail::text_of(check.value, digits) + " where ";
  if (is_bound(check.law))
    text += "more than " + detail::text_of(check.tolerance(), 3) + " is expected";
  else
    text +=
        detail::text_of(check.expected, digits) + " is expected, to " + detail::text_of(check.tolerance(), 3);
  return text + "; " + std::string(info(check.law).formula);
}

}  // namespace liebench
