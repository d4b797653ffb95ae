#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "groups/extended.h"
#include "harness/strict_json.h"
#include "problems/scene_description.h"

// What the readers of a scene's bodies, joints and effects share: numbers, vectors, names, frames. All throw InputError.

namespace liebench {

// Products of a few numbers of a scene must stay finite and not vanish.
inline constexpr double largest_scene_number = 1e30;
inline constexpr double smallest_scene_number = 1e-30;

double read_number(const JsonView& view);
double read_positive(const JsonView& view);
double read_not_negative(const JsonView& view);
Eigen::Vector3d read_vector(const JsonView& view);
// Three numbers from 0 up.
Eigen::Vector3d read_not_negative_vector(const JsonView& view);
// Three numbers, not all zero; of any length.
Eigen::Vector3d read_direction(const JsonView& view);
// Letters, digits, spaces and "_.-", the first a letter, digit or "_": a name can head a column of a table.
std::string read_name(const JsonView& view);
PrescribedMotion<double> read_motion(const JsonView& view);

// A list of so many elements.
void require_count(const JsonView& view, std::size_t count, std::string_view allowed);
// Keys of which exactly one must stand in the object.
void require_one_of(const JsonView& object, const std::vector<std::string>& keys);

// Names of one kind of thing, each once, with their indices in the order of the scene.
class SceneNames {
 public:
  explicit SceneNames(std::string what) : what_(std::move(what)) {}

  // The next index; the name must be new.
  void add(const JsonView& view, const std::string& name);
  bool has(const std::string& name) const { return index_.contains(name); }
  int find(const JsonView& view) const;
  // The same, or -1 for "ground".
  int find_or_ground(const JsonView& view) const;

 private:
  [[noreturn]] void reject_unknown(const JsonView& view, bool ground) const;

  std::string what_;
  std::vector<std::string> names_;
  std::unordered_map<std::string, int> index_;
};

inline constexpr const char* ground_name = "ground";

// The pose that a body begins with, or the ground's. In extended precision, for what is written in the inertial frame means
// decimals, and should come out as decimals in the frames of bodies that are not turned.
class InitialFrame {
 public:
  using Vector = Eigen::Matrix<Extended, 3, 1>;

  InitialFrame(const SceneDescription& scene, int body);
  Vector to_body(const Vector& point) const { return R_.transpose() * (point - x_); }
  Vector to_inertial(const Vector& point) const { return x_ + R_ * point; }
  Vector turn_to_body(const Vector& direction) const { return R_.transpose() * direction; }
  Vector turn_to_inertial(const Vector& direction) const { return R_ * direction; }

 private:
  Vector x_;
  Eigen::Matrix<Extended, 3, 3> R_;
};

Eigen::Vector3d rounded(const InitialFrame::Vector& v);

// Two bodies, not the same, one of which may be the ground.
struct BodyPair {
  int a, b;
};
BodyPair read_body_pair(const JsonView& view, const SceneNames& bodies);

// Points in the frames of two bodies: from "points", one in the frame of each, or from "point" in the inertial frame at the
// initial poses. Exactly one of these keys must be there.
struct PointPair {
  Eigen::Vector3d a, b;
};
PointPair read_point_pair(const JsonView& object, const SceneDescription& scene, BodyPair pair);
// How far they are apart at the initial poses, m.
double initial_distance(const SceneDescription& scene, BodyPair pair, const PointPair& points);

}  // namespace liebench
