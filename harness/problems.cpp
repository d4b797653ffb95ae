#include "harness/problems.h"

#include "harness/listed_problem.h"

namespace liebench {

const std::vector<ProblemInfo>& problems() {
  static const std::vector<ProblemInfo> list = [] {
    std::vector<ProblemInfo> all{heavy_top_info()};
    for (const ListedSystem& system : listed_systems()) all.push_back(listed_problem(system));
    return all;
  }();
  return list;
}

}  // namespace liebench
