#include "harness/provenance.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <boost/version.hpp>

#include <Eigen/Core>
#include <ctime>
#include <fstream>

#include "harness/outside/outside_methods.h"

namespace liebench {

namespace {

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0) {
      const std::size_t colon = line.find(": ");
      if (colon != std::string::npos) return line.substr(colon + 2);
    }
  return "unknown";
}

}  // namespace

Json provenance() {
  const BuildInfo build = build_info();
  Json j;
  j["commit"] = build.commit;
  j["dirty"] = build.dirty;
  j["compiler"] = build.compiler;
  j["flags"] = build.flags;
  j["cpu"] = cpu_model();
  Json& libraries = j["libraries"];
  libraries["eigen"] = fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION);
  libraries["qd"] = build.qd;
  libraries["boost"] =
      fmt::format("{}.{}.{}", BOOST_VERSION / 100000, BOOST_VERSION / 100 % 1000, BOOST_VERSION % 100);
  libraries["fmt"] = fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100);
  if (!sundials_version().empty()) libraries["sundials"] = sundials_version();
  j["date"] = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  return j;
}

}  // namespace liebench
