#include <stdexcept>
#include <string>

#include "groups/extended.h"
#include "harness/listed_parameters.h"
#include "harness/listed_system.h"
#include "problems/check_system.h"
#include "problems/list.h"

namespace liebench {

namespace {

template <class S>
EntryNames entry_names() {
  EntryNames names;
  if constexpr (requires { S::velocity_names; })
    names.velocities.assign(S::velocity_names.begin(), S::velocity_names.end());
  if constexpr (requires { S::multiplier_names; })
    names.multipliers.assign(S::multiplier_names.begin(), S::multiplier_names.end());
  return names;
}

template <template <class> class... Systems>
SystemCheck check_of(SystemList<Systems...>, std::string_view name, const ParameterNumbers& numbers) {
  SystemCheck check;
  const auto attempt = [&]<class S>(const auto& parameters) {
    check = check_system(S(parameters), {.names = entry_names<S>()});
    return true;
  };
  const bool found = ((Systems<double>::name == name && attempt.template operator()<Systems<double>>(
                                                            detail::parameters_of<Systems>(numbers))) ||
                      ...);
  if (!found) throw std::logic_error("problems/list.h has no \"" + std::string(name) + "\"");
  return check;
}

}  // namespace

SystemCheck check_listed_system(std::string_view name, const ParameterNumbers& numbers) {
  return check_of(ListedSystems{}, name, numbers);
}

}  // namespace liebench
