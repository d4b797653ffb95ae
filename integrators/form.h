#pragma once

#include <string_view>

#include "integrators/fits.h"
#include "integrators/option.h"
#include "problems/system.h"

namespace liebench {

// How the constraint of a constrained system enters a step; an unconstrained system has no choice.
enum class Form {
  index3,             // Phi(q_{n+1}) = 0 alone, eq. (23d)
  stabilized_index2,  // B(q_{n+1}) v_{n+1} = 0 too, with an auxiliary multiplier eta in the kinematic equation
                      // (Gear, Gupta & Leimkuhler 1985)
};

constexpr Form form_of(std::string_view word) {
  return word == "stabilized_index2" ? Form::stabilized_index2 : Form::index3;
}

inline constexpr OptionInfo form_option{.name = "form",
                                        .kind = OptionKind::choice,
                                        .fallback = 0,
                                        .choices = {"index3", "stabilized_index2"},
                                        .scope = OptionScope::constrained,
                                        .meaning = "formulation of the constrained equations"};

// What a method keeps of the constraints with these options: what its form says, or the method where it has none.
template <class Method>
KeptConstraints kept_constraints(const OptionValues& values) {
  if constexpr (requires { Method::kept_constraints(values); })
    return Method::kept_constraints(values);
  else
    return {.position = true,
            .velocity = form_of(values.choice_or(form_option.name, "")) == Form::stabilized_index2};
}

inline constexpr OptionInfo modified_start_option{
    .name = "modified_start",
    .kind = OptionKind::boolean,
    .fallback = 0,
    .self_start_fallback = 1,
    .scope = OptionScope::index3,
    .meaning =
        "starting velocities moved by the local error, eq. (56): without them lambda loses an order in the "
        "transient phase of the index-3 form"};

inline constexpr OptionInfo safeguard_option{
    .name = "safeguard",
    .kind = OptionKind::boolean,
    .fallback = 0,
    .unsaid = true,
    .meaning =
        "solve a step again where Newton's iteration fails or turns too far: damped, from the last "
        "increment, to what rounding leaves"};

// Of a method with this option alone.
struct SafeguardOptions {
  bool safeguard = false;
};
inline SafeguardOptions safeguard_options(const OptionValues& values) {
  return {.safeguard = values.boolean_or("safeguard", false)};
}

// A run-time option as a compile-time parameter of a stepper.
template <Form form>
struct FormConstant {};

// Calls visit(FormConstant<form>{}); a system without constraints has one form.
template <MechanicalSystem S, class Visitor>
auto with_form(Form form, Visitor&& visit) {
  if constexpr (S::constraints != 0)
    if (form == Form::stabilized_index2) return visit(FormConstant<Form::stabilized_index2>{});
  return visit(FormConstant<Form::index3>{});
}

}  // namespace liebench
