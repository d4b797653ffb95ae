#pragma once

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

// Every integrator of the program. A method that is not in this list is nowhere; one that is in it is in every command.
using Integrators = detail::Joined<SettledIntegrators, NewIntegrators>::type;

}  // namespace liebench
