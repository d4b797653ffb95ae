#pragma once

#include <string_view>

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

}  // namespace liebench
