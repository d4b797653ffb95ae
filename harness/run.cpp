#include "harness/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace liebench::detail {

void require_same_path(const RunResult& run, const RunResult& audit, std::string_view where,
                       const RunRequest& request) {
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  if (run.outcome == audit.outcome && run.end_state.size() == audit.end_state.size() &&
      std::equal(run.end_state.begin(), run.end_state.end(), audit.end_state.begin(), same))
    return;
  throw std::logic_error(
      fmt::format("{} on {}, h = {}: the audit run took another path than the run that it counts",
                  request.integrator, where, to_double(request.step_size)));
}

}  // namespace liebench::detail
