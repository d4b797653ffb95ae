#pragma once

#include <string>

#include "harness/strict_json.h"

namespace liebench {

// What the build system knows; written anew at every build.
struct BuildInfo {
  std::string version;
  std::string commit;  // "unknown" outside a git checkout
  bool dirty = false;  // sources differ from the commit
  std::string compiler;
  std::string flags;
  std::string qd;
};

BuildInfo build_info();

// The object "provenance" of a record made now on this machine.
Json provenance();

}  // namespace liebench
