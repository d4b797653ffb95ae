#pragma once

#include <string>

#include "harness/problems.h"

namespace liebench {

// A scene as a problem of a study, {"scene": FILE}; read, checked and assembled. Lives as long as the program; the same file with
// the same content is the same problem. Throws InputError with the file's name and the pointer in it.
const ProblemInfo& scene_problem(const std::string& file);

}  // namespace liebench
