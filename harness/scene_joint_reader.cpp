#include <fmt/format.h>

#include <array>
#include <cmath>

#include "groups/decimal.h"
#include "harness/errors.h"
#include "harness/scene_parts.h"

namespace liebench {

namespace {

using Vector = InitialFrame::Vector;

// How a joint says where its axes lie.
enum class AxisKeys { none, common, two, normal };

struct JointType {
  std::string_view name;
  JointKind kind;
  AxisKeys axes;
  bool moves;  // takes "motion"
};

// Every joint: the explicit list.
constexpr std::array joint_types{
    JointType{"spherical", JointKind::spherical, AxisKeys::none, false},
    JointType{"revolute", JointKind::revolute, AxisKeys::common, true},
    JointType{"prismatic", JointKind::prismatic, AxisKeys::common, true},
    JointType{"cylindrical", JointKind::cylindrical, AxisKeys::common, false},
    JointType{"universal", JointKind::universal, AxisKeys::two, false},
    JointType{"planar", JointKind::planar, AxisKeys::normal, false},
    JointType{"fixed", JointKind::fixed, AxisKeys::none, false},
    JointType{"distance", JointKind::distance, AxisKeys::none, false},
    JointType{"point_on_plane", JointKind::point_on_plane, AxisKeys::normal, false}};

const JointType& read_joint_type(const JsonView& view) {
  std::vector<std::string> names;
  for (const JointType& type : joint_types) names.emplace_back(type.name);
  const std::string name = view.word(names, "joint");
  for (const JointType& type : joint_types)
    if (type.name == name) return type;
  return joint_types.front();
}

Vector unit(const Vector& v) {
  const Vector scaled = v / v.cwiseAbs().maxCoeff();
  return scaled / scaled.norm();
}

// A unit vector at a right angle to the unit vector n: the coordinate axis farthest from n, less what lies along n.
Vector across(const Vector& n) {
  Eigen::Index least = 0;
  for (Eigen::Index i = 1; i < 3; ++i)
    if (fabs(n(i)) < fabs(n(least))) least = i;
  Vector e = Vector::Zero();
  e(least) = Extended(1.0);
  return unit(e - n * n(least));
}

// Sets the axes, and vectors across them that coincide at the initial poses.
void set_axes(const Vector& n_a, const Vector& n_b, const InitialFrame& a, const InitialFrame& b,
              JointDescription& joint) {
  const Vector e_a = across(n_a);
  joint.axis_a = rounded(n_a);
  joint.axis_b = rounded(n_b);
  joint.across_a = rounded(e_a);
  // Where the axes do not quite coincide, the nearest; where they are at a right angle, any.
  const Vector e = b.turn_to_body(a.turn_to_inertial(e_a)), projected = e - n_b * n_b.dot(e);
  joint.across_b = rounded(projected.norm() > Extended(1e-6) ? unit(projected) : across(n_b));
}

void read_axes(const JsonView& view, const JointType& type, const SceneDescription& scene,
               JointDescription& joint) {
  const InitialFrame a(scene, joint.a), b(scene, joint.b);
  const auto direction = [](const JsonView& v) { return unit(decimal_vector<Extended>(read_direction(v))); };
  const auto common = [&](const Vector& n) { set_axes(a.turn_to_body(n), b.turn_to_body(n), a, b, joint); };
  const auto each = [&](const JsonView& axes) {
    require_count(axes, 2, "a list of two directions, one in the frame of each body");
    set_axes(direction(axes[0]), direction(axes[1]), a, b, joint);
  };
  switch (type.axes) {
    case AxisKeys::none:
      common(Vector::Unit(2));
      return;
    case AxisKeys::common:
      require_one_of(view, {"axis", "axes"});
      if (view.has("axes"))
        each(view["axes"]);
      else
        common(direction(view["axis"]));
      return;
    case AxisKeys::two:
      view.require_key("axes");
      each(view["axes"]);
      return;
    case AxisKeys::normal:
      view.require_key("normal");
      common(direction(view["normal"]));
      return;
  }
}

std::vector<std::string> joint_keys(const JointType& type) {
  std::vector<std::string> keys{"name", "type", "bodies"};
  if (type.kind != JointKind::distance) keys.emplace_back("point");
  keys.emplace_back("points");
  if (type.axes == AxisKeys::common) keys.emplace_back("axis");
  if (type.axes == AxisKeys::common || type.axes == AxisKeys::two) keys.emplace_back("axes");
  if (type.axes == AxisKeys::normal) keys.emplace_back("normal");
  if (type.kind == JointKind::distance) keys.emplace_back("length");
  if (type.moves) keys.emplace_back("motion");
  return keys;
}

void read_points(const JsonView& view, const SceneDescription& scene, JointDescription& joint) {
  const BodyPair pair{joint.a, joint.b};
  if (joint.kind == JointKind::fixed && !view.has("point") && !view.has("points")) {
    // Any point does.
    const int body = joint.b < 0 ? joint.a : joint.b;
    const auto point = decimal_vector<Extended>(scene.bodies[std::size_t(body)].position);
    joint.point_a = rounded(InitialFrame(scene, joint.a).to_body(point));
    joint.point_b = rounded(InitialFrame(scene, joint.b).to_body(point));
    return;
  }
  if (joint.kind == JointKind::distance) view.require_key("points");
  const PointPair points = read_point_pair(view, scene, pair);
  joint.point_a = points.a;
  joint.point_b = points.b;
}

void read_length(const JsonView& view, const SceneDescription& scene, JointDescription& joint) {
  if (view.has("length")) {
    joint.length = read_positive(view["length"]);
    return;
  }
  const double present = initial_distance(scene, {joint.a, joint.b}, {joint.point_a, joint.point_b});
  if (!(present >= smallest_scene_number))
    view["points"].reject("two points apart, where \"length\" is not given");
  joint.length = present;
}

// What a point mass cannot hold.
void require_turning_bodies(const JsonView& view, const JointType& type, const SceneDescription& scene,
                            const JointDescription& joint) {
  if (type.kind == JointKind::spherical || type.kind == JointKind::distance) return;
  const auto point_mass = [&](int body) {
    return body >= 0 && scene.bodies[std::size_t(body)].kind == BodyKind::r3;
  };
  // The plane is one of the first body.
  const bool second = type.kind != JointKind::point_on_plane && point_mass(joint.b);
  if (point_mass(joint.a) || second)
    view["bodies"].reject(
        fmt::format("bodies that can turn: a {} joint holds directions of {}, and one of these is a "
                    "point mass (R3)",
                    type.name, second || joint.b < 0 ? "both" : "the first"));
}

}  // namespace

JointDescription read_joint(const JsonView& view, const SceneDescription& scene, const SceneNames& names) {
  if (!view.value().is_object()) view.reject("an object with the keys \"type\" and \"bodies\"");
  view.require_key("type");
  const JointType& type = read_joint_type(view["type"]);
  view.require_object(joint_keys(type));
  view.require_key("bodies");
  const BodyPair pair = read_body_pair(view["bodies"], names);
  JointDescription joint;
  joint.kind = type.kind;
  joint.a = pair.a;
  joint.b = pair.b;
  const auto name_of = [&](int body) {
    return body < 0 ? std::string(ground_name) : scene.bodies[std::size_t(body)].name;
  };
  joint.name = view.has("name") ? read_name(view["name"])
                                : fmt::format("{} {} - {}", type.name, name_of(pair.a), name_of(pair.b));
  require_turning_bodies(view, type, scene, joint);
  read_points(view, scene, joint);
  read_axes(view, type, scene, joint);
  if (type.kind == JointKind::distance) read_length(view, scene, joint);
  if (view.has("motion")) joint.motion = read_motion(view["motion"]);
  return joint;
}

}  // namespace liebench
