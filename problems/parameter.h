#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>

// Parameters of a listed problem (problems/list.h) as plain data, from which studies are validated and `liebench describe` is
// written. Nothing here knows a file format.

namespace liebench {

struct NumberRange {
  double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
};

// What a parameter's author says of it; each of its numbers is finite and in the range.
struct ParameterText {
  std::string_view name, unit;
  NumberRange range;
  std::string_view meaning;
};

// A parameter of the struct P, whose initial values are the defaults.
template <class P>
struct ProblemParameter {
  ParameterText text;
  std::span<double> (*numbers)(P&);  // where they stand
  bool single;                       // a number, not a list of numbers
};

namespace detail {

template <class Owner, class Member>
struct MemberPointer {
  using Parameters = Owner;
  static constexpr bool single = false;
  static std::span<double> numbers(Member& member) { return member; }
};
template <class Owner>
struct MemberPointer<Owner, double> {
  using Parameters = Owner;
  static constexpr bool single = true;
  static std::span<double> numbers(double& member) { return {&member, 1}; }
};
template <class Owner, class Member>
MemberPointer<Owner, Member> member_pointer(Member Owner::*);

}  // namespace detail

// The parameter that stands in `member` of a struct, a double or a std::array of doubles:
//
//   parameter<&Parameters::mass>({"mass", "kg", {.least = 1e-6, .most = 1e6}, "m"})
template <auto member>
constexpr auto parameter(const ParameterText& text) {
  using Pointer = decltype(detail::member_pointer(member));
  using Parameters = typename Pointer::Parameters;
  return ProblemParameter<Parameters>{text, [](Parameters& p) { return Pointer::numbers(p.*member); },
                                      Pointer::single};
}

// Why parameters that are each in their range do not fit together: the one that has to change, and to what.
struct ParameterRefusal {
  std::string_view parameter, allowed;
};

}  // namespace liebench
