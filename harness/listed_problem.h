#pragma once

#include <string>

#include "harness/listed_system.h"
#include "harness/problems.h"

namespace liebench {

// A text that changes where the equations of motion do: what they give where the system begins and at points beside it, hashed. By
// it neither a reference of the cache nor a record of a file outlives an edit of the system's header.
std::string fingerprint(const RunTimeSystem<Extended>& system);

// A system of problems/list.h as a problem of studies: its parameters from and to JSON, its reference solution. The system stays
// where it is.
ProblemInfo listed_problem(const ListedSystem& system);

}  // namespace liebench
