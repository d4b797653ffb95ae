#pragma once

#include <concepts>
#include <type_traits>

#include "integrators/settled_list.h"

namespace liebench {

namespace detail {
template <class... Lists>
struct Joined;
template <class... First, class... Second>
struct Joined<IntegratorList<First...>, IntegratorList<Second...>> {
  using type = IntegratorList<First..., Second...>;
};
}  // namespace detail

// A method that is new: include its header above, and name it here. Alone it is built in less than a minute; when it is settled it
// moves to integrators/settled_list.h.
using NewIntegrators = IntegratorList<>;

namespace detail {
template <class... Methods>
consteval bool have_options_of_their_own(IntegratorList<Methods...>) {
  const auto times = []<class Options>(std::type_identity<Options>) {
    return (int(std::same_as<typename Methods::Options, Options>) + ...);
  };
  return ((times(std::type_identity<typename Methods::Options>{}) == 1) && ...);
}
}  // namespace detail

// Every integrator of the program. A method that is not in this list is nowhere; one that is in it is in every command.
using Integrators = detail::Joined<SettledIntegrators, NewIntegrators>::type;
static_assert(detail::have_options_of_their_own(Integrators{}),
              "a method is known by the type of its Options (MethodOptions): each has one of its own");

}  // namespace liebench
