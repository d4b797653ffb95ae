#include "harness/listed_system.h"
#include "harness/listed_system_impl.h"

namespace liebench {

const std::vector<ListedSystem>& listed_systems() {
  static const std::vector<ListedSystem> list = detail::listed_systems_of(ListedSystems{});
  return list;
}

}  // namespace liebench
