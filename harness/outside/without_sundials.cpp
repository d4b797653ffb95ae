#include "harness/outside/outside_methods.h"

// In place of cvode.cpp, arkode.cpp and ida.cpp, where SUNDIALS was not found.

namespace liebench {

std::string_view sundials_version() {
  return {};
}

namespace outside {

OutsideRuns cvode_bdf_runs() {
  return {};
}
OutsideRuns cvode_adams_runs() {
  return {};
}
OutsideRuns arkode_erk_runs() {
  return {};
}
OutsideRuns arkode_dirk_runs() {
  return {};
}
OutsideRuns ida_runs() {
  return {};
}

}  // namespace outside

}  // namespace liebench
