#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/scene_reader.h"
#include "harness/simulate.h"

// Motions of the scenes that come with the program.

namespace liebench {

inline AssembledScene assembled_scene(const std::string& name) {
  const auto file = std::filesystem::path(LIEBENCH_SOURCE_DIR) / "problems" / "scenes" / (name + ".json");
  return assemble(read_scene_file(file), name);
}

inline std::vector<Sample> motion(const AssembledScene& scene, const MethodOptions& method, double h,
                                  double t_end, std::uint64_t every = 1) {
  std::vector<Sample> samples;
  const auto failure = simulate(
      scene,
      {.method = method, .step_size = h, .steps = std::uint64_t(std::llround(t_end / h)), .every = every},
      [&](const Sample& sample) { samples.push_back(sample); });
  EXPECT_FALSE(failure.has_value()) << (failure ? failure->message : "");
  return samples;
}
inline Sample end_of_motion(const AssembledScene& scene, const MethodOptions& method, double h,
                            double t_end) {
  return motion(scene, method, h, t_end, std::uint64_t(std::llround(t_end / h))).back();
}

inline Eigen::Vector3d vector_of(const std::array<double, 3>& a) {
  return {a[0], a[1], a[2]};
}
inline Eigen::Matrix3d rotation_of(const BodySample& body) {
  const auto& p = body.orientation;
  return Eigen::Quaterniond(p[0], p[1], p[2], p[3]).toRotationMatrix();
}

}  // namespace liebench
