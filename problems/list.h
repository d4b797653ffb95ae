#pragma once

#include <concepts>
#include <span>
#include <string_view>

#include "problems/orbiting_gyrostat.h"
#include "problems/system.h"

namespace liebench {

// A system that says itself what the program has to know of it, beyond what every system gives:
//
//   name, summary, formulation     words: of studies and records; the line of `liebench list problems`; what its group is called
//   Parameters, parameter_list     a struct of numbers whose initial values are the defaults, and problems/parameter.h of each
//   System(const Parameters&)      the system, in every scalar
// and where there is something to say:
//   refusal(parameters)            why parameters that are each in their range do not fit together
//   velocity_names, multiplier_names   what a report calls their entries
template <class S>
concept ListedProblem =
    DenseSystem<S> && std::constructible_from<S, const typename S::Parameters&> && requires {
  { S::name } -> std::convertible_to<std::string_view>;
  { S::summary } -> std::convertible_to<std::string_view>;
  { S::formulation } -> std::convertible_to<std::string_view>;
  { S::parameter_list[0].numbers } -> std::convertible_to<std::span<double> (*)(typename S::Parameters&)>;
};

template <template <class> class... Systems>
struct SystemList {
  static_assert((ListedProblem<Systems<double>> && ...));
};

// Every problem that is a class of its own: the explicit list. One that is not in it is nowhere; one that is in it is in every
// command.
using ListedSystems = SystemList<OrbitingGyrostat>;

}  // namespace liebench
